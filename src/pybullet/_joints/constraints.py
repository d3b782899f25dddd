"""Constraints between two links, or a link and the world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.description.pose import IDENTITY, Pose
from carom.layouts.codes import UserConstraintKind
from pybullet._calls.arguments import Vector, integer, real
from pybullet._calls.builtin import exported
from pybullet._calls.constants import JOINT_GEAR, JOINT_POINT2POINT
from pybullet._calls.errors import fail, logger, no_body
from pybullet._calls.optional_vectors import optional_rotation, optional_vector3
from pybullet._calls.quick import first_change
from pybullet._clients.clients import Client, client_of
from pybullet._clients.lookup import link_of
from pybullet._maths.rotations import unit

if TYPE_CHECKING:
    from carom.model.soft_spec import Anchor
    from carom.scene.body import Body
    from carom.scene.user_constraints import UserConstraint

__all__ = [
    "changeConstraint",
    "createConstraint",
    "getConstraintInfo",
    "getConstraintState",
    "getConstraintUniqueId",
    "getNumConstraints",
    "removeConstraint",
]

_WORLD = -1
# Those that PyBullet has.
_KINDS = {int(kind): kind for kind in UserConstraintKind if kind <= UserConstraintKind.GEAR}
_FAILED = "createConstraint failed."
_PARENT_FRAME = "parentFramePosition", "parentFrameOrientation"
_CHILD_FRAME = "childFramePosition", "childFrameOrientation"
_CHANGE_FAILED = "changeConstraint failed."
_UNCHANGED_TARGET = 1e32

Numbers = tuple[float, ...]
ConstraintInfo = tuple[
    int, int, int, int, int, Numbers, Numbers, Numbers, Numbers, Numbers, float, float, int, float, float
]


@exported
def createConstraint(
    parentBodyUniqueId: int,
    parentLinkIndex: int,
    childBodyUniqueId: int,
    childLinkIndex: int,
    jointType: int,
    jointAxis: Vector,
    parentFramePosition: Vector,
    childFramePosition: Vector,
    parentFrameOrientation: Vector | None = None,
    childFrameOrientation: Vector | None = None,
    physicsClientId: int = 0,
) -> int:
    """Creates a constraint between two links, or a link and the world.

    Args:
        parentBodyUniqueId: The first body.
        parentLinkIndex: Its link; -1 for the base.
        childBodyUniqueId: The second body; -1 for the world.
        childLinkIndex: Its link; -1 for the base.
        jointType: `JOINT_POINT2POINT`: two points stay together. `JOINT_FIXED`: two frames stay together.
            `JOINT_PRISMATIC`: two frames stay together, but may slide along `jointAxis`. `JOINT_GEAR`: the
            velocity of the parent's joint is minus the gear ratio times that of the child's.
        jointAxis: Axis in the inertial frame of the parent's link; only a prismatic constraint uses it.
        parentFramePosition: Pivot in the inertial frame of the parent's link [m].
        childFramePosition: Pivot in the inertial frame of the child's link, or in the world [m].
        parentFrameOrientation: Orientation of the constraint frame there, a quaternion; by default that of
            the inertial frame.
        childFrameOrientation: The same of the child.
        physicsClientId: The connection.

    Returns:
        The number of the constraint; the first is 1.

    Raises:
        pybullet.error: Not connected, there is no such body, link or type, or a vector has the wrong length
            or is not finite.

    Examples:
        >>> tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
        >>> for _ in range(240):
        ...     _ = p.stepSimulation()
        >>> round(p.getBasePositionAndOrientation(cube)[0][2], 2)
        1.0
    """
    change, client = first_change(), client_of(physicsClientId)
    parent = _body(client, parentBodyUniqueId, "parentBodyUniqueId")
    parent_link = link_of(parent, parentLinkIndex, "parentLinkIndex", _FAILED)
    child, child_link = None, integer(childLinkIndex, "childLinkIndex")
    if integer(childBodyUniqueId, "childBodyUniqueId") >= 0:
        child = _body(client, childBodyUniqueId, "childBodyUniqueId")
        child_link = link_of(child, childLinkIndex, "childLinkIndex", _FAILED)
    kind = _KINDS.get(integer(jointType, "jointType"))
    if kind is None:
        fail(_FAILED, f"jointType is {jointType}; expected JOINT_POINT2POINT, _FIXED, _PRISMATIC or _GEAR.")
    if kind == JOINT_GEAR:
        _check_gear(parent, parent_link, child, child_link)

    parent_frame = _frame(parentFramePosition, parentFrameOrientation, *_PARENT_FRAME)
    child_frame = _frame(childFramePosition, childFrameOrientation, *_CHILD_FRAME)
    axis = optional_vector3(jointAxis, _FAILED, "jointAxis") or IDENTITY.position
    world, ends = client.world, (parent, parent_link, child, child_link)
    with client.call_lock:
        constraint = world.user_constraints.new(kind, *ends, axis, parent_frame, child_frame)
        world.note_constraint(change, constraint)
        change.commit()
    return constraint.id


@exported
def changeConstraint(
    userConstraintUniqueId: int,
    jointChildPivot: Vector | None = None,
    jointChildFrameOrientation: Vector | None = None,
    maxForce: float = -1,
    gearRatio: float = 0,
    gearAuxLink: int = -1,
    relativePositionTarget: float = _UNCHANGED_TARGET,
    erp: float = -1,
    physicsClientId: int = 0,
) -> None:
    """Changes a constraint, for example to drag a body. An unknown number is no error.

    Args:
        userConstraintUniqueId: The constraint.
        jointChildPivot: New pivot of the child, in the world if there is no child [m].
        jointChildFrameOrientation: New orientation of the child's frame, a quaternion.
        maxForce: Maximum force of each row [N or N m]; negative: no change.
        gearRatio: Of a gear; default 1; 0: no change.
        gearAuxLink: Link of the parent whose joint's motion is subtracted from the gear's; negative: no
            change.
        relativePositionTarget: Target of the sum of a gear's joint positions.
        erp: Share of a gear's position error corrected per step; negative: no change.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or an argument has the wrong length or is not finite.

    Examples:
        >>> tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
        >>> p.changeConstraint(tie, jointChildPivot=[0.5, 0, 2], maxForce=50)
        >>> p.getConstraintInfo(tie)[10]
        50.0
    """
    change, client = first_change(), client_of(physicsClientId)
    constraint = client.world.user_constraints.get(integer(userConstraintUniqueId, "userConstraintUniqueId"))
    force, ratio = real(maxForce, "maxForce"), real(gearRatio, "gearRatio")
    auxiliary, share = integer(gearAuxLink, "gearAuxLink"), real(erp, "erp")
    target = real(relativePositionTarget, "relativePositionTarget")
    pivot = optional_vector3(jointChildPivot, _CHANGE_FAILED, "jointChildPivot")
    orientation = optional_rotation(jointChildFrameOrientation, _CHANGE_FAILED, "jointChildFrameOrientation")
    if constraint is None:
        logger.warning("changeConstraint: there is no constraint %s.", userConstraintUniqueId)
        return
    with client.call_lock:
        values: dict[str, Any] = {}
        if auxiliary >= 0:
            values["gear_auxiliary_link"] = link_of(
                constraint.parent, auxiliary, "gearAuxLink", _CHANGE_FAILED
            )
        if pivot is not None or orientation is not None:
            old = constraint.child_frame
            values["child_frame"] = Pose(
                pivot or old.position, old.orientation if orientation is None else unit(orientation)
            )
        if force >= 0.0:
            values["max_force"] = force
            values["max_impulse"] = force * client.world.parameters.substep_time
        if ratio != 0.0:
            values["gear_ratio"] = ratio
        if target < _UNCHANGED_TARGET:
            values["relative_position_target"] = target
        if share >= 0.0:
            values["erp"] = share
        client.world.change_constraint(constraint, values, change)


@exported
def removeConstraint(userConstraintUniqueId: int, physicsClientId: int = 0) -> None:
    """Removes a constraint; an unknown number is no error.

    Args:
        userConstraintUniqueId: The constraint.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
        >>> p.removeConstraint(tie)
        >>> p.getNumConstraints()
        0
    """
    change, client = first_change(), client_of(physicsClientId)
    number = integer(userConstraintUniqueId, "userConstraintUniqueId")
    constraint = client.world.user_constraints.get(number)
    if number in client.world.contact_arrays.soft.anchors:
        from carom.scene.core.soft_core import remove_anchor

        with client.call_lock:
            remove_anchor(client.world, number)
        return
    if constraint is None:
        logger.warning("removeConstraint: there is no constraint %s.", number)
        return
    with client.call_lock:
        client.world.note_no_constraint(change, constraint)
        change.commit()


@exported
def getNumConstraints(physicsClientId: int = 0) -> int:
    """The number of constraints, anchors of soft bodies included.

    Args:
        physicsClientId: The connection.

    Returns:
        Their number.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getNumConstraints()
        0
    """
    return len(_numbers(client_of(physicsClientId)))


@exported
def getConstraintUniqueId(serialIndex: int, physicsClientId: int = 0) -> int:
    """The number of a constraint by its position in the list of constraints.

    Args:
        serialIndex: From 0 to `getNumConstraints()` - 1.
        physicsClientId: The connection.

    Returns:
        Its number; -1 if there are fewer.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
        >>> p.getConstraintUniqueId(0) == tie
        True
    """
    numbers = _numbers(client_of(physicsClientId))
    index = integer(serialIndex, "serialIndex")
    return numbers[index] if 0 <= index < len(numbers) else -1


@exported
def getConstraintInfo(constraintUniqueId: int, physicsClientId: int = 0) -> ConstraintInfo:
    """The parameters of a constraint.

    Args:
        constraintUniqueId: The constraint.
        physicsClientId: The connection.

    Returns:
        (parentBodyUniqueId, parentLinkIndex, childBodyUniqueId, childLinkIndex, jointType, jointAxis,
        parentFramePosition, childFramePosition, parentFrameOrientation, childFrameOrientation, maxForce,
        gearRatio, gearAuxLink, relativePositionTarget, erp); the child is -1 for the world, and gearAuxLink
        is also 0 if there is none. An anchor of a soft body is reported as a point-to-point constraint
        whose parent is the soft body and whose parentLinkIndex is the node.

    Raises:
        pybullet.error: Not connected, or there is no such constraint.

    Examples:
        >>> tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
        >>> info = p.getConstraintInfo(tie)
        >>> info[0] == cube, info[4] == p.JOINT_FIXED, info[7]
        (True, True, (0.5, 0.0, 1.0))
    """
    anchor = client_of(physicsClientId).world.contact_arrays.soft.anchors.get(
        integer(constraintUniqueId, "constraintUniqueId")
    )
    if anchor is not None:
        return _anchor_info(client_of(physicsClientId), anchor)
    constraint = _constraint(constraintUniqueId, physicsClientId, "Couldn't get user constraint info")
    return (
        constraint.parent.id,
        constraint.parent_link,
        _WORLD if constraint.child is None else constraint.child.id,
        constraint.child_link,
        int(constraint.kind),
        constraint.axis,
        constraint.parent_frame.position,
        constraint.child_frame.position,
        constraint.parent_frame.orientation,
        constraint.child_frame.orientation,
        constraint.max_force,
        constraint.gear_ratio,
        max(constraint.gear_auxiliary_link, 0),
        constraint.relative_position_target,
        constraint.erp,
    )


@exported
def getConstraintState(constraintUniqueId: int, physicsClientId: int = 0) -> Numbers:
    """The forces of a constraint in the last step.

    Args:
        constraintUniqueId: The constraint.
        physicsClientId: The connection.

    Returns:
        A force [N] or torque [N m] for each of its rows.

    Raises:
        pybullet.error: Not connected, or there is no such constraint.

    Examples:
        >>> tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1])
        >>> _ = p.stepSimulation()
        >>> len(p.getConstraintState(tie))
        6
    """
    constraint = _constraint(constraintUniqueId, physicsClientId, "Couldn't getConstraintState.")
    world = client_of(physicsClientId).world
    impulses = world.user_constraints.impulses(constraint, world.arrays.state)
    # PyBullet's point-to-point rows have the opposite sign.
    sign = -1.0 if constraint.kind == JOINT_POINT2POINT else 1.0
    return tuple((sign * impulses / world.parameters.substep_time).tolist())


def _numbers(client: Client) -> list[int]:
    """The numbers of all constraints and anchors, in order of creation."""
    world = client.world
    return sorted(
        [constraint.id for constraint in world.user_constraints.all] + [*world.contact_arrays.soft.anchors]
    )


def _anchor_info(client: Client, anchor: Anchor) -> ConstraintInfo:
    numbers = {id(body.rows): body.id for body in client.world.bodies.values()}
    child = _WORLD if anchor.body is None else numbers[id(anchor.body)]
    none, no_turn = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    parent = numbers[id(anchor.soft.rows)]
    ends = (parent, anchor.node, child, anchor.link, JOINT_POINT2POINT)
    return (*ends, none, none, anchor.pivot, no_turn, no_turn, 0.0, 0.0, 0, 0.0, 0.0)


def _constraint(number: int, physics_client_id: int, problem: str) -> UserConstraint:
    client = client_of(physics_client_id)
    constraint = client.world.user_constraints.get(integer(number, "constraintUniqueId"))
    if constraint is None:
        fail(problem, f"There is no constraint {number}.")
    return constraint


def _body(client: Client, number: int, name: str) -> Body:
    body = client.world.bodies.get(integer(number, name))
    if body is None:
        fail(_FAILED, f"{name}: {no_body(number)}")
    return body


def _check_gear(parent: Body, parent_link: int, child: Body | None, child_link: int) -> None:
    """Check that both links of a gear have a joint with one degree of freedom."""
    for body, link, name in ((parent, parent_link, "parent"), (child, child_link, "child")):
        if body is None or link < 0 or body.velocity_count[link] != 1:
            fail(_FAILED, f"The {name} of a gear has to be a revolute or prismatic joint.")


def _frame(position: Vector, orientation: Vector | None, position_name: str, orientation_name: str) -> Pose:
    origin = optional_vector3(position, _FAILED, position_name) or IDENTITY.position
    if orientation is None:
        return Pose(origin) if any(origin) else IDENTITY
    turn = optional_rotation(orientation, _FAILED, orientation_name)
    return Pose(origin, IDENTITY.orientation if turn is None else unit(turn))
