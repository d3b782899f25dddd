"""The list of bodies, and the motion of their bases."""

from __future__ import annotations

from carom.description.pose import Quaternion, Vector3
from pybullet._calls.arguments import Vector, integer, rotation, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail, logger, no_body
from pybullet._calls.optional_vectors import optional_vector3
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import BASE, body_access, body_of

__all__ = [
    "computeDofCount",
    "getBasePositionAndOrientation",
    "getBaseVelocity",
    "getBodyInfo",
    "getBodyUniqueId",
    "getNumBodies",
    "getNumJoints",
    "removeBody",
    "resetBasePositionAndOrientation",
    "resetBaseVelocity",
]


_HAS_SPHERICAL, _HAS_PLANAR = -1, -2


@exported
def getNumBodies(physicsClientId: int = 0) -> int:
    """The number of bodies.

    Args:
        physicsClientId: The connection.

    Returns:
        The number of bodies.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getNumBodies()
        3
    """
    return len(client_of(physicsClientId).world.bodies)


@exported
def getBodyUniqueId(serialIndex: int, physicsClientId: int = 0) -> int:
    """The id of the n-th body; the last one takes the place of one that is removed.

    Args:
        serialIndex: From 0 to `getNumBodies() - 1`.
        physicsClientId: The connection.

    Returns:
        Its id, or -1 if there are fewer bodies.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> [p.getBodyUniqueId(serial) for serial in range(p.getNumBodies())]
        [0, 1, 2]
    """
    bodies = client_of(physicsClientId).world.listing
    position = integer(serialIndex, "serialIndex")
    return list(bodies)[position] if 0 <= position < len(bodies) else -1


@exported
def getBodyInfo(bodyUniqueId: int, physicsClientId: int = 0) -> tuple[bytes, bytes]:
    """The names of a body.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Returns:
        (name of the base link, name of the body), as bytes.

    Raises:
        pybullet.error: Not connected, or there is no such body.

    Examples:
        >>> base, name = p.getBodyInfo(arm)
        >>> base.decode(), name.decode()
        ('lbr_iiwa_link_0', 'lbr_iiwa')
    """
    return body_of(client_of(physicsClientId), bodyUniqueId, "Couldn't get body info").encoded_names()


@exported
def removeBody(bodyUniqueId: int, physicsClientId: int = 0) -> None:
    """Removes a body from the world. A body that does not exist is no error.

    The next body loaded gets its id.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.removeBody(cube)
        >>> p.getNumBodies()
        2
    """
    client = client_of(physicsClientId)
    body = client.body(bodyUniqueId)
    if body is None:
        logger.warning("removeBody: %s", no_body(bodyUniqueId))
        return
    with client.call_lock:
        client.bodies.forget_all()
        client.world.remove(body.id)
        client.origins.pop(body.id, None)
        client.maximal.discard(body.id)


@exported
def getNumJoints(bodyUniqueId: int, physicsClientId: int = 0) -> int:
    """The number of joints of a body, fixed ones included: also the number of its links without the base.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Returns:
        The number of joints; 0 if there is no such body.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getNumJoints(arm)
        7
    """
    body = client_of(physicsClientId).body(bodyUniqueId)
    return 0 if body is None else body.joint_count


@exported
def computeDofCount(bodyUniqueId: int, physicsClientId: int = 0) -> int:
    """The number of degrees of freedom of a body's joints; its base does not count.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Returns:
        The number of revolute and prismatic joints; 0 if there is no such body. If there are spherical or
        planar joints: -1 if the first of them is spherical, -2 if it is planar.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.computeDofCount(arm)
        7
    """
    body = client_of(physicsClientId).body(bodyUniqueId)
    if body is None:
        return 0
    for coordinates, freedoms in zip(body.position_count, body.velocity_count, strict=True):
        if freedoms > 1:
            return _HAS_PLANAR if coordinates == freedoms else _HAS_SPHERICAL
    return sum(body.velocity_count)


@exported
def getBasePositionAndOrientation(bodyUniqueId: int, physicsClientId: int = 0) -> tuple[Vector3, Quaternion]:
    """Pose of the inertial frame of a body's base: its centre of mass, not the link frame of the file.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Returns:
        (position [m], quaternion (x, y, z, w)), world frame.

    Raises:
        pybullet.error: Not connected, or there is no such body.

    Examples:
        >>> position, orientation = p.getBasePositionAndOrientation(cube)
        >>> position, orientation
        ((0.5, 0.0, 0.025), (0.0, 0.0, 0.0, 1.0))
    """
    access = body_access(bodyUniqueId, physicsClientId, "GetBasePositionAndOrientation failed.")
    return access.inertial_frame(BASE)


@exported
def resetBasePositionAndOrientation(
    bodyUniqueId: int, posObj: Vector, ornObj: Vector, physicsClientId: int = 0
) -> None:
    """Sets the pose of a body's base and its velocity to 0; joints do not change.

    A body that does not exist is no error.

    Args:
        bodyUniqueId: The body.
        posObj: Position of the base's centre of mass [m], world frame.
        ornObj: Orientation of its inertial frame (x, y, z, w).
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or an argument is not three, or four, finite numbers.

    Examples:
        >>> p.resetBasePositionAndOrientation(cube, [1, 0, 1], p.getQuaternionFromEuler([0, 0, 0.5]))
        >>> p.getBasePositionAndOrientation(cube)[0]
        (1.0, 0.0, 1.0)
    """
    client = client_of(physicsClientId)
    body = client.body(bodyUniqueId)
    position = vector3(posObj, "position needs a 3 coordinates [x,y,z].", "posObj")
    problem = "orientation needs a 4 coordinates, quaternion [x,y,z,w]."
    orientation = rotation(ornObj, problem, "ornObj")
    if body is not None:
        client.bodies[body.id].place_base(position, orientation)


@exported
def getBaseVelocity(bodyUniqueId: int, physicsClientId: int = 0) -> tuple[Vector3, Vector3]:
    """Velocity of a body's base.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Returns:
        (velocity of the centre of mass [m/s], angular velocity [rad/s]), world axes.

    Raises:
        pybullet.error: Not connected, or there is no such body.

    Examples:
        >>> linear, angular = p.getBaseVelocity(cube)
        >>> linear
        (0.0, 0.0, 0.0)
    """
    return body_access(bodyUniqueId, physicsClientId, "getBaseVelocity failed.").base_velocity()


@exported
def resetBaseVelocity(
    objectUniqueId: int,
    linearVelocity: Vector | None = None,
    angularVelocity: Vector | None = None,
    physicsClientId: int = 0,
) -> None:
    """Sets the velocity of a body's base. A body that does not exist is no error.

    An argument without three items sets that velocity to 0, as in PyBullet, with a warning.

    Args:
        objectUniqueId: The body.
        linearVelocity: Of the centre of mass [m/s], world axes; None does not change it.
        angularVelocity: [rad/s], world axes; None does not change it.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, neither velocity is given, or an item is not a finite number.

    Examples:
        >>> p.resetBaseVelocity(cube, linearVelocity=[1, 0, 0])
        >>> p.getBaseVelocity(cube)
        ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    """
    client = client_of(physicsClientId)
    body = client.body(objectUniqueId)
    problem = "expected at least linearVelocity and/or angularVelocity."
    if linearVelocity is None and angularVelocity is None:
        fail(problem)
    linear = angular = None
    if linearVelocity is not None:
        linear = optional_vector3(linearVelocity, problem, "linearVelocity") or (0.0, 0.0, 0.0)
    if angularVelocity is not None:
        angular = optional_vector3(angularVelocity, problem, "angularVelocity") or (0.0, 0.0, 0.0)
    if body is not None:
        client.bodies[body.id].set_base_velocity(linear, angular)
