"""Constraints that scripts put between links, or between a link and the world."""

from __future__ import annotations

from typing import Any

from ..scenario import (
    base_motion,
    joint_motion,
    load,
    movable_joints,
    release_motors,
    scenario,
    simulate,
    under,
)


def _free_tree(p: Any, position: list[float]) -> int:
    body = load(
        p, "tree.urdf", basePosition=position, baseOrientation=p.getQuaternionFromEuler([0.2, 0.1, 0.3])
    )
    return body


def _observe(p: Any, bodies: dict[str, int], constraint: int | None = None) -> dict[str, Any]:
    observed: dict[str, Any] = {}
    for name, body in bodies.items():
        observed |= under(name, base_motion(p, body))
        observed |= under(name, joint_motion(p, body, movable_joints(p, body)))
    if constraint is not None:
        observed["force"] = p.getConstraintState(constraint)
    return observed


@scenario()
def pendulum_on_point_to_point(p: Any) -> dict[str, Any]:
    """A free body hangs from a point of the world and swings."""
    p.setGravity(0, 0, -9.81)
    body = _free_tree(p, [0, 0, 5])
    constraint = p.createConstraint(
        body, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0.1, 0.2, 0.4], [0.3, 0.2, 5.2]
    )
    return simulate(p, 2.0, lambda: _observe(p, {"tree": body}, constraint), stride=8)


@scenario()
def two_bodies_fixed_together(p: Any) -> dict[str, Any]:
    """A link of one free body and the base of another keep their frames together as they fall."""
    p.setGravity(0, 0, -9.81)
    first, second = _free_tree(p, [0, 0, 5]), _free_tree(p, [1, 0, 5])
    constraint = p.createConstraint(
        first,
        1,
        second,
        -1,
        p.JOINT_FIXED,
        [0, 0, 0],
        [0.3, 0.0, 0.1],
        [-0.4, 0.1, 0.0],
        p.getQuaternionFromEuler([0.1, 0.2, 0.3]),
        p.getQuaternionFromEuler([0.0, 0.1, -0.2]),
    )
    return simulate(p, 2.0, lambda: _observe(p, {"first": first, "second": second}, constraint), stride=8)


@scenario()
def body_sliding_on_a_rail(p: Any) -> dict[str, Any]:
    """A prismatic constraint lets a free body slide along an axis only."""
    p.setGravity(1.0, 0.5, -9.81)
    body = load(p, "tree.urdf", basePosition=[0, 0, 5])
    constraint = p.createConstraint(
        body,
        -1,
        -1,
        -1,
        p.JOINT_PRISMATIC,
        [1, 0, 0],
        [0, 0, 0],
        list(p.getBasePositionAndOrientation(body)[0]),
    )
    return simulate(p, 2.0, lambda: _observe(p, {"tree": body}, constraint), stride=8)


@scenario()
def joints_geared_together(p: Any) -> dict[str, Any]:
    """Two joints of an arm turn against each other, with and without a position to hold."""
    p.setGravity(0, 0, -9.81)
    arm = load(p, "seven_dof.urdf", useFixedBase=True)
    joints = movable_joints(p, arm)
    release_motors(p, arm)
    gear = p.createConstraint(arm, joints[1], arm, joints[3], p.JOINT_GEAR, [0, 1, 0], [0, 0, 0], [0, 0, 0])
    p.changeConstraint(gear, gearRatio=-0.5, maxForce=10000)
    free = simulate(p, 1.0, lambda: _observe(p, {"arm": arm}, gear), stride=8)
    p.changeConstraint(gear, relativePositionTarget=0.3, erp=0.5)
    held = simulate(p, 1.0, lambda: _observe(p, {"arm": arm}, gear), stride=8)
    return under("free", free) | under("held", held)


@scenario()
def body_dragged_by_its_constraint(p: Any) -> dict[str, Any]:
    """The world's end of a fixed constraint moves on, with a bounded force; then the constraint goes."""
    p.setGravity(0, 0, -9.81)
    body = _free_tree(p, [0, 0, 5])
    position = p.getBasePositionAndOrientation(body)[0]
    constraint = p.createConstraint(body, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], list(position))
    p.changeConstraint(constraint, maxForce=150)
    state = {"time": 0.0}

    def drag() -> dict[str, Any]:
        state["time"] += 1.0 / 240.0
        pivot = [position[0] + 0.5 * state["time"], position[1], position[2]]
        turn = p.getQuaternionFromEuler([0, 0, state["time"]])
        p.changeConstraint(constraint, jointChildPivot=pivot, jointChildFrameOrientation=turn)
        return _observe(p, {"tree": body}, constraint)

    dragged = simulate(p, 1.5, drag, stride=1)
    info = p.getConstraintInfo(constraint)
    p.removeConstraint(constraint)
    released = simulate(p, 0.5, lambda: _observe(p, {"tree": body}), stride=8)
    thinned = {name: series[::8] for name, series in dragged.items()}
    return under("dragged", thinned) | under("released", released) | {"axis and pivots": [*info[5], *info[6]]}


@scenario()
def body_tied_to_what_cannot_move(p: Any) -> dict[str, Any]:
    """A link of a free body is tied to the base of an arm, which is fixed: the arm has no part in it."""
    body = _free_tree(p, [0.5, 0.2, 3])
    arm = load(p, "seven_dof.urdf", useFixedBase=True)
    constraint = p.createConstraint(
        arm, -1, body, 1, p.JOINT_POINT2POINT, [0, 0, 0], [0.4, -0.9, 0.4], [0.5, 0.3, 0.2]
    )
    return simulate(p, 0.25, lambda: _observe(p, {"tree": body, "arm": arm}, constraint), stride=2)


@scenario()
def constraint_that_moves_nothing(p: Any) -> dict[str, Any]:
    """A fixed body is tied to the world, beside an arm that is tied to a free one: only the order changes."""
    arm = load(p, "seven_dof.urdf", useFixedBase=True)
    body = _free_tree(p, [0.5, 0.2, 3])
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    wall = p.createMultiBody(0, box, -1, [20, 0, 0])
    p.createConstraint(wall, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0.1, 0, 0], [20.5, 0, 0])
    constraint = p.createConstraint(
        arm, 3, body, 1, p.JOINT_POINT2POINT, [0, 0, 0], [0.4, -0.9, 0.4], [0.5, 0.3, 0.2]
    )
    return simulate(p, 0.1, lambda: _observe(p, {"tree": body, "arm": arm}, constraint), stride=1)
