"""Nearest points of bodies, and bodies in a box."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pybullet._calls.arguments import bound, integer, vector3
from pybullet._calls.builtin import exported
from pybullet._clients.clients import client_of
from pybullet._contacts.contacts import ContactPoint

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from pybullet._clients.clients import Client

__all__ = ["getClosestPoints", "getOverlappingObjects"]

_ANY_LINK = -2
_NONE = (0.0, 0.0, 0.0)
_BAD_CORNER = "aabbMin and aabbMax must be corners [x,y,z] of a box."


@exported
def getClosestPoints(
    bodyA: int,
    bodyB: int,
    distance: float,
    linkIndexA: int = _ANY_LINK,
    linkIndexB: int = _ANY_LINK,
    collisionShapeA: int = -1,
    collisionShapeB: int = -1,
    collisionShapePositionA: Sequence[float] | None = None,
    collisionShapePositionB: Sequence[float] | None = None,
    collisionShapeOrientationA: Sequence[float] | None = None,
    collisionShapeOrientationB: Sequence[float] | None = None,
    physicsClientId: int = 0,
) -> tuple[ContactPoint, ...]:
    """The nearest points of the links of two bodies, or of collision shapes without a body.

    Args:
        bodyA: A body; -1 if there is only a shape on this side.
        bodyB: Another, or the same.
        distance: Only points at most this far apart [m].
        linkIndexA: Link of `bodyA`, -1 for the base; -2 and less for all links.
        linkIndexB: Link of `bodyB`.
        collisionShapeA: A collision shape with or instead of `bodyA`; -1 for none.
        collisionShapeB: The same for the other side.
        collisionShapePositionA: Position of that shape [m]; the origin if not given.
        collisionShapePositionB: The same for the other side.
        collisionShapeOrientationA: Its orientation (x, y, z, w).
        collisionShapeOrientationB: The same for the other side.
        physicsClientId: The connection.

    Returns:
        A tuple like that of `getContactPoints` for each pair of shapes within reach, without forces;
        empty for bodies, links or shapes that do not exist. Shapes without bodies have link -2.

    Raises:
        pybullet.error: Not connected, or a position or orientation is not three, or four, finite numbers.

    Examples:
        >>> point = p.getClosestPoints(cube, plane, distance=1)[0]
        >>> point[8] < 0.01
        True
    """
    client = client_of(physicsClientId)
    world = client.world
    body_a, body_b = integer(bodyA, "bodyA"), integer(bodyB, "bodyB")
    reach = bound(distance, "distance")
    link_a, link_b = integer(linkIndexA, "linkIndexA"), integer(linkIndexB, "linkIndexB")
    shape_a = integer(collisionShapeA, "collisionShapeA")
    shape_b = integer(collisionShapeB, "collisionShapeB")
    if shape_a >= 0 or shape_b >= 0:
        from pybullet._contacts.bare_shapes import bare_shape, links_of, nearest_points

        sides = []
        for side, body, link, shape, position, orientation in (
            ("A", body_a, link_a, shape_a, collisionShapePositionA, collisionShapeOrientationA),
            ("B", body_b, link_b, shape_b, collisionShapePositionB, collisionShapeOrientationB),
        ):
            bare = bare_shape(client, shape, body, position, orientation, side) if shape >= 0 else None
            sides.append([*([] if bare is None else [bare]), *links_of(client, body, link)])
        first, second = sides
        return tuple([_contact_point(*row) for row in nearest_points(client, first, second, reach)])
    with client.call_lock:
        links_a, links_b = _rows(client, body_a, link_a), _rows(client, body_b, link_b)
        bodies, links = world.link_columns
        found = world.queries().nearest(links_a, links_b, reach)
    return tuple(
        [
            _contact_point((bodies[a], links[a]), (bodies[b], links[b]), on_a, on_b, normal, gap)
            for a, b, on_a, on_b, normal, gap in found
        ]
    )


def _rows(client: Client, body_id: int, link: int) -> range:
    """Rows of a link, or of all links of a body."""
    if client.world.bodies.get(body_id) is None:
        return range(0)
    body = client.bodies[body_id].body
    every = range(body.first_link, body.first_link + 1 + body.joint_count)
    if link <= _ANY_LINK:
        return every
    return every[link + 1 : link + 2] if link >= -1 else range(0)


def _contact_point(
    a: tuple[int, int], b: tuple[int, int], on_a: Vector3, on_b: Vector3, normal: Vector3, gap: float
) -> ContactPoint:
    return 0, a[0], b[0], a[1], b[1], on_a, on_b, normal, gap, 0.0, 0.0, _NONE, 0.0, _NONE


@exported
def getOverlappingObjects(
    aabbMin: Sequence[float], aabbMax: Sequence[float], physicsClientId: int = 0
) -> tuple[tuple[int, int], ...] | None:
    """The links whose bounding boxes overlap an axis-aligned box.

    Args:
        aabbMin: Minimum corner of the box [m].
        aabbMax: Its maximum corner.
        physicsClientId: The connection.

    Returns:
        (body, link) of each, -1 for the base, in the order of bodies and links; None if there are none.

    Raises:
        pybullet.error: Not connected, or a corner is not three finite numbers.

    Examples:
        >>> p.getOverlappingObjects([0.45, -0.05, 0.02], [0.55, 0.05, 0.1])
        ((2, -1),)
    """
    client = client_of(physicsClientId)
    lower = vector3(aabbMin, _BAD_CORNER, "aabbMin")
    upper = vector3(aabbMax, _BAD_CORNER, "aabbMax")
    with client.call_lock:
        places = client.world.link_places
        found = [places[row] for row in client.world.queries().overlapping(lower, upper)]
    return tuple(sorted(found)) or None
