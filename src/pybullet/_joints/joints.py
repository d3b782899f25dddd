"""Joints: their data from the file, and reading and setting their state."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from carom.native.change import Change
from pybullet._calls.arguments import (
    Indices,
    Vector,
    Vectors,
    check_rotation,
    indices,
    integer,
    quantities,
    quantity,
    sequence,
)
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import Client, client_of, clients
from pybullet._clients.lookup import (
    body_access,
    has_joint,
    joint_access,
    joint_of,
    no_joint,
    state_access,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.scene.body import Body
    from carom.scene.core.body_core import JointReset
    from pybullet._access.body_access import JointState, MultiDofState
    from pybullet._access.joint_info import JointInfo

_State = tuple[int, tuple[float, ...], tuple[float, ...]]

__all__ = [
    "getJointInfo",
    "getJointState",
    "getJointStateMultiDof",
    "getJointStates",
    "getJointStatesMultiDof",
    "resetJointState",
    "resetJointStateMultiDof",
    "resetJointStatesMultiDof",
]

NO_INDICES = "expected a sequence of joint indices"
_NO_STATE = "getJointState failed."
_NEGATIVE_BODY = "getJointState failed; invalid bodyUniqueId"
_QUATERNION = 4
_NO_LISTS = "Expected an position and/or velocity list."


@exported
def getJointInfo(bodyUniqueId: int, jointIndex: int, physicsClientId: int = 0) -> JointInfo:
    """Data of a joint and its child link from the robot's file.

    `changeDynamics` does not change these.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        physicsClientId: The connection.

    Returns:
        17 fields: 0 index; 1 name (bytes); 2 type (`JOINT_*`); 3 index of its first position, the base
        having the first seven, and 4 of its first velocity, the base having the first six (both -1 for
        a fixed joint); 5 flags, 1 for a joint that has a motor; 6 damping [N m s/rad or N s/m];
        7 friction, which is not simulated; 8 lower and 9 upper limit [rad or m], the lower greater than
        the upper when there are none; 10 maximum force and 11 maximum velocity, which are not
        enforced; 12 name of the link (bytes); 13 axis in the link's inertial frame; 14 position of the
        joint in the parent's inertial frame; 15 quaternion that turns vectors of the parent's inertial
        frame into the link's; 16 index of the parent link, -1 for the base.

    Raises:
        pybullet.error: Not connected, or there is no such body or joint.

    Examples:
        >>> info = p.getJointInfo(arm, 3)
        >>> info[1].decode(), info[2] == p.JOINT_REVOLUTE
        ('lbr_iiwa_joint_4', True)
        >>> lower, upper = info[8:10]
        >>> round(lower, 2), round(upper, 2)
        (-2.09, 2.09)
    """
    try:
        return clients[physicsClientId].bodies[bodyUniqueId].joint_infos[jointIndex]
    except (KeyError, TypeError, ValueError):
        problem = "GetJointInfo failed."
        access = body_access(bodyUniqueId, physicsClientId, problem)
        index = integer(jointIndex, "jointIndex")
        if index not in access.joint_infos:
            fail(problem, no_joint(access.body, index))
        return access.joint_infos[index]


@exported
def getJointState(bodyUniqueId: int, jointIndex: int, physicsClientId: int = 0) -> JointState:
    """Position, velocity, reaction force and motor torque of a joint.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        physicsClientId: The connection.

    Returns:
        (position [rad or m], velocity, (Fx, Fy, Fz, Mx, My, Mz) [N, N m], motor torque [N m or N]).
        The third is the force and torque of the joint on its link, about the link's centre of mass and in the
        axes of its inertial frame; zeros unless `enableJointForceTorqueSensor` was called. The fourth is that
        of the motor in the last step, and does not change when the motor is switched off. Zeros for a fixed
        joint; for a spherical one see `getJointStateMultiDof`.

    Raises:
        pybullet.error: Not connected, or there is no such body or joint.

    Examples:
        >>> position, velocity, reaction, torque = p.getJointState(arm, 3)
        >>> position, velocity
        (0.0, 0.0)
    """
    access, index = state_access(bodyUniqueId, jointIndex, physicsClientId)
    return access.joint_state(index)


@exported
def getJointStates(
    bodyUniqueId: int, jointIndices: Indices, physicsClientId: int = 0
) -> tuple[JointState, ...]:
    """The states of several joints of a body.

    Args:
        bodyUniqueId: The body.
        jointIndices: The joints, in any order.
        physicsClientId: The connection.

    Returns:
        The result of `getJointState` for each joint; None if there are no indices, not in types.

    Raises:
        pybullet.error: Not connected, or there is no such body or joint.

    Examples:
        >>> [state[0] for state in p.getJointStates(arm, range(7))]
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    """
    client_of(physicsClientId)
    if integer(bodyUniqueId, "bodyUniqueId") < 0:
        body_access(bodyUniqueId, physicsClientId, _NO_STATE, _NEGATIVE_BODY)
    requested = indices(jointIndices, NO_INDICES, "jointIndices")
    if not requested:
        return cast("tuple[JointState, ...]", None)
    access = body_access(bodyUniqueId, physicsClientId, _NO_STATE, _NEGATIVE_BODY)
    joints = [joint_of(access.body, index) for index in requested]
    return tuple([access.joint_state(joint) for joint in joints])


@exported
def getJointStateMultiDof(bodyUniqueId: int, jointIndex: int, physicsClientId: int = 0) -> MultiDofState:
    """The state of a joint with any number of degrees of freedom.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        physicsClientId: The connection.

    Returns:
        (positions, velocities, (Fx, Fy, Fz, Mx, My, Mz), motor torques) as in `getJointState`, each a
        tuple: empty for a fixed joint; of a spherical joint a quaternion (x, y, z, w), and the angular
        velocity in the axes of its link.

    Raises:
        pybullet.error: Not connected, or there is no such body or joint.

    Examples:
        >>> position, velocity, reaction, torque = p.getJointStateMultiDof(arm, 3)
        >>> position, velocity
        ((0.0,), (0.0,))
    """
    access, index = state_access(bodyUniqueId, jointIndex, physicsClientId)
    return access.multi_dof_state(index)


@exported
def getJointStatesMultiDof(
    bodyUniqueId: int, jointIndex: Indices, physicsClientId: int = 0
) -> tuple[MultiDofState, ...]:
    """The states of several joints with any number of degrees of freedom.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joints, in any order: a sequence, despite the name.
        physicsClientId: The connection.

    Returns:
        The result of `getJointStateMultiDof` for each joint; None if there are no indices, not in types.

    Raises:
        pybullet.error: Not connected, or there is no such body or joint.

    Examples:
        >>> [state[0] for state in p.getJointStatesMultiDof(arm, [0, 1])]
        [(0.0,), (0.0,)]
    """
    access = body_access(bodyUniqueId, physicsClientId, _NO_STATE, _NEGATIVE_BODY)
    requested = indices(jointIndex, NO_INDICES, "jointIndex")
    for index in requested:
        if not has_joint(access.body, index):
            fail("getJointState failed (2).", no_joint(access.body, index))
    if not requested:
        return cast("tuple[MultiDofState, ...]", None)
    return tuple([access.multi_dof_state(index) for index in requested])


@exported
def resetJointState(
    bodyUniqueId: int,
    jointIndex: int,
    targetValue: float,
    targetVelocity: float = 0,
    physicsClientId: int = 0,
) -> None:
    """Sets the state of a joint, without physics. Its motor does not change.

    Fixed, spherical and planar joints do not move.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        targetValue: Position [rad or m].
        targetVelocity: Velocity [rad/s or m/s].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such body or joint, or a number is not finite.

    Examples:
        >>> p.resetJointState(arm, 3, 0.5, targetVelocity=0.1)
        >>> p.getJointState(arm, 3)[:2]
        (0.5, 0.1)
    """
    access, index = joint_access(bodyUniqueId, jointIndex, physicsClientId)
    position = quantity(targetValue, "targetValue")
    access.reset_joint(index, position, quantity(targetVelocity, "targetVelocity"))


@exported
def resetJointStateMultiDof(
    bodyUniqueId: int,
    jointIndex: int,
    targetValue: Vector,
    targetVelocity: Vector | None = None,
    physicsClientId: int = 0,
) -> None:
    """Sets the state of a joint with any number of degrees of freedom, without physics.

    A list of a length that does not fit the joint is ignored, and so is a velocity without a position.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        targetValue: Positions: one number, or for a spherical joint a quaternion (x, y, z, w).
        targetVelocity: Velocities: one number, or three for a spherical joint; 0 by default.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such body or joint, both lists are empty, or they hold
            something that is not a finite number.

    Examples:
        >>> p.resetJointStateMultiDof(arm, 3, [0.5], [0.1])
        >>> p.getJointState(arm, 3)[:2]
        (0.5, 0.1)
    """
    client = client_of(physicsClientId)
    position, velocity = _targets(targetValue, targetVelocity)
    access, index = joint_access(bodyUniqueId, jointIndex, physicsClientId)
    if len(position) == _QUATERNION:
        _check_turn(access.body, index, position)
    body = access.body
    if len(position) == 1 == body.position_count[index]:
        access.reset_joint(index, position[0], velocity[0] if len(velocity) == 1 else 0.0)
    else:
        _reset(client, body, [(index, position, velocity)])


@exported
def resetJointStatesMultiDof(
    bodyUniqueId: int,
    jointIndices: Indices,
    targetValues: Vectors,
    targetVelocities: Vectors | None = None,
    physicsClientId: int = 0,
) -> None:
    """Sets the states of several joints: `resetJointStateMultiDof` for each.

    Nothing changes if an argument is wrong.

    Args:
        bodyUniqueId: The body.
        jointIndices: The joints, in any order.
        targetValues: A list of positions for each.
        targetVelocities: A list of velocities for each.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such body or joint, the numbers of lists and of joints
            differ, both lists of a joint are empty, or one holds something that is not a finite number.

    Examples:
        >>> p.resetJointStatesMultiDof(arm, [2, 3], [[0.25], [0.5]])
        >>> [state[0] for state in p.getJointStates(arm, [2, 3])]
        [0.25, 0.5]
    """
    client = client_of(physicsClientId)
    requested = indices(jointIndices, NO_INDICES, "jointIndices")
    if not requested:
        return
    positions = sequence(targetValues, _NO_LISTS, "targetValues")
    velocities = () if targetVelocities is None else sequence(targetVelocities, _NO_LISTS, "targetVelocities")
    for name, values in (("targetValues", positions), ("targetVelocities", velocities)):
        if values and len(values) != len(requested):
            fail(
                "Number of targetValues and targetVelocities needs to match number of indices.",
                f"There are {len(requested)} indices and {len(values)} {name}.",
            )
    resets, body = list[_State](), None
    for place, index in enumerate(requested):
        access, joint = joint_access(bodyUniqueId, index, physicsClientId)
        position, velocity = _targets(
            positions[place] if positions else (), velocities[place] if velocities else None
        )
        if len(position) == _QUATERNION:
            _check_turn(access.body, joint, position)
        body = access.body
        resets.append((joint, position, velocity))
    assert body is not None
    _reset(client, body, resets)


def _targets(position: Any, velocity: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Positions and velocities of one joint as tuples, from the arguments of a script."""
    positions = quantities(position, _NO_LISTS, "targetValue") if position is not None else ()
    velocities = quantities(velocity, _NO_LISTS, "targetVelocity") if velocity is not None else ()
    if not positions and not velocities:
        fail(_NO_LISTS, "Both are empty.")
    return positions, velocities


def _check_turn(body: Body, joint: int, position: tuple[float, ...]) -> None:
    """Raise `pybullet.error` for four coordinates that are no turn of a spherical joint."""
    if body.position_count[joint] == _QUATERNION:
        check_rotation(position, "expected a targetValue sequence.", "targetValue")


def _reset(client: Client, body: Body, states: Sequence[_State]) -> None:
    """Resets joints, given by index, positions and velocities, all at once."""
    with client.call_lock:
        change = Change()
        known: list[JointReset] = []
        for joint, position, velocity in states:
            if position and len(position) == body.position_count[joint]:
                freedoms = body.velocity_count[joint]
                known.append((joint, position, velocity if len(velocity) == freedoms else (0.0,) * freedoms))
            else:
                known.append((joint, None, None))
        moved = body.note_joint_states(change, known)
        client.world.contact_arrays.note_resets(change, body.rows.tree, *moved)
        # As after any reset, the body is up to date.
        client.world.note_link_poses(change, body)
        change.commit()
