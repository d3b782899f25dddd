"""Steps of many worlds linearised: the part of `Worlds` that finds derivatives of a step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite
from carom.engine.engine import Engine
from carom.engine.presence import any_absent
from carom.linearization.chosen import Chosen as Parts
from carom.linearization.chosen import chosen_parts
from carom.linearization.exact import StepLinearizer
from carom.linearization.linearized_step import refuse_passes, refuse_substeps
from carom.linearization.quality import Qualities
from carom.linearization.stepping import Copies
from carom.linearization.taken_step import StepDerivatives
from carom.native.gates import gated
from carom.scene.core.body_core import BodyCore
from carom.world.world import World
from carom.worlds.algorithms.mechanics import MechanicsBatch
from carom.worlds.chosen import Mask, Where, world_numbers
from carom.worlds.devices import CPU


@dataclass(frozen=True, eq=False, slots=True)
class LinearizedSteps:
    """What a step does to small changes in n worlds; see `LinearizedStep`, which has the same names.

    Attributes:
        A: By the state, (n, nx, nx).
        B: By the controls, (n, nx, nu).
        E: By the parameters, (n, nx, np).
        states: Names of the entries of x.
        controls: Names of the entries of u.
        parameters: Names of the entries of p.
        rows: Of each world, the names of the solver's rows and whether they hold or are at a bound.
        residuals: Of each world, as `LinearizedStep.residual`, (n,).
        measured: Of each world, as `LinearizedStep.measured`.
    """

    A: Array
    B: Array
    E: Array
    states: tuple[str, ...]
    controls: tuple[str, ...]
    parameters: tuple[str, ...]
    rows: tuple[tuple[tuple[str, str], ...], ...]
    residuals: Array
    measured: tuple[tuple[str, ...], ...] = ()


class Linearizing:
    """Base class of `Worlds`: derivatives of a step."""

    count: int
    device: str
    halted: Mask
    _scene: World
    _engine: Engine
    _thread_count: int | None
    _linearizer: _Linearizer | None = None

    @gated("_scene.call_lock")
    def linearize(
        self,
        controls: Sequence[str] = ("torques",),
        *,
        parameters: Sequence[str] = (),
        smoothing: float = 0.0,
        where: Where | None = None,
    ) -> LinearizedSteps:
        """What the next step would do to small changes in n worlds; see `World.linearize`.

        The worlds do not change. Each is linearised as a lone world with its state and its parameters.

        Args:
            controls: As in `World.linearize`.
            parameters: Likewise.
            smoothing: Likewise.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: There is no such control or parameter; a world is halted.
            NotImplementedError: Something in a step has no exact derivatives, worlds are on a GPU, or bodies
                are absent.
            carom.errors.SimulationError: A velocity is not finite.
        """
        parts, found = self._derivatives(controls, parameters, smoothing, where, described=True)
        count = parts.control_count
        return LinearizedSteps(
            *(found.by_state, found.by_input[:, :, :count], found.by_input[:, :, count:]),
            *(parts.states, parts.controls, parts.parameters),
            tuple(found.rows),
            found.qualities.residuals,
            tuple(
                tuple(rows[row][0] for row in found.qualities[world].measured)
                for world, rows in enumerate(found.rows)
            ),
        )

    @gated("_scene.call_lock")
    def step_vjp(
        self,
        cotangents: ArrayLike,
        controls: Sequence[str] = ("torques",),
        *,
        parameters: Sequence[str] = (),
        smoothing: float = 0.0,
        where: Where | None = None,
    ) -> tuple[Array, Array, Array]:
        """The vector-Jacobian products of the next step in n worlds; see `World.step_vjp`.

        Args:
            cotangents: The gradients by the states after the step, (n, nx).
            controls: As in `linearize`, like all that follow.
            parameters: Likewise.
            smoothing: Likewise.
            where: Likewise.

        Returns:
            The gradients by state (n, nx), controls (n, nu) and parameters (n, np).

        Raises:
            ValueError, NotImplementedError, carom.errors.SimulationError: As `linearize`.
        """
        parts, found = self._derivatives(controls, parameters, smoothing, where)
        count, shape = parts.control_count, found.by_state.shape[:2]
        given = finite(cotangents, "cotangents")
        if given.shape != shape:
            raise ValueError(f"cotangents must have shape {shape}, not {given.shape}")
        by_state, by_input = found.pulled_back(given)
        return by_state, by_input[:, :count], by_input[:, count:]

    def _derivatives(
        self,
        controls: Sequence[str],
        parameters: Sequence[str],
        smoothing: float,
        where: Where | None,
        start: Callable[[Engine], None] | None = None,
        *,
        described: bool = False,
    ) -> tuple[Parts, StepDerivatives]:
        """What was chosen, and the derivatives of a step of each world.

        `start` may give the copies that take the step another state and other parameters.
        """
        if self.device != CPU:
            raise NotImplementedError(f"steps on {self.device!r} cannot be linearised: use device={CPU!r}")
        if not smoothing >= 0.0:
            raise ValueError(f"smoothing must be at least 0, not {smoothing}")
        worlds = world_numbers(where, self.count)
        halted = worlds[self.halted[worlds]]
        if len(halted) and start is None:
            raise ValueError(f"world {halted[0]} is halted, so it has no next step")
        if any_absent(self._engine.arrays):
            raise NotImplementedError("steps cannot be linearised where bodies are absent")
        refuse_substeps(self._scene)
        refuse_passes(self._scene)
        parts = chosen_parts(self._scene, controls, parameters)
        parts.refuse_inertial(self._engine.arrays.model.numpy, "exact")
        if not len(worlds):
            width, inputs = len(parts.states), len(parts.inputs)
            return parts, StepDerivatives(
                np.zeros((0, width, width)), np.zeros((0, width, inputs)), [], Qualities(np.zeros(0))
            )
        if self._linearizer is None or not self._linearizer.follow():
            self._linearizer = _Linearizer(self._scene, self._engine, self._thread_count or 1)
        return parts, self._linearizer.find(parts, worlds, smoothing, start, described=described)


class _Linearizer:
    """A copy of the worlds of an engine that takes the steps which are linearised."""

    def __init__(self, scene: World, engine: Engine, threads: int) -> None:
        self._scene, self._engine = scene, engine
        self._threads = threads
        self._copies = Copies.of_engine(engine, scene.parameters, threads)
        self._made_for = self._now()
        self._mechanics: dict[BodyCore, MechanicsBatch] = {}

    def _now(self) -> tuple[Any, ...]:
        return (
            self._engine.changes,
            self._engine.contact_arrays.user_count,
            *self._engine.arrays.used.values(),
        )

    def follow(self) -> bool:
        """Take the present state and parameters; False if a new copy is needed."""
        return self._made_for == self._now() and self._copies.follow(self._engine, 0.0)

    def find(
        self,
        parts: Parts,
        worlds: np.ndarray,
        smoothing: float,
        start: Callable[[Engine], None] | None = None,
        *,
        described: bool = False,
    ) -> StepDerivatives:
        """Perform a step of some worlds, and differentiate it."""
        copies = self._copies
        kept = copies.linearizer
        if not isinstance(kept, StepLinearizer) or not kept.suits(parts.space, parts.inputs, copies):
            kept = copies.linearizer = StepLinearizer(
                *(parts.space, parts.inputs, copies),
                *(self._structs_of, self._threads),
            )
        if start is not None:
            start(copies.engine)
        return kept.step(self._scene.parameters, worlds, smoothing, described=described)

    def _structs_of(self, body: BodyCore) -> tuple[list[list[Any]], Any]:
        return self._mechanics_of(body).sweep_structs()

    def _mechanics_of(self, body: BodyCore) -> MechanicsBatch:
        if body not in self._mechanics:
            self._mechanics[body] = MechanicsBatch(body, self._copies.engine, self._threads)
        return self._mechanics[body]
