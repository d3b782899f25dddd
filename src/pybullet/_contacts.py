"""Contacts: where bodies touch and how hard."""

from __future__ import annotations

from collections.abc import Container, Iterator
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
    world = client_of(physicsClientId).world
    first = _rows(world, integer(bodyA, "bodyA"), integer(linkIndexA, "linkIndexA"))
    second = _rows(world, integer(bodyB, "bodyB"), integer(linkIndexB, "linkIndexB"))
    links = world.touch.contacts.numpy["contact_shapes"][0, : world.touch.contact_count, 2:].tolist()
    chosen = list(_chosen(links, first, second, may_swap=bodyA >= 0))
    if not chosen:
        return ()
    return tuple(_points(world, chosen))


def _rows(world: World, body_id: int, link: int) -> Container[int]:
    """Rows of the link arrays that fit a body, negative for any, and a link of it, -2 and less for any."""
    if body_id >= 0 and link < _BASE:
        body = world.bodies.get(body_id)
        return () if body is None else range(body.first_link, body.first_link + 1 + body.joint_count)
    if body_id < 0 and link < _BASE:
        return range(len(world.link_places))
    return {
        row
        for row, place in enumerate(world.link_places)
        if place[1] == link and (body_id < 0 or place[0] == body_id)
    }


def _chosen(
    links: list[list[int]], first: Container[int], second: Container[int], *, may_swap: bool
) -> Iterator[tuple[int, int, int, bool]]:
    """Row and links of each contact that is asked for, and whether they change places.

    They do to put `bodyA` first; without it they stay as they are.
    """
    for row, (a, b) in enumerate(links):
        if a in first and b in second:
            yield row, a, b, False
        elif may_swap and b in first and a in second:
            yield row, b, a, True


def _points(world: World, chosen: list[tuple[int, int, int, bool]]) -> Iterator[ContactPoint]:
    places = world.link_places
    rows = [row for row, _, _, _ in chosen]
    contacts = world.touch.contacts.numpy

    def vectors(field: str) -> Iterator[Vector3]:
        return map(tuple, contacts[field][0, rows].tolist())

    columns = zip(
        chosen,
        vectors("contact_point_a"),
        vectors("contact_point_b"),
        vectors("contact_normal"),
        contacts["contact_distance"][0, rows].tolist(),
        (contacts["contact_impulse"][0, rows] / world.parameters.time_step).tolist(),
        vectors("contact_direction1"),
        vectors("contact_direction2"),
        strict=True,
    )
    for (_, first, second, swapped), on_a, on_b, normal, distance, force, along1, along2 in columns:
        if swapped:
            on_a, on_b, normal = on_b, on_a, (-normal[0], -normal[1], -normal[2])
        (body_a, link_a), (body_b, link_b) = places[first], places[second]
        sides = (body_a, body_b, link_a, link_b)
        yield (0, *sides, on_a, on_b, normal, distance, force[0], force[1], along1, force[2], along2)
