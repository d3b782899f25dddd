"""External forces and torques, for the next step."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any

from pybullet._calls.arguments import Vector, integer, numbers, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.constants import LINK_FRAME, WORLD_FRAME
from pybullet._calls.errors import fail, no_body, warn_once_here
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import BASE, link_of
from pybullet._maths.rotations import turned

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.scene.body import Body
    from pybullet._access.body_access import BodyAccess
    from pybullet._clients.clients import Client

__all__ = ["applyExternalForce", "applyExternalTorque"]

_FRAMES = (WORLD_FRAME, LINK_FRAME)
_WRONG_FRAME = "flag has to be either WORLD_FRAME or LINK_FRAME"
_WRONG_LINK = "Invalid link index, has to be -1 or larger"


@exported
def applyExternalForce(
    objectUniqueId: int,
    linkIndex: int,
    forceObj: Vector,
    posObj: Vector,
    flags: int,
    physicsClientId: int = 0,
) -> None:
    """Applies a force to a link in the next step. Forces add up. A body that does not exist is no error.

    Args:
        objectUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base. For a soft body the node; -1 for all nodes.
        forceObj: Force [N].
        posObj: Point where the force acts [m].
        flags: `WORLD_FRAME`: both are in the world frame. `LINK_FRAME`: both are in the inertial frame of
            the link, so that a position of zeros is its centre of mass.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such link or frame, or an argument is not three finite
            numbers.

    Examples:
        >>> p.applyExternalForce(cube, -1, [1, 0, 0], [0, 0, 0], p.LINK_FRAME)
        >>> _ = p.stepSimulation()
        >>> p.getBaseVelocity(cube)[0][0] > 0
        True
    """
    client = client_of(physicsClientId)
    force = _of_any_size(forceObj, "force needs a 3 coordinates [x,y,z].", "forceObj")
    point = vector3(posObj, "position needs a 3 coordinates [x,y,z].", "posObj")
    frame = _frame(flags)
    soft = client.body(objectUniqueId)
    if soft is not None and soft.spec.soft is not None:
        _push_node(soft, linkIndex, force, frame)
        return
    access = _body(client, objectUniqueId, linkIndex, "applyExternalForce")
    if access is None:
        return
    access.kernels("apply_force", linkIndex, *force, *point, frame)


@exported
def applyExternalTorque(
    objectUniqueId: int, linkIndex: int, torqueObj: Vector, flags: int, physicsClientId: int = 0
) -> None:
    """Applies a torque to a link in the next step. Torques add up. A body that does not exist is no error.

    Args:
        objectUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        torqueObj: Torque [N m].
        flags: `WORLD_FRAME`: in world axes. `LINK_FRAME`: in the axes of the link's inertial frame.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such link or frame, or the torque is not three finite
            numbers.

    Examples:
        >>> p.applyExternalTorque(cube, -1, [0, 0, 1], p.WORLD_FRAME)
        >>> _ = p.stepSimulation()
        >>> p.getBaseVelocity(cube)[1][2] > 0
        True
    """
    client = client_of(physicsClientId)
    torque = _of_any_size(torqueObj, "torque needs a 3 coordinates [x,y,z].", "torqueObj")
    if integer(linkIndex, "linkIndex") < BASE:
        fail(_WRONG_LINK, f"It is {linkIndex}.")
    frame = _frame(flags)
    access = _body(client, objectUniqueId, linkIndex, "applyExternalTorque")
    if access is None:
        return
    access.kernels("apply_torque", linkIndex, *torque, frame)


def _of_any_size(values: Any, problem: str, name: str) -> Vector3:
    """Three finite numbers, unlike those of `vector3` also beyond its bound."""
    try:
        if len(values) == 3:
            x, y, z = values
            if -inf < x + y + z < inf:
                return float(x), float(y), float(z)
    except (TypeError, ValueError, OverflowError):
        pass
    found = numbers(values, problem, name)
    if len(found) != 3:
        return vector3(values, problem, name)
    return found[0], found[1], found[2]


def _push_node(body: Body, node_index: int, force: Vector3, frame: int) -> None:
    """Add a force to a node of a soft body; for node -1, distribute it equally over all nodes."""
    from carom.scene.soft_body import SoftBody

    assert isinstance(body, SoftBody)
    node, forces = integer(node_index, "linkIndex"), body.node_forces
    if not BASE <= node < len(forces):
        fail(_WRONG_LINK, f"It is {node}, and body {body.id} ({body.name}) has {len(forces)} nodes.")
    if frame == LINK_FRAME:
        x, y, z, w = body.world.position[body.first_position + 3 : body.first_position + 7].tolist()
        force = turned((x, y, z, w), force)
    if node == BASE:
        forces += [component / len(forces) for component in force]
    else:
        forces[node] += force


def _frame(flags: int) -> int:
    frame = integer(flags, "flags")
    if frame not in _FRAMES:
        fail(_WRONG_FRAME, f"It is {frame}.")
    return frame


def _body(client: Client, body_id: int, link_index: int, function: str) -> BodyAccess | None:
    """Access to a body after a check of the link index; None if there is no such body."""
    body = client.body(body_id)
    link = integer(link_index, "linkIndex")
    if body is None:
        warn_once_here(f"{function}: {no_body(body_id)}")
        return None
    link_of(body, link, "linkIndex", _WRONG_LINK)
    return client.bodies[body.id]
