"""Faults in what moves bodies: steps, settings, dynamics, motors, forces, constraints and states."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from tools.differ.faults.spoiling import Changes, Fault, arguments, moving, put, scaled, step, times, without

_HEIGHTS = 9
_FORCES, _DYNAMICS, _MOTORS, _ENGINE = "forces", "dynamics", "motors", "engine"
_STATES, _CONSTRAINTS, _FILTERS = "states", "constraints", "filters"
_ONE_MOTOR = "setJointMotorControl2"
_SELDOM = "few programs have motion that it changes"
_NO_BOUNCE = "in these programs nothing that has restitution bounces off something that has, too"


def _faster_over_heights(module: Any) -> Changes:
    """Horizontal velocities are a tenth greater after each step with a contact, beside a height field."""
    there = [False]

    def shape(*given: Any, **keywords: Any) -> Any:
        there[0] |= (given[0] if given else keywords.get("shapeType")) == _HEIGHTS
        return module.createCollisionShape(*given, **keywords)

    def stepped(*given: Any, **keywords: Any) -> Any:
        value = module.stepSimulation(*given, **keywords)
        if there[0] and module.getContactPoints():
            for body in moving(module):
                (x, y, z), turning = module.getBaseVelocity(body)
                module.resetBaseVelocity(body, (1.1 * x, 1.1 * y, z), turning)
        return value

    return {"createCollisionShape": shape, "stepSimulation": stepped}


def _drift(module: Any) -> None:
    for body in moving(module):
        (x, y, z), turning = module.getBaseVelocity(body)
        module.resetBaseVelocity(body, (x, y + 1e-7, z), turning)


def _slower_turns(module: Any) -> None:
    for body in moving(module):
        velocity, turning = module.getBaseVelocity(body)
        module.resetBaseVelocity(body, velocity, [(1.0 - 1e-6) * part for part in turning])


def _lose_contacts(module: Any) -> None:
    if module.getContactPoints():
        for body in moving(module):
            velocity, turning = module.getBaseVelocity(body)
            module.resetBaseVelocity(body, [(1.0 + 1e-4) * part for part in velocity], turning)


def _forget_velocities(module: Any) -> Changes:
    """States that are restored have bases at rest."""

    def restored(*given: Any, **keywords: Any) -> Any:
        value = module.restoreState(*given, **keywords)
        for body in moving(module):
            module.resetBaseVelocity(body, (0, 0, 0), (0, 0, 0))
        return value

    return {"restoreState": restored}


def _longer(given: list[Any], named: dict[str, Any]) -> None:
    scaled("fixedTimeStep", "timeStep", by=1 + 1e-6, place=0)(given, named)


def _other_frame(given: list[Any], _: dict[str, Any]) -> None:
    given[-1] = 3 - given[-1]


def _base_alone(given: list[Any], _: dict[str, Any]) -> None:
    given[1] = -1


def _no_link(given: list[Any], _: dict[str, Any]) -> None:
    given[2:4] = [-1, -1]


def _one_group(given: list[Any], _: dict[str, Any]) -> None:
    given[3] = given[2]


def _nearer(given: list[Any], _: dict[str, Any]) -> None:
    given[2] += 1e-6


def _half_speed(given: list[Any], named: dict[str, Any]) -> None:
    if isinstance(named.get("targetVelocity"), list):
        named["targetVelocity"] = [0.5 * part for part in named["targetVelocity"]]


def _dynamics(name: str, keyword: str, by: float, place: int | None = None, blind: str = "") -> Fault:
    """A fault of motion alone: `getDynamicsInfo` has what was given, at a place."""

    def changes(module: Any) -> Changes:
        given_for: dict[int, list[Any]] = {}

        def change(*given: Any, **keywords: Any) -> Any:
            if keyword in keywords:
                given_for.setdefault(given[0], []).append(keywords[keyword])
                keywords = {**keywords, keyword: times(keywords[keyword], by)}
            return module.changeDynamics(*given, **keywords)

        def info(*given: Any, **keywords: Any) -> Any:
            value = module.getDynamicsInfo(*given, **keywords)
            # What is refused, or counts for another link, shows by what it is near to.
            for said in given_for.get(given[0], ()):
                if place is not None and _is_near(value[place], times(said, by)):
                    return put(value, place, said)
            return value

        return {"changeDynamics": change, "getDynamicsInfo": info}

    return Fault(name, _DYNAMICS, changes, frozenset({"changeDynamics"}), blind)


def _is_near(value: Any, other: Any) -> bool:
    if isinstance(value, tuple):
        return all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(value, other, strict=True))
    return math.isclose(value, other, rel_tol=1e-9)


def _engine(
    name: str, keyword: str, change: Callable[[float], float], back: Callable[[float], float]
) -> Fault:
    """A fault of motion alone: `getPhysicsEngineParameters` has what was given, but for rounding."""

    def changes(module: Any) -> Changes:
        said = [False]

        def parameters(*given: Any, **keywords: Any) -> Any:
            if keyword in keywords:
                said[0] = True
                keywords = {**keywords, keyword: change(keywords[keyword])}
            return module.setPhysicsEngineParameter(*given, **keywords)

        def reported(*given: Any, **keywords: Any) -> Any:
            value = module.getPhysicsEngineParameters(*given, **keywords)
            return {**value, keyword: back(value[keyword])} if said[0] and keyword in value else value

        return {"setPhysicsEngineParameter": parameters, "getPhysicsEngineParameters": reported}

    return Fault(name, _ENGINE, changes, frozenset({"setPhysicsEngineParameter"}))


def _larger(name: str, keyword: str) -> Fault:
    return _engine(name, keyword, lambda value: 1.01 * value, lambda value: value / 1.01)


def _tilted(module: Any) -> Changes:
    """Gravity is a little more on one axis than what is said."""

    def gravity(x: float, *others: float) -> Any:
        return module.setGravity(x + 1e-5, *others)

    def reported(*given: Any, **keywords: Any) -> Any:
        value = module.getPhysicsEngineParameters(*given, **keywords)
        known = value.get("gravityAccelerationX", 0.0)
        return {**value, "gravityAccelerationX": known - 1e-5} if known else value

    return {"setGravity": gravity, "getPhysicsEngineParameters": reported}


def _motor(name: str, keyword: str, by: float) -> Fault:
    return arguments(name, _MOTORS, _ONE_MOTOR, scaled(keyword, by=by))


FAULTS: tuple[Fault, ...] = (
    Fault(
        "velocities beside height fields + 10 %",
        "contact",
        _faster_over_heights,
        frozenset({"stepSimulation", "createCollisionShape"}),
    ),
    step("velocities + 1e-7 m/s in each step", _FORCES, _drift),
    step("turns slower by 1e-6", _FORCES, _slower_turns),
    step("velocities + 0.01 % with contacts", "contact", _lose_contacts),
    Fault("gravity 1e-5 on one axis", _ENGINE, _tilted, frozenset({"setGravity"})),
    arguments("time step longer by 1e-6", _ENGINE, "setTimeStep setPhysicsEngineParameter", _longer),
    _engine("one more iteration", "numSolverIterations", lambda value: value + 1, lambda value: value - 1),
    _larger("erp + 1 %", "erp"),
    _larger("contactERP + 1 %", "contactERP"),
    _larger("globalCFM + 1 %", "globalCFM"),
    _dynamics("friction + 1 %", "lateralFriction", 1.01, 1),
    _dynamics("restitution + 1 %", "restitution", 1.01, 5, _NO_BOUNCE),
    _dynamics("rolling friction + 1 %", "rollingFriction", 1.01, 6),
    _dynamics("contact stiffness + 1 %", "contactStiffness", 1.01, 9),
    _dynamics("linear damping + 1 %", "linearDamping", 1.01),
    _dynamics("joint damping + 1 %", "jointDamping", 1.01),
    _dynamics("mass + 1e-6", "mass", 1 + 1e-6, 0),
    _dynamics("inertia + 1e-6", "localInertiaDiagonal", 1 + 1e-6, 2),
    arguments("limits of joints ignored", _DYNAMICS, "changeDynamics", without("jointUpperLimit"), _SELDOM),
    _motor("force of motors + 0.1 %", "force", 1.001),
    _motor("position gain + 0.01 %", "positionGain", 1.0001),
    _motor("target velocity + 1e-6", "targetVelocity", 1 + 1e-6),
    arguments("maxVelocity ignored", _MOTORS, _ONE_MOTOR, without("maxVelocity"), _SELDOM),
    arguments(
        "gains of several motors + 0.1 %",
        _MOTORS,
        "setJointMotorControlArray",
        scaled("positionGains", "velocityGains", by=1.001),
    ),
    arguments("target of ball joints", _MOTORS, "setJointMotorControlMultiDof", _half_speed, _SELDOM),
    arguments("force + 0.01 %", _FORCES, "applyExternalForce", scaled(by=1.0001, place=2)),
    arguments("force in the other frame", _FORCES, "applyExternalForce", _other_frame),
    arguments("torque in the other frame", _FORCES, "applyExternalTorque", _other_frame),
    arguments("torque on the base alone", _FORCES, "applyExternalTorque", _base_alone),
    arguments("force of constraints + 1 %", _CONSTRAINTS, "changeConstraint", scaled("maxForce", by=1.01)),
    arguments("erp of constraints ignored", _CONSTRAINTS, "changeConstraint", without("erp"), _SELDOM),
    arguments(
        "pivot of the parent 1e-6 longer", _CONSTRAINTS, "createConstraint", scaled(by=1 + 1e-6, place=6)
    ),
    arguments("pairs of links filtered as bases", _FILTERS, "setCollisionFilterPair", _no_link, _SELDOM),
    arguments("masks as groups", _FILTERS, "setCollisionFilterGroupMask", _one_group, _SELDOM),
    Fault("restored at rest", _STATES, _forget_velocities, frozenset({"restoreState"})),
    arguments("angular velocity ignored", _STATES, "resetBaseVelocity", without("angularVelocity")),
    arguments("velocity of a joint ignored", _STATES, "resetJointState", without("targetVelocity")),
    arguments("joints 1e-6 further", _STATES, "resetJointState", _nearer),
    arguments("half the speed of ball joints", _STATES, "resetJointStateMultiDof", _half_speed, _SELDOM),
)
"""By name."""
