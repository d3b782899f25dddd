"""Steps of the Runge-Kutta method of fourth order, linearised: see `kernels.integrators.runge_kutta`.

Each stage is an explicit step of copies from the state of that stage, which kernels linearise. Here these are
chained: velocities of free bases are along their own axes meanwhile, and rotations of free bases and of
spherical joints are rotation vectors φ since the step began, with rates ω + φ × ω/2 + φ × (φ × ω)/12.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from carom.engine.parameters import EULER, EngineParameters
from carom.linearization.integrators.activation_rates import ActivationRates
from carom.linearization.integrators.frame_motions import FrameMotions
from carom.linearization.integrators.positions import (
    changes_after,
    own_rates,
    positions_after,
    world_rates,
)
from carom.linearization.row_names import StateWithoutDerivativesError
from carom.linearization.stepping import Copies
from carom.linearization.turns import (
    cross,
    cross_matrix,
    inverse,
    left_derivative,
    multiplied,
    rotation_of,
    vector_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from carom.linearization.inputs import Input
    from carom.linearization.taken_step import StepDerivatives
    from carom.linearization.tangent import TangentSpace

_WEIGHTS = (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
_AHEAD = (0.5, 0.5, 1.0)
# States that differ by no more than this, relative to their greatest number, are the same.
_SAME = 1e-7
_FORCES = ("dof_torque", "link_wrench")
_UNIT = np.eye(3)


class StageLinearizer(Protocol):
    """What linearises the stages: a `StepLinearizer`."""

    def stage(
        self, parameters: Any, worlds: np.ndarray | None, smoothing: float, *, described: bool
    ) -> tuple[StepDerivatives, np.ndarray]:
        """As that of `StepLinearizer`."""
        ...


class RungeKuttaSteps:
    """Linearises steps of the worlds of `copies` with integrator="rk4".

    Args:
        space: The tangent space.
        inputs: Controls and parameters.
        copies: The worlds, which take the steps.
        make: Makes what linearises the stages, which other copies take.
        threads: Number of threads.
    """

    def __init__(
        self,
        space: TangentSpace,
        inputs: Sequence[Input],
        copies: Copies,
        make: Callable[[Copies], StageLinearizer],
        threads: int,
    ) -> None:
        self._space, self._inputs, self._copies = space, inputs, copies
        self._make, self._threads = make, threads
        self._stages: tuple[Copies, StageLinearizer] | None = None
        self._frames = FrameMotions(space, copies.engine.arrays)

    def step(
        self, parameters: EngineParameters, worlds: np.ndarray, smoothing: float, *, described: bool
    ) -> StepDerivatives:
        """As `StepLinearizer.step`, of worlds by their numbers, (m,); rows are those of the last stage.

        What is at a switch in any stage is told.
        """
        self._copies.apply_forces()
        copies, linearizer = self._follow(replace(parameters, integrator=EULER))
        chains = [self._chain(copies, world, parameters.substep_time) for world in worlds.tolist()]
        state = copies.engine.arrays.state.numpy
        forces = [(name, state[name].copy()) for name in _FORCES]
        everywhere = None if len(worlds) == copies.count else worlds
        residuals = np.zeros(len(worlds))
        by_frame = self._frames.follow(parameters)
        stages: list[StepDerivatives] = []
        for number in range(len(_WEIGHTS)):
            state = copies.engine.arrays.state.numpy
            for name, kept in forces:
                state[name][:] = kept
            for chain in chains:
                chain.write(state)
            found, ends = linearizer.stage(
                *(copies.parameters, everywhere, smoothing),
                described=described,
            )
            residuals = np.maximum(residuals, found.qualities.residuals)
            stages.append(found)
            for place, chain in enumerate(chains):
                if by_frame:
                    where, by_state = chain.present(), found.by_state[place]
                    self._frames.add_carried(*where, ends[place], by_state, parameters.substep_time)
                chain.advance(number, ends[place], found.by_state[place], found.by_input[place])
        last = stages[-1]
        last.qualities.residuals = residuals
        for place in range(len(worlds) if described else 0):
            near = [name for it in stages[:-1] for name in _at_switch(it, place)]
            last.qualities.of_stages[place] = tuple(dict.fromkeys(near))
        self._copies.step(everywhere)
        state = self._copies.engine.arrays.state.numpy
        for place, chain in enumerate(chains):
            chain.close()
            self._check(chain, state, int(worlds[place]))
            last.by_state[place], last.by_input[place] = chain.finish()
        return last

    def _check(self, chain: _Chain, state: dict[str, np.ndarray], world: int) -> None:
        """Check that stages have led to the state after a step."""
        position, velocity = state["position"][world], state["dof_velocity"][world, self._space.dofs]
        own = chain.end.position[0]
        pairs = (own, position[: len(own)]), (chain.end_velocity(), velocity)
        for mine, its in pairs:
            if np.abs(mine - its).max(initial=0.0) > _SAME * max(1.0, np.abs(its).max(initial=0.0)):
                raise StateWithoutDerivativesError(
                    f"the stages of a step with integrator='rk4' in world {world} have not led where it "
                    'leads, so that it has no exact derivatives: use method="differences"'
                )

    def _follow(self, parameters: EngineParameters) -> tuple[Copies, StageLinearizer]:
        """Copies in the present state that take stages, and what linearises these."""
        engine = self._copies.engine
        if self._stages is not None:
            copies = self._stages[0]
            copies.parameters = parameters
            if copies.follow(engine, 0.0):
                return self._stages
        copies = Copies.of_engine(engine, parameters, self._threads)
        self._stages = copies, self._make(copies)
        return self._stages

    def _chain(self, copies: Copies, world: int, time_step: float) -> _Chain:
        state, arrays = copies.engine.arrays.state.numpy, copies.engine.arrays
        own = slice(world, world + 1)
        # Fields of the model may be those of all worlds.
        model = {
            name: arrays.model.numpy[name][world if len(arrays.model.numpy[name]) > 1 else 0]
            if arrays.model.is_per_world(name)
            else arrays.model.numpy[name]
            for name in _OF_ACTUATORS
        }
        space = self._space
        rates = ActivationRates(model, space.activations, state["actuator_control"][world], self._inputs)
        bounds = (model[f"actuator_activation_{end}"][space.activations] for end in ("lower", "upper"))
        return _Chain(
            space, world, time_step, len(self._inputs), rates, tuple(bounds),
            state["position"][own].copy(), state["dof_velocity"][own][:, space.dofs],
            state["actuator_activation"][world, space.activations],
        )  # fmt: skip


_OF_ACTUATORS = (
    *("actuator_dynamics", "actuator_time_constant", "actuator_muscle_time"),
    *("actuator_control_lower", "actuator_control_upper"),
    *("actuator_activation_lower", "actuator_activation_upper"),
)


def _at_switch(stage: StepDerivatives, place: int) -> tuple[str, ...]:
    """Names of what is at a switch in a stage."""
    return stage.qualities[place].names_at_switch(stage.rows[place])


@dataclass(slots=True)
class _Point:
    """A state with its changes by the first state and by inputs, (..., columns).

    Attributes:
        position: Positions, (1, coordinates).
        velocity: Velocities of the dofs, those of bases along their own axes, (n,).
        activation: Activations, (a,).
        moved, sped, activated: Their changes.
    """

    position: np.ndarray
    velocity: np.ndarray
    activation: np.ndarray
    moved: np.ndarray
    sped: np.ndarray
    activated: np.ndarray


class _Chain:
    """The four stages of a world.

    Attributes:
        end: The state at the end, once `close` was called.
    """

    def __init__(
        self,
        space: TangentSpace,
        world: int,
        time_step: float,
        inputs: int,
        rates: ActivationRates,
        bounds: tuple[Any, ...],
        position: np.ndarray,
        velocity: np.ndarray,
        activation: np.ndarray,
    ) -> None:
        n, a = len(space), len(activation)
        self._space, self._world, self._h = space, world, time_step
        self._activation_rates, self._bounds = rates, bounds
        self._width = 2 * n + a
        every = np.eye(self._width, self._width + inputs)
        moved, sped, activated = every[:n], every[n : 2 * n].copy(), every[2 * n :]
        for q, dof in space.bases:
            own = slice(dof, dof + 3)
            back = rotation_of(position[0, q + 3 : q + 7]).T
            sped[own] = back @ (sped[own] - _turned(moved[own], velocity[0, own]))
        self._first = _Point(
            position, own_rates(space, position[0], velocity[0]), activation, moved, sped, activated
        )
        self._now = self.end = self._first
        columns = every.shape[1]
        self._rate, self._rates = np.zeros(n), np.zeros((n, columns))
        self._change, self._changes = np.zeros(n), np.zeros((n, columns))
        self._active, self._actives = np.zeros(a), np.zeros((a, columns))

    def present(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions (coordinates,) and velocities (n,), in world axes, of the present stage."""
        position = self._now.position[0]
        return position, world_rates(self._space, position, self._now.velocity)

    def write(self, state: dict[str, np.ndarray]) -> None:
        """Write the state of the present stage to that of its world."""
        now, space = self._now, self._space
        state["position"][self._world] = now.position[0]
        state["dof_velocity"][self._world, space.dofs] = world_rates(space, now.position[0], now.velocity)
        state["actuator_activation"][self._world, space.activations] = now.activation

    def advance(self, stage: int, end: np.ndarray, by_state: np.ndarray, by_input: np.ndarray) -> None:
        """Take a stage into the sums, and go on to the next one.

        Args:
            stage: Its number, 0 to 3.
            end: Velocities (n,) to which it leads in a whole step, those of bases in world axes.
            by_state: Derivatives of the state after that by that of the stage.
            by_input: By inputs.
        """
        space, now, n, h = self._space, self._now, len(self._space), self._h
        sped = now.sped.copy()
        for q, dof in space.bases:
            own = slice(dof, dof + 3)
            turn = rotation_of(now.position[0, q + 3 : q + 7])
            sped[own] = turn @ sped[own] + _turned(now.moved[own], turn @ now.velocity[own])
        ended = by_state[n : 2 * n] @ np.concatenate([now.moved, sped, now.activated])
        ended[:, self._width :] += by_input[n : 2 * n]
        for q, dof in space.bases:
            own = slice(dof, dof + 3)
            back = rotation_of(now.position[0, q + 3 : q + 7]).T
            ended[own] = back @ (ended[own] - _turned(now.moved[own], end[own]))
        change = own_rates(space, now.position[0], end) - now.velocity
        changed = ended - now.sped
        rate, rated = self._rates_of_turns(now)
        active, by_activation, by_control = self._activation_rates.of(now.activation)
        actives = by_activation[:, None] * now.activated
        actives[:, self._width :] += by_control[:, None] * self._activation_rates.by_inputs
        weight = _WEIGHTS[stage]
        self._rate, self._rates = self._rate + weight * rate, self._rates + weight * rated
        self._change, self._changes = self._change + weight * change, self._changes + weight * changed
        self._active, self._actives = self._active + weight * active, self._actives + weight * actives
        if stage < len(_AHEAD):
            ahead = _AHEAD[stage]
            durations = np.full(len(active), ahead * h)
            self._now = self._point(
                (ahead * rate, ahead * rated), (ahead * change, ahead * changed), (active, actives), durations
            )

    def close(self) -> None:
        """Find the state at the end; all stages have been taken."""
        self.end = self._point(
            *((self._rate, self._rates), (self._change, self._changes), (self._active, self._actives)),
            self._activation_rates.durations(self._h),
        )

    def end_velocity(self) -> np.ndarray:
        """Velocities at the end, (n,), in world axes."""
        return world_rates(self._space, self.end.position[0], self.end.velocity)

    def finish(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the state at the end by that before the step, and by inputs."""
        space, end = self._space, self.end
        for q, dof in space.bases:
            own = slice(dof, dof + 3)
            turn = rotation_of(end.position[0, q + 3 : q + 7])
            end.sped[own] = turn @ end.sped[own] + _turned(end.moved[own], turn @ end.velocity[own])
        lower, upper = self._bounds
        end.activated[(end.activation <= lower) | (end.activation >= upper)] = 0.0
        found = np.concatenate([end.moved, end.sped, end.activated])
        return found[:, : self._width], found[:, self._width :]

    def _point(
        self,
        rates: tuple[np.ndarray, np.ndarray],
        changes: tuple[np.ndarray, np.ndarray],
        actives: tuple[np.ndarray, np.ndarray],
        durations: np.ndarray,
    ) -> _Point:
        """The state that follows from the first one by rates of positions and changes of velocities."""
        space, first = self._space, self._first
        turning = rates[1].copy()
        for q, dof in space.bases:
            own = slice(dof, dof + 3)
            turn = rotation_of(first.position[0, q + 3 : q + 7])
            turning[own] = turn @ turning[own] + _turned(first.moved[own], turn @ rates[0][own])
        rate = world_rates(space, first.position[0], rates[0])
        return _Point(
            positions_after(space, first.position, rate[None], self._h),
            first.velocity + changes[0],
            first.activation + durations * actives[0],
            changes_after(space, rate, first.moved, turning, self._h),
            first.sped + changes[1],
            first.activated + durations[:, None] * actives[1],
        )

    def _rates_of_turns(self, now: _Point) -> tuple[np.ndarray, np.ndarray]:
        """Rates by which positions move since the start, for the velocities of a stage, and their changes."""
        rate, rated = now.velocity.copy(), now.sped.copy()
        turning = [(q + 3, dof, True) for q, dof in self._space.bases]
        turning += [(q, dof, False) for q, dof in self._space.balls]
        for q, dof, is_base in turning:
            own = slice(dof, dof + 3)
            start, end = self._first.position[0, q : q + 4], now.position[0, q : q + 4]
            turned = vector_of(multiplied(inverse(start), end))
            omega = now.velocity[own]
            across = cross(turned, omega)
            rate[own] = omega + 0.5 * across + cross(turned, across) / 12.0
            # Changes of the rotation vector, from those of both orientations along own axes.
            first, last = self._first.moved[own], now.moved[own]
            if is_base:
                first, last = rotation_of(start).T @ first, rotation_of(end).T @ last
            bent = np.linalg.solve(
                left_derivative(-turned), last - rotation_of(multiplied(inverse(end), start)) @ first
            )
            skew = cross_matrix(turned)
            by_turn = -0.5 * cross_matrix(omega) - (cross_matrix(across) + skew @ cross_matrix(omega)) / 12.0
            rated[own] = (_UNIT + 0.5 * skew + skew @ skew / 12.0) @ rated[own] + by_turn @ bent
        return rate, rated


def _turned(turns: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Changes (3, columns) of a vector that turns by small rotation vectors (3, columns)."""
    found: np.ndarray = -cross_matrix(vector) @ turns
    return found
