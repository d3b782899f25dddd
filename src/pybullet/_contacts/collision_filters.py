"""Which bodies and links collide."""

from __future__ import annotations

from typing import Any

from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from pybullet._calls.arguments import integer
from pybullet._calls.builtin import exported
from pybullet._clients.clients import Client, client_of
from pybullet._clients.lookup import link_or_warning

__all__ = ["setCollisionFilterGroupMask", "setCollisionFilterPair"]


@exported
def setCollisionFilterPair(
    bodyUniqueIdA: int,
    bodyUniqueIdB: int,
    linkIndexA: int,
    linkIndexB: int,
    enableCollision: int,
    physicsClientId: int = 0,
) -> None:
    """Enables or disables collisions of two links, overriding their groups and masks.

    Both bodies lose their contacts until the next step. A body or link that does not exist is no error.
    Removing one of the bodies removes the rule.

    Args:
        bodyUniqueIdA: A body.
        bodyUniqueIdB: Another body, or the same.
        linkIndexA: Link of the first, from 0; -1 for the base.
        linkIndexB: Link of the second.
        enableCollision: 1: they collide; 0: they do not.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.setCollisionFilterPair(cube, plane, -1, -1, enableCollision=0)
        >>> for _ in range(240):
        ...     _ = p.stepSimulation()
        >>> p.getBasePositionAndOrientation(cube)[0][2] < -1
        True
    """
    client = client_of(physicsClientId)
    enabled = integer(enableCollision, "enableCollision") != 0
    row_a = _row(client, bodyUniqueIdA, linkIndexA, "setCollisionFilterPair")
    row_b = _row(client, bodyUniqueIdB, linkIndexB, "setCollisionFilterPair")
    with client.call_lock, uninterrupted:
        world, change = client.world, Change()
        if row_a is not None and row_b is not None:
            world.contact_arrays.shapes.filters.note(change, row_a, row_b, enabled=enabled)
        bodies = dict.fromkeys((client.body(bodyUniqueIdA), client.body(bodyUniqueIdB)))
        links = [range(body.first_link, body.first_link + 1 + body.joint_count) for body in bodies if body]
        world.contact_arrays.part(change, *links)
        world.change_scene(change)
        change.commit()


@exported
def setCollisionFilterGroupMask(
    bodyUniqueId: int,
    linkIndexA: int,
    collisionFilterGroup: int,
    collisionFilterMask: int,
    physicsClientId: int = 0,
) -> None:
    """Sets the groups a link is in and the groups it collides with, as bits.

    The link loses its contacts until the next step.

    Two links collide if each is in a group of the other's mask; see `collisionFilterMode` of
    `setPhysicsEngineParameter`. By default moving links have group 1 and mask -1, a fixed base group 2 and a
    mask of all groups except 2. A body or link that does not exist is no error.

    Args:
        bodyUniqueId: The body.
        linkIndexA: The link, from 0; -1 for the base.
        collisionFilterGroup: Its groups.
        collisionFilterMask: Groups it collides with.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.setCollisionFilterGroupMask(cube, -1, collisionFilterGroup=0, collisionFilterMask=0)
    """
    client = client_of(physicsClientId)
    group = integer(collisionFilterGroup, "collisionFilterGroup")
    mask = integer(collisionFilterMask, "collisionFilterMask")
    row = _row(client, bodyUniqueId, linkIndexA, "setCollisionFilterGroupMask")
    if row is None:
        return
    with client.call_lock, uninterrupted:
        world, change = client.world, Change()
        world.contact_arrays.shapes.note_group_and_mask(change, row, group, mask)
        world.contact_arrays.part(change, [row])
        world.change_scene(change)
        change.commit()


def _row(client: Client, body_id: Any, link_index: Any, function: str) -> int | None:
    """Row of a link; None, with a warning, if it does not exist."""
    found = link_or_warning(client, body_id, link_index, function)
    return None if found is None else found[0].first_link + 1 + found[1]
