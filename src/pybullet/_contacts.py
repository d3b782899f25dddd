"""Contacts: where bodies touch and how hard."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from struct import Struct
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from pybullet._arguments import integer
from pybullet._builtin import exported
from pybullet._clients import client_of

if TYPE_CHECKING:
    from carom.world import World

__all__ = [
    "getContactPoints",
    "performCollisionDetection",
]

_ANY_BODY = -1
_BASE = -1
_ANY_LINK = -2

# Rows of `Contacts`: two shapes and their links, a number, a vector, and the impulses of the last substep
# with the normal one of the substep before.
_SHAPES, _REAL, _VECTOR, _IMPULSES = Struct("4i"), Struct("d"), Struct("3d"), Struct("4d")
_read_real, _read_vector, _read_impulses = _REAL.unpack_from, _VECTOR.unpack_from, _IMPULSES.unpack_from

ContactPoint = tuple[
    int, int, int, int, int, Vector3, Vector3, Vector3, float, float, float, Vector3, float, Vector3
]


@exported
def performCollisionDetection(physicsClientId: int = 0) -> None:
    """Finds all contacts for the present poses without a step.

    Contacts that were there after the last step keep their forces; new ones have none.

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
    with client.lock:
        client.world.detect_collisions()


@exported
def getContactPoints(
    bodyA: int = _ANY_BODY,
    bodyB: int = _ANY_BODY,
    linkIndexA: int = _ANY_LINK,
    linkIndexB: int = _ANY_LINK,
    physicsClientId: int = 0,
) -> tuple[ContactPoint, ...]:
    """The contacts that the last step, or `performCollisionDetection`, found.

    Args:
        bodyA: Only contacts of this body, which is then the first of each; negative for all.
        bodyB: Only contacts whose second body is this one; negative for all. Without `bodyA` it is the
            engine that decides which body is the second.
        linkIndexA: Only contacts of this link of the first body; -1 for the base, -2 and less for all.
        linkIndexB: Only contacts of this link of the second body; -1 for the base, -2 and less for all.
        physicsClientId: The connection.

    Returns:
        For each contact (0, bodyA, bodyB, linkIndexA, linkIndexB, point on A, point on B, normal on B
        towards A, distance, normal force, friction force 1, its direction, friction force 2, its
        direction). Points and directions are in the world frame; a negative distance is penetration.
        The friction is that on the body that is listed first when no body is asked for.

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
    world = client.world
    first = _rows(world, integer(bodyA, "bodyA"), integer(linkIndexA, "linkIndexA"))
    second = _rows(world, integer(bodyB, "bodyB"), integer(linkIndexB, "linkIndexB"))
    touch = world.touch
    count = touch.contact_count
    if not count:
        return ()
    links = _SHAPES.iter_unpack(touch.contacts.bytes_of("contact_shapes")[: count * _SHAPES.size])
    chosen = list(_chosen(links, first, second, may_swap=bodyA >= 0))
    return tuple(_points(world, chosen, client.time_step)) if chosen else ()


def _rows(world: World, body_id: int, link: int) -> Container[int]:
    """Rows of the link arrays that fit a body, negative for any, and a link of it, -2 and less for any."""
    if body_id >= 0:
        body = world.bodies.get(body_id)
        if body is None:
            return ()
        rows = range(body.first_link, body.first_link + 1 + body.joint_count)
        return rows if link < _BASE else rows[link + 1 : link + 2]
    if link < _BASE:
        return range(len(world.link_places))
    return {row for row, place in enumerate(world.link_places) if place[1] == link}


def _chosen(
    links: Iterable[tuple[int, ...]], first: Container[int], second: Container[int], *, may_swap: bool
) -> Iterator[tuple[int, int, int, bool]]:
    """Row and links of each contact that is asked for, and whether they change places.

    They do to put `bodyA` first; without it they stay as they are.
    """
    for row, (_, _, a, b) in enumerate(links):
        if a in first and b in second:
            yield row, a, b, False
        elif may_swap and b in first and a in second:
            yield row, b, a, True


def _points(
    world: World, chosen: list[tuple[int, int, int, bool]], time_step: float
) -> Iterator[ContactPoint]:
    places, memory = world.link_places, world.touch.contacts.bytes_of
    points_a, points_b, normals = (
        memory("contact_point_a"),
        memory("contact_point_b"),
        memory("contact_normal"),
    )
    directions1, directions2 = memory("contact_direction1"), memory("contact_direction2")
    distances, impulses = memory("contact_distance"), memory("contact_impulse")
    for row, first, second, swapped in chosen:
        at = row * _VECTOR.size
        on_a, on_b = _read_vector(points_a, at), _read_vector(points_b, at)
        normal = x, y, z = _read_vector(normals, at)
        if swapped:
            on_a, on_b, normal = on_b, on_a, (-x, -y, -z)
        (body_a, link_a), (body_b, link_b) = places[first], places[second]
        (distance,) = _read_real(distances, row * _REAL.size)
        pushing, sliding1, sliding2, _ = _read_impulses(impulses, row * _IMPULSES.size)
        yield (
            0,
            body_a,
            body_b,
            link_a,
            link_b,
            on_a,
            on_b,
            normal,
            distance,
            pushing / time_step,
            sliding1 / time_step,
            _read_vector(directions1, at),
            sliding2 / time_step,
            _read_vector(directions2, at),
        )
