"""Steps of many worlds that JAX differentiates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

try:
    import jax  # pyright: ignore[reportMissingImports]
    import jax.numpy as jnp  # pyright: ignore[reportMissingImports]
except ImportError as missing:
    raise ImportError("carom.jax needs JAX; install it with: pip install jax", name="jax") from missing

from carom.worlds.algorithms.packed import Packing
from carom.worlds.algorithms.repeated import RepeatedSteps
from carom.worlds.algorithms.step_function import NamedColumns, StepArrays, StepFunction

if TYPE_CHECKING:
    from carom.worlds.worlds import Worlds

_CONTACT_ROOM = 32


class State(NamedTuple):
    """The state of n worlds, a pytree of arrays.

    Attributes:
        positions: As `carom.torch.State.positions`, (n, nq).
        velocities: As `carom.torch.State.velocities`, (n, nv).
        activations: Activations of actuators that have one, (n, na).
        memory: The rest of the state, which has no gradients, as bytes (n, m). Keep it as it is.
    """

    positions: Any
    velocities: Any
    activations: Any
    memory: Any


class Stepper(NamedColumns):
    """Steps of worlds as a function from a state to the next, for `jax.grad`, `jax.vjp` and `jax.jit`.

    The same as `carom.torch.Stepper`: steps have the bits of `Worlds.step`, depend on their arguments only,
    and have the gradients of `Worlds.step_vjp`. They are computed on the processor, by callbacks: `jit` and
    `lax.scan` call them at each step; `vmap` calls them for one element after the other, each with all
    worlds, so rather make more worlds. There are no forward-mode derivatives (`jvp`, `jacfwd`), and no
    second ones. A program that is traced has the stepper's worlds in it: parameters that are no arguments
    are those of the time at which it runs.

    Errors within a callback, such as those of steps that have no exact derivatives, reach users as errors of
    JAX with the same message.

    Attributes:
        count: Number of worlds that take steps, n.
        coordinates: Names of the columns of `State.positions`.
        velocities: Names of the columns of `State.velocities`.
        activations: Names of the columns of `State.activations`.
        controls: Names of the columns of controls.
        parameters: Names of the columns of parameters.

    Args:
        worlds: The worlds, on the processor.
        controls: Controls that are arguments of a step, as in `Worlds.linearize`.
        parameters: Parameters that are arguments of a step, likewise, but for "inertial_parameters".
        smoothing: Softness of rows that hold, in the derivatives only, likewise.
        where: Which worlds take steps: a mask (count,) or their indices; None for all.
        contact_room: How many contacts, and how many pairs of shapes that are near each other, there is room
            for in the memory of a world; None for 32, or more if there are more at present.

    Raises:
        ValueError: There is no such control or parameter, `where` names a world twice, or JAX is not set up
            for doubles.
        NotImplementedError: Worlds are on a GPU, have substeps, or have something without exact derivatives
            in any step, such as tendons, muscles or a fluid; it is named.
    """

    def __init__(
        self,
        worlds: Worlds,
        controls: Sequence[str] = ("torques",),
        *,
        parameters: Sequence[str] = (),
        smoothing: float = 0.0,
        where: ArrayLike | None = None,
        contact_room: int | None = None,
    ) -> None:
        if not jax.config.jax_enable_x64:
            raise ValueError(
                'steps are computed in doubles: call jax.config.update("jax_enable_x64", True) first'
            )
        super().__init__(StepFunction(worlds, controls, parameters, smoothing, where))
        memory, _ = self._function.present()
        most = max(memory.contacts[name].shape[1] for name in ("contact_distance", "overlap_place"))
        room = max(_CONTACT_ROOM, most) if contact_room is None else contact_room
        self._packing = Packing(memory, {"contact": room, "overlap": room})
        self._step = self._differentiable()

    def state(self) -> State:
        """The present state of the worlds."""
        memory, arrays = self._function.present()
        positions, velocities, activations = map(jnp.asarray, arrays[:3])
        return State(positions, velocities, activations, jnp.asarray(self._packing.pack(memory)))

    def control_values(self) -> Any:
        """The present values of the controls, (n, nu)."""
        return jnp.asarray(self._function.present()[1].controls)

    def parameter_values(self) -> Any:
        """The present values of the parameters, (n, np)."""
        return jnp.asarray(self._function.present()[1].parameters)

    def __call__(self, state: State, controls: Any = None, parameters: Any = None) -> State:
        """The state after a step.

        Args:
            state: The state before it.
            controls: Values of the controls in this step, (n, nu), or (nu,) for all worlds; None only if
                there are none.
            parameters: Values of the parameters, (n, np), or (np,) for all worlds; None only if there are
                none.

        Raises:
            TypeError: Something is no array of doubles.
            ValueError: A shape is wrong.
        """
        given = (state.positions, state.velocities, state.activations, controls, parameters)
        sizes = [int(size[0]) for size in self._function.sizes]
        arrays = [
            self._checked(name, array, size)
            for name, array, size in zip(StepArrays._fields, given, sizes, strict=True)
        ]
        wanted = (self.count, self._packing.size)
        if state.memory.shape != wanted:
            raise ValueError(f"the memory must have shape {wanted}, not {state.memory.shape}")
        return State(*self._step(state.memory, *arrays))

    def _checked(self, name: str, value: Any, size: int) -> Any:
        """An array (n, size) of doubles."""
        if value is None:
            if size:
                raise ValueError(f"{name} must have shape ({self.count}, {size}), and are missing")
            return jnp.zeros((self.count, 0))
        array = jnp.asarray(value)
        if array.dtype != np.float64:
            raise TypeError(
                f"{name} are {array.dtype}, but steps are computed in doubles: use .astype(float)"
            )
        if name in ("controls", "parameters") and array.shape == (size,):
            array = jnp.broadcast_to(array, (self.count, size))
        if array.shape != (self.count, size):
            raise ValueError(f"{name} must have shape ({self.count}, {size}), not {array.shape}")
        return array

    def _differentiable(self) -> Any:
        """The step as a function (memory, *given) -> (positions, velocities, activations, memory)."""
        function, packing = self._function, self._packing
        sizes = [int(size[0]) for size in function.sizes]
        columns = [jax.ShapeDtypeStruct((self.count, size), np.float64) for size in sizes]
        memory_type = jax.ShapeDtypeStruct((self.count, packing.size), np.uint8)

        batches = RepeatedSteps(function, packing)

        def step_here(memory: Any, *given: Any) -> tuple[np.ndarray, ...]:
            return batches.step(np.asarray(memory), StepArrays(*map(np.asarray, given)))

        def pull_back_here(memory: Any, *rest: Any) -> tuple[np.ndarray, ...]:
            arrays = [np.asarray(it) for it in rest]
            given = StepArrays(*arrays[: len(sizes)])
            return batches.pulled_back(np.asarray(memory), given, *arrays[len(sizes) :])

        def plain(memory: Any, *given: Any) -> Any:
            return jax.pure_callback(
                step_here, (*columns[:3], memory_type), memory, *given, vmap_method="broadcast_all"
            )

        step: Any = jax.custom_vjp(plain)

        def forward(memory: Any, *given: Any) -> tuple[Any, Any]:
            return step(memory, *given), (memory, *given)

        def backward(kept: Any, gradients: Any) -> Any:
            found = jax.pure_callback(
                pull_back_here, tuple(columns), *kept, *gradients[:3], vmap_method="broadcast_all"
            )
            return (np.zeros(kept[0].shape, jax.dtypes.float0), *found)

        step.defvjp(forward, backward)
        return step
