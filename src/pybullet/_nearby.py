"""What is near: nearest points of bodies, and bodies within a box."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from pybullet._arguments import bound, integer, vector3
from pybullet._builtin import exported
from pybullet._clients import client_of
from pybullet._contacts import ContactPoint
from pybullet._errors import fail
from pybullet._link_rows import Place, places

if TYPE_CHECKING:
    import numpy as np

    from carom.queries import NearestPoints
    from carom.world import World

__all__ = ["getClosestPoints", "getOverlappingObjects"]

_ANY_LINK = -2
_NONE = (0.0, 0.0, 0.0)
_BAD_CORNER = "aabbMin and aabbMax must be corners [x,y,z] of a box."
_BODILESS = "getClosestPoints: collisionShapeA and collisionShapeB are not available in this version of Carom"


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
    """The nearest points of the links of two bodies; shapes without bodies are not available yet.

    Args:
        bodyA: A body.
        bodyB: Another, or the same.
        distance: Only points at most this far apart [m].
        linkIndexA: Link of `bodyA`, -1 for the base; -2 for all links.
        linkIndexB: Link of `bodyB`.
        collisionShapeA: -1.
        collisionShapeB: -1.
        collisionShapePositionA: Not used.
        collisionShapePositionB: Not used.
        collisionShapeOrientationA: Not used.
        collisionShapeOrientationB: Not used.
        physicsClientId: The connection.

    Returns:
        A tuple like that of `getContactPoints` for each pair of shapes within reach, without forces;
        empty for bodies or links that do not exist.

    Raises:
        pybullet.error: Not connected, or a shape without a body is given.
    """
    world = client_of(physicsClientId).world
    body_a, body_b = integer(bodyA, "bodyA"), integer(bodyB, "bodyB")
    reach = bound(distance, "distance")
    links_a = _rows(world, body_a, integer(linkIndexA, "linkIndexA"))
    links_b = _rows(world, body_b, integer(linkIndexB, "linkIndexB"))
    if integer(collisionShapeA, "collisionShapeA") >= 0 or integer(collisionShapeB, "collisionShapeB") >= 0:
        fail(_BODILESS)
    found = world.queries().nearest(list(product(links_a, links_b)), reach)
    first = places(world, [a for a, _b, _points in found])
    second = places(world, [b for _a, b, _points in found])
    return tuple(
        _contact_point(place_a, place_b, points)
        for place_a, place_b, (_a, _b, points) in zip(first, second, found, strict=True)
        if place_a is not None and place_b is not None
    )


def _rows(world: World, body_id: int, link: int) -> range:
    """Rows of a link, or of all links of a body."""
    body = world.bodies.get(body_id)
    if body is None:
        return range(0)
    every = range(body.first_link, body.first_link + 1 + body.joint_count)
    if link == _ANY_LINK:
        return every
    return every[link + 1 : link + 2] if link >= -1 else range(0)


def _contact_point(a: Place, b: Place, points: NearestPoints) -> ContactPoint:
    on_a, on_b, normal = (_vector(part) for part in (points.on_a, points.on_b, points.normal))
    return 0, a[0], b[0], a[1], b[1], on_a, on_b, normal, points.distance, 0.0, 0.0, _NONE, 0.0, _NONE


def _vector(values: np.ndarray) -> Vector3:
    x, y, z = values.tolist()
    return x, y, z


@exported
def getOverlappingObjects(
    aabbMin: Sequence[float], aabbMax: Sequence[float], physicsClientId: int = 0
) -> tuple[Place, ...] | None:
    """The links whose bounds meet a box along the world's axes.

    Args:
        aabbMin: Lowest corner of the box [m].
        aabbMax: Its highest corner.
        physicsClientId: The connection.

    Returns:
        (body, link) of each, -1 for the base, in the order of bodies and links; None if there are none.

    Raises:
        pybullet.error: Not connected, or a corner is not three finite numbers.
    """
    world = client_of(physicsClientId).world
    lower = vector3(aabbMin, _BAD_CORNER, "aabbMin")
    upper = vector3(aabbMax, _BAD_CORNER, "aabbMax")
    found = places(world, world.queries().overlapping(lower, upper))
    return tuple(sorted(place for place in found if place is not None)) or None
