"""Steps of many worlds that PyTorch differentiates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

try:
    import torch
except ImportError as missing:
    raise ImportError(
        "carom.torch needs PyTorch; install it with: pip install 'carom[train]'", name="torch"
    ) from missing

from carom.worlds.algorithms.step_function import NamedColumns, StepArrays, StepFunction
from carom.worlds.saved import SavedWorlds

if TYPE_CHECKING:
    from carom.worlds.worlds import Worlds


@dataclass(frozen=True, eq=False, slots=True)
class State:
    """The state of n worlds, as double tensors on the processor.

    Attributes:
        positions: Coordinates that can change, (n, nq), named by `Stepper.coordinates`: joint positions [rad
            or m]; of a free base the position (x, y, z) of its inertial frame in world axes [m] and its
            quaternion (x, y, z, w).
        velocities: Velocities, (n, nv), named by `Stepper.velocities`: of a free base angular, then linear
            ones in world axes [rad/s, m/s].
        activations: Activations of actuators that have one, (n, na).
        memory: The rest of the state, which has no gradients: contacts and impulses of the step before,
            settings of motors, time. Keep it as it is: a step starts from it.
    """

    positions: torch.Tensor
    velocities: torch.Tensor
    activations: torch.Tensor
    memory: SavedWorlds

    def detach(self) -> State:
        """The same state without its history: gradients do not go back beyond it."""
        return State(
            self.positions.detach(), self.velocities.detach(), self.activations.detach(), self.memory
        )

    def replaced(
        self, *, positions: torch.Tensor | None = None, velocities: torch.Tensor | None = None
    ) -> State:
        """The same state with other positions (n, nq) or velocities (n, nv)."""
        return State(
            self.positions if positions is None else positions,
            self.velocities if velocities is None else velocities,
            self.activations,
            self.memory,
        )


class Stepper(NamedColumns):
    """Steps of worlds as a function from a state to the next, which `backward` goes through.

    A step is, bit for bit, that of `Worlds.step`, and depends on its arguments only: call it from any state
    as often as you like. `worlds` itself has the state, controls and parameters of the last call afterwards,
    so its contacts, poses and images are those after it.

    The gradients are the vector-Jacobian products of `Worlds.step_vjp`; no matrices are made. `backward`
    performs each step again to find the factors of its derivatives; until then a step keeps its state and
    memory, about 8 KB for each world with a Panda. What is neither state, control nor chosen parameter
    (gravity, say) has to stay as it is until then.

    Gradients by a quaternion are along the unit sphere; one of another norm is made unit first.

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
        where: Which worlds take steps: a mask (count,) or their indices; None for all. Tensors have rows for
            these only, in this order; the others stay as they are.

    Raises:
        ValueError: There is no such control or parameter, or `where` names a world twice.
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
    ) -> None:
        super().__init__(StepFunction(worlds, controls, parameters, smoothing, where))

    def state(self) -> State:
        """The present state of the worlds, as new tensors."""
        memory, arrays = self._function.present()
        positions, velocities, activations = map(torch.from_numpy, arrays[:3])
        return State(positions, velocities, activations, memory)

    def control_values(self) -> torch.Tensor:
        """The present values of the controls, (n, nu)."""
        return torch.from_numpy(self._function.present()[1].controls)

    def parameter_values(self) -> torch.Tensor:
        """The present values of the parameters, (n, np)."""
        return torch.from_numpy(self._function.present()[1].parameters)

    def __call__(
        self, state: State, controls: torch.Tensor | None = None, parameters: torch.Tensor | None = None
    ) -> State:
        """The state after a step.

        Args:
            state: The state before it.
            controls: Values of the controls in this step, (n, nu), or (nu,) for all worlds; None only if
                there are none.
            parameters: Values of the parameters, (n, np), or (np,) for all worlds; None only if there are
                none.

        Raises:
            TypeError: Something is no tensor of doubles.
            ValueError: A shape is wrong, a tensor is not on the processor, or a value cannot be.
            NotImplementedError: A body is asleep or absent; `backward` raises it for a step that has no exact
                derivatives, and names what.
            carom.errors.SimulationError: A velocity is not finite after the step.
        """
        if len(state.memory) != self.count:
            raise ValueError(f"the state is of {len(state.memory)} worlds; this stepper has {self.count}")
        given = (state.positions, state.velocities, state.activations, controls, parameters)
        sizes = [int(size[0]) for size in self._function.sizes]
        tensors = [
            self._checked(name, tensor, size)
            for name, tensor, size in zip(StepArrays._fields, given, sizes, strict=True)
        ]
        positions, velocities, activations, memory = _Step.apply(self._function, state.memory, *tensors)
        return State(positions, velocities, activations, memory)

    def _checked(self, name: str, value: torch.Tensor | None, size: int) -> torch.Tensor:
        """A tensor (n, size) of doubles, on the processor."""
        if value is None:
            if size:
                raise ValueError(f"{name} must have shape ({self.count}, {size}), and are missing")
            return torch.zeros((self.count, 0), dtype=torch.float64)
        if not isinstance(value, torch.Tensor):
            raise TypeError(f"{name} must be a tensor, not {type(value).__name__}")
        if value.dtype != torch.float64:
            raise TypeError(f"{name} are {value.dtype}, but steps are computed in doubles: use .double()")
        if value.device.type != "cpu":
            raise ValueError(
                f"{name} are on {str(value.device)!r}, but steps are on the processor: use .cpu()"
            )
        if name in ("controls", "parameters") and value.shape == (size,):
            value = value.expand(self.count, size)
        if value.shape != (self.count, size):
            raise ValueError(f"{name} must have shape ({self.count}, {size}), not {tuple(value.shape)}")
        return value


class _Step(torch.autograd.Function):
    """A step: a function of tensors, and of the memory before it."""

    @staticmethod
    def forward(  # pyright: ignore[reportIncompatibleMethodOverride]
        function: StepFunction, memory: SavedWorlds, *given: torch.Tensor
    ) -> tuple[Any, ...]:
        after = function.step(memory, _arrays(given))
        return *map(torch.from_numpy, function.states(after)), after

    @staticmethod
    def setup_context(ctx: Any, inputs: tuple[Any, ...], output: tuple[Any, ...]) -> None:
        function, memory, *given = inputs
        ctx.function, ctx.memory = function, memory
        ctx.save_for_backward(*given)

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(  # pyright: ignore[reportIncompatibleMethodOverride]
        ctx: Any, *gradients: torch.Tensor
    ) -> tuple[Any, ...]:
        by_state = (np.asarray(it, dtype=float) for it in gradients[:3])
        found = ctx.function.pulled_back(ctx.memory, _arrays(ctx.saved_tensors), *by_state)
        return None, None, *map(torch.from_numpy, map(np.ascontiguousarray, found))


def _arrays(tensors: Sequence[torch.Tensor]) -> StepArrays:
    return StepArrays(*(tensor.detach().numpy() for tensor in tensors))
