"""Poses and velocities of links."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, overload

from pybullet._calls.arguments import Indices, indices, integer
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.lookup import body_access, has_joint

if TYPE_CHECKING:
    from pybullet._access.body_access import BodyAccess, LinkState, LinkStateWithVelocity

__all__ = ["getLinkState", "getLinkStates"]

_NO_STATE = "getLinkState failed."
_NEGATIVE_BODY = "getLinkState failed; invalid bodyUniqueId"


# The state of a link that does not exist is None. The types leave that out: otherwise all who pass a link
# that exists would have to check for it.
@overload
def getLinkState(
    bodyUniqueId: int,
    linkIndex: int,
    computeLinkVelocity: Literal[0, False] = 0,
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> LinkState: ...
@overload
def getLinkState(
    bodyUniqueId: int,
    linkIndex: int,
    computeLinkVelocity: Literal[1, True],
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> LinkStateWithVelocity: ...
@overload
def getLinkState(
    bodyUniqueId: int,
    linkIndex: int,
    computeLinkVelocity: int,
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> LinkState | LinkStateWithVelocity: ...
@exported
def getLinkState(
    bodyUniqueId: int,
    linkIndex: int,
    computeLinkVelocity: int = 0,
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> LinkState | LinkStateWithVelocity | None:
    """Pose of a link and, on request, its velocity.

    After `stepSimulation` the poses are those at the beginning of its last substep, as in PyBullet;
    `computeForwardKinematics=1` updates them.

    Args:
        bodyUniqueId: The body.
        linkIndex: The link, from 0; its index is that of its parent joint.
        computeLinkVelocity: 1 to return the velocities as well.
        computeForwardKinematics: 1 to update the poses first.
        physicsClientId: The connection.

    Returns:
        6 fields: 0 position [m] and 1 quaternion (x, y, z, w) of the inertial frame in the world, its
        origin being the centre of mass; 2 position and 3 quaternion of the inertial frame in the link
        frame; 4 position and 5 quaternion of the link frame in the world. With `computeLinkVelocity`
        also 6 velocity of the centre of mass [m/s] and 7 angular velocity [rad/s], world axes. None if the
        body has fewer links.

    Raises:
        pybullet.error: Not connected, there is no such body, or the index is negative.

    Examples:
        >>> state = p.getLinkState(arm, 6, computeForwardKinematics=1)
        >>> [round(x, 3) for x in state[4]]
        [0.0, 0.0, 1.261]
    """
    access = body_access(bodyUniqueId, physicsClientId, _NO_STATE, _NEGATIVE_BODY)
    index = integer(linkIndex, "linkIndex")
    if index < 0:
        fail(
            "getLinkState failed; invalid linkIndex",
            f"{index} is not a link; for the base see getBasePositionAndOrientation.",
        )
    with_velocity = _prepare(access, computeLinkVelocity, computeForwardKinematics)
    return _state(access, index, with_velocity)


@overload
def getLinkStates(
    bodyUniqueId: int,
    linkIndices: Indices,
    computeLinkVelocity: Literal[0, False] = 0,
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> tuple[LinkState, ...]: ...
@overload
def getLinkStates(
    bodyUniqueId: int,
    linkIndices: Indices,
    computeLinkVelocity: Literal[1, True],
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> tuple[LinkStateWithVelocity, ...]: ...
@overload
def getLinkStates(
    bodyUniqueId: int,
    linkIndices: Indices,
    computeLinkVelocity: int,
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> tuple[LinkState | LinkStateWithVelocity, ...]: ...
@exported
def getLinkStates(
    bodyUniqueId: int,
    linkIndices: Indices,
    computeLinkVelocity: int = 0,
    computeForwardKinematics: int = 0,
    physicsClientId: int = 0,
) -> tuple[LinkState | LinkStateWithVelocity | None, ...]:
    """Poses of several links and, on request, their velocities.

    Args:
        bodyUniqueId: The body.
        linkIndices: The links, in any order.
        computeLinkVelocity: 1 to return the velocities as well.
        computeForwardKinematics: 1 to update the poses first.
        physicsClientId: The connection.

    Returns:
        The result of `getLinkState` for each link; None for an index that the body does not have.

    Raises:
        pybullet.error: Not connected, there is no such body, or the indices are not a sequence.

    Examples:
        >>> [round(state[4][2], 3) for state in p.getLinkStates(arm, [5, 6])]
        [1.18, 1.261]
    """
    access = body_access(bodyUniqueId, physicsClientId, _NO_STATE, _NEGATIVE_BODY)
    requested = indices(linkIndices, "expected a sequence of joint indices", "linkIndices")
    with_velocity = _prepare(access, computeLinkVelocity, computeForwardKinematics)
    return tuple([_state(access, index, with_velocity) for index in requested])


def _prepare(access: BodyAccess, compute_velocity: Any, compute_kinematics: Any) -> bool:
    """Update poses as the arguments request; return whether they request velocities."""
    with_velocity = integer(compute_velocity, "computeLinkVelocity") != 0
    if integer(compute_kinematics, "computeForwardKinematics") != 0:
        access.body.update_link_poses()
    return with_velocity


def _state(access: BodyAccess, index: int, with_velocity: bool) -> LinkState | LinkStateWithVelocity | None:
    return access.link_state(index, with_velocity) if has_joint(access.body, index) else None
