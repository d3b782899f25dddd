"""Contacts: where bodies touch and how hard."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from pybullet._arguments import integer
from pybullet._builtin import exported
from pybullet._clients import client_of
from pybullet._link_rows import Place, places

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
    wanted_a = (integer(bodyA, "bodyA"), integer(linkIndexA, "linkIndexA"))
    wanted_b = (integer(bodyB, "bodyB"), integer(linkIndexB, "linkIndexB"))
    chosen = list(_chosen(_sides(world), wanted_a, wanted_b))
    if not chosen:
        return ()
    return tuple(_points(world, chosen))


def _sides(world: World) -> list[tuple[Place | None, Place | None]]:
    """Body and link of both sides of each contact."""
    links = world.touch.contacts.numpy["contact_shapes"][0, : world.touch.contact_count, 2:]
    return list(zip(places(world, links[:, 0]), places(world, links[:, 1]), strict=True))


def _chosen(
    sides: list[tuple[Place | None, Place | None]], wanted_a: Place, wanted_b: Place
) -> Iterator[tuple[int, Place, Place, bool]]:
    """Row and sides of each contact that is asked for, and whether they change places.

    They do to put `bodyA` first; without it they stay as they are.
    """
    for row, (first, second) in enumerate(sides):
        if first is None or second is None:
            continue
        if _fits(first, wanted_a) and _fits(second, wanted_b):
            yield row, first, second, False
        elif wanted_a[0] >= 0 and _fits(second, wanted_a) and _fits(first, wanted_b):
            yield row, second, first, True


def _fits(place: Place, wanted: Place) -> bool:
    """Whether a body and link are those asked for."""
    return (wanted[0] < 0 or wanted[0] == place[0]) and (wanted[1] < _BASE or wanted[1] == place[1])


def _points(world: World, chosen: list[tuple[int, Place, Place, bool]]) -> Iterator[ContactPoint]:
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
        sides = (first[0], second[0], first[1], second[1])
        yield (0, *sides, on_a, on_b, normal, distance, force[0], force[1], along1, force[2], along2)
