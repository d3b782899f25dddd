"""The linearisation of steps of a world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, vector
from carom.linearization.chosen import Chosen, chosen_parts
from carom.linearization.converged.steps_without_slip import has_passes
from carom.linearization.differences import differences
from carom.linearization.exact import step_derivatives
from carom.linearization.given_state import GivenState, Start
from carom.linearization.outputs import OutputDerivatives, Outputs
from carom.linearization.quality import StepQuality, tell_of_differences, warn_of
from carom.linearization.stepping import copy_of
from carom.linearization.taken_step import StepDerivatives

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore
    from carom.world.world import World

_SIZE = 1e-6
# Sweeps of a step that is to converge, and the squared change of a velocity at which they end.
_MOST_SWEEPS = 20000
_SETTLED = 1e-28


@dataclass(frozen=True, eq=False, slots=True)
class LinearizedStep:
    """What steps of a world do to small changes: x⁺ = A x + B u + E p, y = C x + D u.

    The state x has the changes of positions, then those of velocities, then those of activations of
    actuators. A change of positions has one number for each velocity: it is the motion in a unit of time with
    this number as velocity. For a free base these are a rotation vector [rad] and a displacement [m], in
    world axes and about the centre of mass of the base, as angular and linear velocity in `World.velocity`;
    for a spherical joint a rotation vector along the axes of its link; for a planar joint the angle, and
    displacements along the axes of its link. `World.velocity` has the velocities. Bodies without anything
    that moves have no part in the state.

    Attributes:
        A: By the state, (nx, nx).
        B: By the controls, (nx, nu).
        C: Outputs by the state, (ny, nx).
        D: Outputs by the controls, (ny, nu).
        E: By the parameters, (nx, np).
        states: Names of the entries of x: "robot.elbow.position", "robot.base.turn.x.position"...
        controls: Names of the entries of u: "robot.elbow.torque"...
        parameters: Names of the entries of p: "robot.forearm.mass"...
        rows: Names of the solver's rows in the last step and whether they hold or are at a bound; empty with
            `method="differences"`.
        residual: By how much the last sweep of the solver still changed a velocity in these steps [m/s or
            rad/s]: the step differs from the one that is linearised, to which sweeps converge. 0 with
            `method="differences"`.
        redundant: Names of rows of the last step whose impulses are not determined, as those of four feet.
            Velocities do not depend on them, unless the rows contradict each other: then `residual` stays.
        distances: Of each of `rows`, how far it is from where it would change its status, and the derivatives
            with it: of a motor, friction or another bounded impulse which share of its bound is left, of an
            actuator also of the range of its control; of a contact that pushes the size of its gap [m], less
            its margin where it yields; infinite without a bound, NaN where it is not known, as for rows at a
            bound, and limits.
        at_switch: Names of rows of the last step that are nearer than 1e-6 to a switch, where derivatives are
            those of one side. That of an actuator is there if its control is at an end of its range. Also
            what has no row there: contacts at their margin that would push within it ("contact 0 of sphere
            and plane"), and muscles whose activation is their control ("muscle arm.biceps"), which rise and
            fall at different rates.
        measured: Names of contacts of the last step that move as central differences of collision detection
            say, for want of a closed form, as those of capsules with each other; all else is exact.
        outputs: Names of the entries of y if these are readings of sensors: "robot.imu.0"...; else empty.
        method: "exact", or "differences" for central differences of the steps themselves.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    E: Array
    states: tuple[str, ...]
    controls: tuple[str, ...]
    parameters: tuple[str, ...]
    rows: tuple[tuple[str, str], ...]
    outputs: tuple[str, ...] = ()
    residual: float = 0.0
    redundant: tuple[str, ...] = ()
    distances: tuple[float, ...] = ()
    at_switch: tuple[str, ...] = ()
    measured: tuple[str, ...] = ()
    method: str = "exact"


def linearize(
    world: World,
    controls: Sequence[str],
    parameters: Sequence[str],
    steps: int,
    method: str,
    smoothing: float,
    outputs: Outputs | None,
    start: Start,
    tight: bool = False,
) -> LinearizedStep:
    """As `World.linearize`."""
    check_steps(steps)
    if tight:
        with converging(world):
            return linearize(world, controls, parameters, steps, method, smoothing, outputs, start)
    if method == "auto":
        try:
            return _linearized(world, controls, parameters, steps, "exact", smoothing, outputs, start)
        except NotImplementedError as problem:
            if smoothing:
                raise
            try:
                found = _linearized(world, controls, parameters, steps, "differences", 0.0, outputs, start)
            except NotImplementedError:
                raise problem from None
            tell_of_differences(world, problem)
            return found
    return _linearized(world, controls, parameters, steps, method, smoothing, outputs, start)


def _linearized(
    world: World,
    controls: Sequence[str],
    parameters: Sequence[str],
    steps: int,
    method: str,
    smoothing: float,
    outputs: Outputs | None,
    start: Start,
) -> LinearizedStep:
    if method not in ("exact", "differences"):
        raise ValueError(f"method must be 'auto', 'exact' or 'differences', not {method!r}")
    if not smoothing >= 0.0 or (smoothing and method != "exact"):
        raise ValueError(f"smoothing must be at least 0, and 0 with differences, not {smoothing}")
    chosen = chosen_parts(world, controls, parameters)
    rows: tuple[tuple[str, str], ...] = ()
    last: StepQuality | None = None
    residual = 0.0
    taken: list[StepDerivatives] = []
    chosen.refuse_inertial(world.arrays.model.numpy, method)
    space, count = chosen.space, chosen.control_count
    given = start.checked(space, chosen.inputs[:count])
    if method == "differences":
        by_state, by_input = differences(world, space, chosen.inputs, steps, _SIZE, given)
    else:
        taken = performed(world, chosen, steps, smoothing, given)
        by_state, by_input = _chained(taken)
        qualities = [it.qualities[0] for it in taken]
        rows, last = taken[-1].rows[0], qualities[-1]
        residual = max(it.residual for it in qualities)
        warn_of(world, qualities, rows)
    seen, fed, names = np.zeros((0, len(by_state))), np.zeros((0, count)), ()
    if outputs is not None:
        # Sensors of accelerations need the state before the last step, too.
        before = np.eye(len(by_state)), np.zeros(by_input.shape)
        if steps > 1 and method == "differences":
            before = differences(world, space, chosen.inputs, steps - 1, _SIZE, given)
        elif steps > 1:
            before = _chained(taken[:-1])
        by_outputs = OutputDerivatives(world, space, chosen.inputs[:count], steps, given)
        both = (before[1][:, :count], by_input[:, :count])
        seen, fed, names = by_outputs.of(outputs, (before[0], by_state), both)
    return LinearizedStep(
        A=by_state,
        B=by_input[:, :count],
        C=seen,
        D=fed,
        E=by_input[:, count:],
        states=chosen.states,
        controls=chosen.controls,
        parameters=chosen.parameters,
        rows=rows,
        outputs=names,
        residual=residual,
        redundant=() if last is None else tuple(rows[row][0] for row in last.redundant),
        distances=() if last is None else last.distances,
        at_switch=() if last is None else last.names_at_switch(rows),
        measured=() if last is None else tuple(rows[row][0] for row in last.measured),
        method=method,
    )


@contextmanager
def converging(world: WorldCore) -> Iterator[None]:
    """Let the sweeps of a world go on until nothing changes any more, meanwhile."""
    parameters = world.parameters
    before = parameters.solver_iterations, parameters.solver_residual_threshold, parameters.noslip_iterations
    parameters.solver_iterations = max(_MOST_SWEEPS, before[0])
    parameters.solver_residual_threshold = min(_SETTLED, before[1])
    if before[2]:
        parameters.noslip_iterations = max(_MOST_SWEEPS, before[2])
    world.apply_parameters()
    try:
        yield
    finally:
        parameters.solver_iterations, parameters.solver_residual_threshold, parameters.noslip_iterations = (
            before
        )
        world.apply_parameters()


def check_steps(steps: int) -> None:
    """Raise `ValueError` unless there is at least one step."""
    if steps < 1:
        raise ValueError(f"steps must be at least 1, not {steps}")


def refuse_substeps(world: World) -> None:
    """Refuse steps that have no exact derivatives."""
    if world.parameters.substep_count > 1:
        raise NotImplementedError(
            'steps of several substeps have no exact derivatives: use method="differences"'
        )


def refuse_passes(world: World) -> None:
    """Refuse steps whose passes without slip only `World.linearize` and `World.step_vjp` differentiate."""
    if has_passes(world.parameters):
        raise NotImplementedError(
            "steps of several worlds with noslip_iterations have no exact derivatives: those of one world "
            "have (World.linearize), or change noslip_iterations to 0 before the worlds are made"
        )


def performed(
    world: World, chosen: Chosen, steps: int, smoothing: float, start: GivenState, *, described: bool = True
) -> list[StepDerivatives]:
    """The derivatives of some steps, one after the other, from a given start; see `StepLinearizer.step`."""
    refuse_substeps(world)
    copies = copy_of(world)
    start.write(copies.engine.arrays.state.numpy)
    if steps > 1:
        copies.keep_forces()
    return [
        step_derivatives(world, chosen.space, chosen.inputs, copies, smoothing, described=described)
        for _ in range(steps)
    ]


def _chained(taken: list[StepDerivatives]) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the last state by the first and by inputs."""
    by_state, by_input = taken[0].by_state[0], taken[0].by_input[0]
    for found in taken[1:]:
        stepped, driven = found.by_state[0], found.by_input[0]
        by_state, by_input = stepped @ by_state, stepped @ by_input + driven
    return by_state, by_input


def step_vjp(
    world: World,
    cotangent: ArrayLike,
    controls: Sequence[str],
    parameters: Sequence[str],
    steps: int,
    smoothing: float,
    start: Start,
) -> tuple[Array, Array, Array]:
    """As `World.step_vjp`."""
    check_steps(steps)
    chosen = chosen_parts(world, controls, parameters)
    chosen.refuse_inertial(world.arrays.model.numpy, "exact")
    count = chosen.control_count
    given = start.checked(chosen.space, chosen.inputs[:count])
    pulled = vector(cotangent, len(chosen.states), "cotangent")
    found = _pulled_back(performed(world, chosen, steps, smoothing, given, described=False), pulled)
    return found[0], found[1][:count], found[1][count:]


def _pulled_back(taken: list[StepDerivatives], cotangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A cotangent of the last state of some steps, as one of the first (nx,), and one of inputs."""
    by_input = np.zeros(taken[0].by_input.shape[2])
    for found in reversed(taken):
        of_states, of_inputs = found.pulled_back(cotangent[None])
        cotangent = of_states[0]
        by_input += of_inputs[0]
    return cotangent, by_input
