"""Contact points and contact forces."""

from __future__ import annotations

from itertools import repeat

from carom.description.pose import Vector3
from pybullet._calls.arguments import integer
from pybullet._calls.builtin import exported
from pybullet._clients.clients import client_of

__all__ = ["getContactPoints", "performCollisionDetection"]

_ANY_BODY = -1
_ANY_LINK = -2

ContactPoint = tuple[
    int, int, int, int, int, Vector3, Vector3, Vector3, float, float, float, Vector3, float, Vector3
]


@exported
def performCollisionDetection(physicsClientId: int = 0) -> None:
    """Finds all contacts for the present poses without a step.

    Contacts of the last step keep their forces; new ones have none.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.performCollisionDetection()
        >>> len(p.getContactPoints(cube, plane)) > 0
        True
    """
    client = client_of(physicsClientId)
    with client.call_lock, client.world.present_poses():
        client.world.detect_collisions()
        client.world.engine.show_detection(client.world.quick)


@exported
def getContactPoints(
    bodyA: int = _ANY_BODY,
    bodyB: int = _ANY_BODY,
    linkIndexA: int = _ANY_LINK,
    linkIndexB: int = _ANY_LINK,
    physicsClientId: int = 0,
) -> tuple[ContactPoint, ...]:
    """The contact points found by the last step, or by `performCollisionDetection`.

    Args:
        bodyA: Only contacts of this body, which is then the first of each; negative for all.
        bodyB: Only contacts whose second body is this one; negative for all. Without `bodyA` the engine
            decides which body is the second.
        linkIndexA: Only contacts of this link of the first body; -1 for the base, -2 and less for all.
        linkIndexB: Only contacts of this link of the second body; -1 for the base, -2 and less for all.
        physicsClientId: The connection.

    Returns:
        For each contact (0, bodyA, bodyB, linkIndexA, linkIndexB, point on A, point on B, normal on B
        towards A, distance, normal force, friction force 1, its direction, friction force 2, its
        direction). Points and directions are in the world frame; a negative distance is penetration. A soft
        body has a contact for each node that touches a link or another soft body; the distance that is kept
        between them is subtracted. Friction forces are those on the body that is listed first if the script
        asks for no body.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> for _ in range(24):
        ...     _ = p.stepSimulation()
        >>> point = p.getContactPoints(bodyA=cube, bodyB=plane)[0]
        >>> [round(x) for x in point[7]], point[9] > 0
        ([0, 0, 1], True)
    """
    client = client_of(physicsClientId)
    asked = (
        integer(bodyA, "bodyA"),
        integer(linkIndexA, "linkIndexA"),
        integer(bodyB, "bodyB"),
        integer(linkIndexB, "linkIndexB"),
    )
    # Another thread may be stepping, and contacts are read from arrays that a step changes.
    with client.call_lock:
        count, columns = client.world.queries().contact_columns(*asked, client.time_step)
        return tuple(zip(repeat(0, count), *columns, strict=False)) if count else ()
