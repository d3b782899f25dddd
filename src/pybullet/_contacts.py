"""Contacts: where bodies touch and how hard."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

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
_ANY_LINK = -2

Vector3 = tuple[float, float, float]
ContactPoint = tuple[
    int, int, int, int, int, Vector3, Vector3, Vector3, float, float, float, Vector3, float, Vector3
]


@exported
def performCollisionDetection(physicsClientId: int = 0) -> None:
    """Finds all contacts for the present poses without a step. Forces of the contacts are then 0.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.
    """
    client = client_of(physicsClientId)
    with client.lock:
        client.world.detect_collisions()
        client.world.touch.forget_impulses()


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
        bodyA: Only contacts of this body, which is then the first of each; -1 for all.
        bodyB: Only contacts of this body; -1 for all.
        linkIndexA: Only contacts of this link of `bodyA`; -2 for all, -1 for the base.
        linkIndexB: Only contacts of this link of `bodyB`; -2 for all, -1 for the base.
        physicsClientId: The connection.

    Returns:
        For each contact (0, bodyA, bodyB, linkIndexA, linkIndexB, point on A, point on B, normal on B
        towards A, distance, normal force, friction force 1, its direction, friction force 2, its
        direction). Points and directions are in the world frame; a negative distance is penetration.
        The friction is that on the body that is listed first when no body is asked for.

    Raises:
        pybullet.error: Not connected.
    """
    world = client_of(physicsClientId).world
    wanted_a = (integer(bodyA, "bodyA"), integer(linkIndexA, "linkIndexA"))
    wanted_b = (integer(bodyB, "bodyB"), integer(linkIndexB, "linkIndexB"))
    points = []
    for place_a, place_b, row in _contacts(world):
        if _fits(place_a, wanted_a) and _fits(place_b, wanted_b):
            points.append(_contact_point(world, row, place_a, place_b, swapped=False))
        elif _fits(place_b, wanted_a) and _fits(place_a, wanted_b):
            points.append(_contact_point(world, row, place_b, place_a, swapped=True))
    return tuple(points)


def _fits(place: Place, wanted: Place) -> bool:
    """Whether a body and link are those asked for."""
    return (wanted[0] in (_ANY_BODY, place[0])) and (wanted[1] in (_ANY_LINK, place[1]))


def _contacts(world: World) -> Iterator[tuple[Place, Place, int]]:
    """Body and link of both sides of each contact, and its row."""
    count = world.touch.contact_count
    if count == 0:
        return
    links = world.touch.contacts.numpy["contact_shapes"][0, :count, 2:]
    owners = zip(places(world, links[:, 0]), places(world, links[:, 1]), strict=True)
    for row, (first, second) in enumerate(owners):
        if first is not None and second is not None:
            yield first, second, row


def _contact_point(world: World, row: int, first: Place, second: Place, *, swapped: bool) -> ContactPoint:
    contacts = world.touch.contacts.numpy
    on_a, on_b = contacts["contact_point_a"][0, row].tolist(), contacts["contact_point_b"][0, row].tolist()
    normal = contacts["contact_normal"][0, row]
    if swapped:
        on_a, on_b, normal = on_b, on_a, -normal
    forces = (contacts["contact_impulse"][0, row] / world.parameters.time_step).tolist()
    return (
        0,
        first[0],
        second[0],
        first[1],
        second[1],
        tuple(on_a),
        tuple(on_b),
        tuple(normal.tolist()),
        float(contacts["contact_distance"][0, row]),
        forces[0],
        forces[1],
        tuple(contacts["contact_direction1"][0, row].tolist()),
        forces[2],
        tuple(contacts["contact_direction2"][0, row].tolist()),
    )
