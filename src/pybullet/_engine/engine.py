"""Stepping a world, and the parameters of its engine."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_double, c_int64
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from carom.errors import SimulationError
from carom.native.change import Change, blank
from carom.native.uninterrupted import uninterrupted
from pybullet._calls.arguments import integer, quantity, real
from pybullet._calls.builtin import exported
from pybullet._calls.constants import DIRECT, RESET_USE_DEFORMABLE_WORLD, RESET_USE_REDUCED_DEFORMABLE_WORLD
from pybullet._calls.errors import fail
from pybullet._calls.quick import first_change
from pybullet._clients.clients import Client, client_of, clients
from pybullet._clients.shape_registry import ShapeRegistry

if TYPE_CHECKING:
    from carom.world.world import World

__all__ = [
    "getPhysicsEngineParameters",
    "resetSimulation",
    "setDefaultContactERP",
    "setGravity",
    "setInternalSimFlags",
    "setPhysicsEngineParameter",
    "setRealTimeSimulation",
    "setTimeStep",
    "stepSimulation",
]

# Parameters that determine how long a step takes: parameter, argument and maximum.
_WORK = {
    "substeps": ("numSubSteps", 10_000),
    "solver_iterations": ("numSolverIterations", 1_000_000),
    "noncontact_inner_iterations": ("numNonContactInnerIterations", 10_000),
}
_MAX_WORK = 10_000_000
# `enableConeFriction` of Carom alone.
_ISOTROPIC = 2
# Forces are computed as impulses divided by the time step [s], which must not be too small.
_MIN_TIME_STEP = 1e-12


# In both kinds of world, soft bodies use the material parameters of `loadSoftBody`.
_DEFORMABLE = RESET_USE_DEFORMABLE_WORLD | RESET_USE_REDUCED_DEFORMABLE_WORLD


def _switch(value: Any, name: str) -> int:
    """A switch as 0 or 1: 1 for all positive integers; negative ones are unchanged."""
    number = integer(value, name)
    return number if number < 0 else int(number != 0)


# Arguments of `setPhysicsEngineParameter`: parameter, conversion, and least value that is not ignored.
_PARAMETERS: dict[str, tuple[str, Callable[[Any, str], Any], int]] = {
    "numSolverIterations": ("solver_iterations", integer, 0),
    "useSplitImpulse": ("split_impulse", _switch, 0),
    "splitImpulsePenetrationThreshold": ("split_impulse_penetration_threshold", real, 0),
    "collisionFilterMode": ("collision_filter_mode", integer, 0),
    "contactBreakingThreshold": ("contact_breaking_threshold", quantity, 0),
    "restitutionVelocityThreshold": ("restitution_velocity_threshold", quantity, 0),
    "erp": ("erp", quantity, 0),
    "contactERP": ("contact_erp", quantity, 0),
    "frictionERP": ("friction_erp", quantity, 0),
    "enableConeFriction": ("cone_friction", _switch, 0),
    "deterministicOverlappingPairs": ("deterministic_overlapping_pairs", _switch, 0),
    "allowedCcdPenetration": ("allowed_ccd_penetration", quantity, 0),
    "jointFeedbackMode": ("joint_feedback_mode", integer, 0),
    "solverResidualThreshold": ("solver_residual_threshold", quantity, 0),
    "contactSlop": ("contact_slop", quantity, 0),
    "enableSAT": ("sat", _switch, 0),
    "constraintSolverType": ("constraint_solver", integer, 0),
    "globalCFM": ("global_cfm", quantity, 0),
    "minimumSolverIslandSize": ("minimum_island_size", integer, 0),
    "reportSolverAnalytics": ("report_solver_analytics", _switch, 0),
    "warmStartingFactor": ("warm_starting_factor", quantity, 0),
    "numNonContactInnerIterations": ("noncontact_inner_iterations", integer, 1),
    "numSubSteps": ("substeps", integer, 0),
}


@exported
def stepSimulation(physicsClientId: int = 0) -> tuple[dict[str, int | float], ...]:
    """Advances the simulation by `fixedTimeStep`, in `numSubSteps` equal substeps if set.

    Applied forces and torques last for this step only.

    Args:
        physicsClientId: The connection.

    Returns:
        An empty tuple; after `setPhysicsEngineParameter(reportSolverAnalytics=1)` a dictionary for each
        group of bodies that touch or are joined: `islandId`, `numBodies`, `numIterationsUsed` and
        `remainingResidual` of the solver.

    Raises:
        pybullet.error: Not connected, or the motion of a body is no longer finite.

    Examples:
        >>> for _ in range(240):
        ...     _ = p.stepSimulation()
        >>> p.getBasePositionAndOrientation(cube)[0][2] < 0.03
        True
    """
    try:
        client = clients[physicsClientId]
    except (KeyError, TypeError, ValueError):
        client = client_of(physicsClientId)
    if client.window.held:
        goes_on = client.window.wait_for_turn()
        client = client_of(physicsClientId)
        if not goes_on:
            return ()
    if not (client.report_analytics or client.world.observers):
        # It takes the lock itself, and gives it up while handlers of signals run for which it is undone.
        _take_step(client.world)
        return ()
    with client.call_lock, uninterrupted:
        _take_step(client.world)
        if not client.report_analytics:
            return ()
        from pybullet._engine.solver_analytics import solver_analytics

        return solver_analytics(client.world)


def _take_step(world: World) -> None:
    try:
        world.step()
    except SimulationError as problem:
        fail("stepSimulation failed:", f"{problem}.")


@exported
def resetSimulation(flags: int = 0, physicsClientId: int = 0) -> None:
    """Removes everything from the world and resets the engine's parameters.

    `fixedTimeStep` and `numSubSteps` do not change. Body ids start at 0 again.

    Args:
        flags: `RESET_USE_*` for another kind of world. Rigid bodies are the same in each; `loadSoftBody` uses
            its material parameters only with `RESET_USE_DEFORMABLE_WORLD` or
            `RESET_USE_REDUCED_DEFORMABLE_WORLD`.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.resetSimulation()
        >>> p.getNumBodies()
        0
    """
    client = client_of(physicsClientId)
    deformable = bool(integer(flags, "flags") & _DEFORMABLE)
    with client.call_lock:
        client.bodies.forget_all()

        def also(change: Change) -> None:
            change.set(client, "shapes", ShapeRegistry())
            change.refill(client.states, {})
            change.refill(client.origins, {})
            change.set(client, "maximal", set())
            record = client.bodies.quick.record
            change.copy_blocks(blank(record, "reports_analytics"), record)
            change.set(client, "deformable", deformable)
            note_no_drawings(change)

        with uninterrupted, client.window.without_drawings() as note_no_drawings:
            client.world._clear(also)


@exported
def setGravity(gravX: float, gravY: float, gravZ: float, physicsClientId: int = 0) -> None:
    """Sets gravity; default 0.

    Args:
        gravX: Acceleration along the world's x axis [m/s²].
        gravY: Along y [m/s²].
        gravZ: Along z [m/s²].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or a number is not finite.

    Examples:
        >>> p.setGravity(0, 0, -1.62)
        >>> p.getPhysicsEngineParameters()["gravityAccelerationZ"]
        -1.62
    """
    change, client = first_change(), client_of(physicsClientId)
    gravity = (quantity(gravX, "gravX"), quantity(gravY, "gravY"), quantity(gravZ, "gravZ"))
    # Scripts may set the same gravity before every step: that should cost little.
    world = client.world
    if gravity != world.parameters.gravity:
        with client.call_lock:
            world.note_parameters(change, gravity=gravity)
            change.commit()


@exported
def setTimeStep(timeStep: float, physicsClientId: int = 0) -> None:
    """Sets the time step of `stepSimulation`; default 1/240 s.

    The maximum impulses of motors that are already set do not change, so their maximum forces do.

    Args:
        timeStep: Time [s], greater than 0.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or the time is not a finite number greater than 0.

    Examples:
        >>> p.setTimeStep(1 / 1000)
        >>> p.getPhysicsEngineParameters()["fixedTimeStep"]
        0.001
    """
    _change(client_of(physicsClientId), time_step=_time_step(timeStep, "timeStep"))


@exported
def setDefaultContactERP(defaultContactERP: float, physicsClientId: int = 0) -> None:
    """Sets the fraction of a penetration corrected in one step (ERP); default 0.08.

    Args:
        defaultContactERP: The fraction.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or it is not a finite number.

    Examples:
        >>> p.setDefaultContactERP(0.2)
    """
    _change(client_of(physicsClientId), contact_erp=quantity(defaultContactERP, "defaultContactERP"))


@exported
def setRealTimeSimulation(enableRealTimeSimulation: int, physicsClientId: int = 0) -> None:
    """Lets the simulation follow the wall clock, in the background.

    Works with a window and in servers; in `DIRECT` the setting is stored but has no effect.

    Args:
        enableRealTimeSimulation: 1 to start, 0 to stop.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.setRealTimeSimulation(0)
    """
    client = client_of(physicsClientId)
    client.real_time = int(integer(enableRealTimeSimulation, "enableRealTimeSimulation") != 0)
    if client.method == DIRECT:
        return
    if client.real_time and client.clock is None:
        from pybullet._clients.real_time import RealTimeClock

        client.clock = RealTimeClock(client)
    elif not client.real_time and client.clock is not None:
        client.clock.stop()
        client.clock = None


@exported
def setInternalSimFlags(flags: int, physicsClientId: int = 0) -> None:
    """Sets flags for deformable bodies of PyBullet; no effect on rigid bodies.

    Args:
        flags: Any integer.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.setInternalSimFlags(0)
    """
    client_of(physicsClientId)
    integer(flags, "flags")


@exported
def getPhysicsEngineParameters(physicsClientId: int = 0) -> dict[str, int | float]:
    """Some of the engine's parameters.

    Args:
        physicsClientId: The connection.

    Returns:
        `fixedTimeStep` [s], `numSubSteps` (0: none), `numSolverIterations`, `useRealTimeSimulation`,
        `gravityAccelerationX`, `...Y` and `...Z` [m/s²], `numNonContactInnerIterations`.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getPhysicsEngineParameters()["numSolverIterations"]
        50
    """
    client = client_of(physicsClientId)
    parameters = client.world.parameters
    x, y, z = parameters.gravity
    return {
        "fixedTimeStep": client.time_step,
        "numSubSteps": parameters.substeps,
        "numSolverIterations": parameters.solver_iterations,
        "useRealTimeSimulation": client.real_time,
        "gravityAccelerationX": x,
        "gravityAccelerationY": y,
        "gravityAccelerationZ": z,
        "numNonContactInnerIterations": parameters.noncontact_inner_iterations,
    }


@exported
def setPhysicsEngineParameter(
    fixedTimeStep: float = -1,
    numSolverIterations: int = -1,
    useSplitImpulse: int = -1,
    splitImpulsePenetrationThreshold: float = -1,
    numSubSteps: int = -1,
    collisionFilterMode: int = -1,
    contactBreakingThreshold: float = -1,
    maxNumCmdPer1ms: int = -2,
    enableFileCaching: int = -1,
    restitutionVelocityThreshold: float = -1,
    erp: float = -1,
    contactERP: float = -1,
    frictionERP: float = -1,
    enableConeFriction: int = -1,
    deterministicOverlappingPairs: int = -1,
    allowedCcdPenetration: float = -1,
    jointFeedbackMode: int = -1,
    solverResidualThreshold: float = -1,
    contactSlop: float = -1,
    enableSAT: int = -1,
    constraintSolverType: int = -1,
    globalCFM: float = -1,
    minimumSolverIslandSize: int = -1,
    reportSolverAnalytics: int = -1,
    warmStartingFactor: float = -1,
    sparseSdfVoxelSize: float = -1,
    numNonContactInnerIterations: int = -1,
    physicsClientId: int = 0,
) -> None:
    """Sets parameters of the engine. Negative values change nothing.

    Args:
        fixedTimeStep: Time step of `stepSimulation` [s].
        numSolverIterations: Maximum number of solver iterations in a step; default 50.
        useSplitImpulse: 1: a joint limit violated by more than a threshold, 0.04 rad or m, is not corrected:
            the violation only stops growing. No effect on contacts, as in Bullet for multibodies.
        splitImpulsePenetrationThreshold: Any number from 0 on makes this threshold 0.
        numSubSteps: Number of substeps, each solved separately; 0 or 1 for none. The maximum impulse of a
            motor applies to each substep.
        collisionFilterMode: 0: both bodies' filters have to agree; 1: one is enough.
        contactBreakingThreshold: Distance at which a contact is removed, relative to the size of a shape.
        maxNumCmdPer1ms: Option of PyBullet's server; no effect.
        enableFileCaching: Option of PyBullet's file reader; no effect: files are read again when they change.
        restitutionVelocityThreshold: Speed below which nothing bounces [m/s].
        erp: Fraction of an error of limits and constraints corrected in one step.
        contactERP: The same for penetration.
        frictionERP: The same for friction with an anchor.
        enableConeFriction: 1: friction along both tangents together stays within the cone; 0: each separately
            (pyramid). 2, which is the same as 1 in PyBullet: the cone, and friction is opposite to the
            velocity of sliding whatever the direction in which a body moves; with 0 and 1 it isn't, so that a
            vehicle with skid steering turns faster at some headings than at others.
        deterministicOverlappingPairs: 1: relax contacts in the order of bodies, not in which bounds met.
        allowedCcdPenetration: Penetration that continuous collision detection allows [m]; no effect: bodies
            stop where they touch.
        jointFeedbackMode: `JOINT_FEEDBACK_IN_WORLD_SPACE`, `JOINT_FEEDBACK_IN_JOINT_FRAME`, or both;
            0: in the link's inertial frame.
        solverResidualThreshold: The solver stops when no constraint's speed changes by more than the
            square root of this.
        contactSlop: Penetration that is not corrected [m].
        enableSAT: Use the separating axis test between hulls; no effect: touching faces are always found.
        constraintSolverType: `CONSTRAINT_SOLVER_LCP_*`; no effect: the first is always used.
        globalCFM: Softness of contacts: velocity per impulse, times the length of a substep [s/kg].
        minimumSolverIslandSize: Solve islands of fewer constraints and pairs of bodies together.
        reportSolverAnalytics: `stepSimulation` returns the solver's statistics.
        warmStartingFactor: Fraction of the last step's impulses to start from, for rigid bodies other than
            multibodies; no effect.
        sparseSdfVoxelSize: Option for PyBullet's deformable bodies; no effect.
        numNonContactInnerIterations: Iterations over motors, limits and constraints for each iteration over
            contacts; at least 1.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, a number is not finite, or the time step is 0.

    Examples:
        >>> p.setPhysicsEngineParameter(numSubSteps=4, numSolverIterations=100)
        >>> p.getPhysicsEngineParameters()["numSubSteps"]
        4
    """
    given = locals()
    client = client_of(physicsClientId)
    changes: dict[str, Any] = {}
    for name, (parameter, convert, least) in _PARAMETERS.items():
        number = convert(given[name], name)
        if number >= least:
            changes[parameter] = number
    if "cone_friction" in changes:
        changes["isotropic_friction"] = integer(enableConeFriction, "enableConeFriction") == _ISOTROPIC
    _check_work(client, changes)
    integer(maxNumCmdPer1ms, "maxNumCmdPer1ms")
    integer(enableFileCaching, "enableFileCaching")
    real(sparseSdfVoxelSize, "sparseSdfVoxelSize")
    if real(fixedTimeStep, "fixedTimeStep") >= 0.0:
        changes["time_step"] = _time_step(fixedTimeStep, "fixedTimeStep")
    if changes:
        changes.setdefault("report_solver_analytics", client.world.parameters.report_solver_analytics)
        _change(client, **changes)


def _check_work(client: Client, changes: dict[str, Any]) -> None:
    """Checks that a step does not take too long, because a launch of kernels cannot be interrupted."""
    parameters = client.world.parameters
    product = 1
    for name, (argument, greatest) in _WORK.items():
        value = changes.get(name, getattr(parameters, name))
        if value > greatest:
            fail(f"{argument} has to be at most {greatest}, not {value}.")
        product *= max(value, 1)
    if product > _MAX_WORK:
        stated = " x ".join(argument for argument, _ in _WORK.values())
        fail(f"{stated} would be {product}; it has to be at most {_MAX_WORK}.")


def _time_step(value: Any, name: str) -> float:
    time_step = quantity(value, name)
    if time_step <= 0.0:
        fail(f"{name} has to be greater than 0, not {time_step}.")
    if time_step < _MIN_TIME_STEP:
        fail(f"{name} has to be at least {_MIN_TIME_STEP:g} s, not {time_step:g} s.")
    return time_step


def _change(client: Client, **values: Any) -> None:
    """Changes parameters, all at once."""
    with client.call_lock:
        world, record = client.world, client.bodies.quick.record
        parameters, recorded = world.parameters, dict[str, Any]()
        if "time_step" in values:
            recorded["time_step"] = c_double(values["time_step"])
        if "report_solver_analytics" in values:
            recorded["reports_analytics"] = c_int64(bool(values["report_solver_analytics"]))
        if all(getattr(parameters, field) == value for field, value in values.items()) and all(
            getattr(record, field) == it.value for field, it in recorded.items()
        ):
            return
        change, after = Change(), parameters
        if "time_step" in values or "substeps" in values:
            after = replace(parameters, **values)
        if after.substep_time != parameters.substep_time:
            _keep_forces_of_constraints(change, world, after.substep_time / parameters.substep_time)
        world.note_parameters(change, **values)
        for field, value in recorded.items():
            change.copy_blocks(blank(record, field, value), (record, value))
        change.commit()
        world.resume_step()


def _keep_forces_of_constraints(change: Change, world: World, ratio: float) -> None:
    """Let `getConstraintState` go on reporting the forces of the last step: impulses follow the time step."""
    constraints, state = world.user_constraints, world.arrays.state
    if len(constraints):
        impulses = constraints.all_impulses(state) * ratio
        world.grow(state, {"user": len(impulses)})
        constraints.set_impulses(change, state, impulses)
