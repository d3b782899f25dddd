"""Access to the world of a body, unless the body was removed: its rows may then belong to other bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World


def world_of(body: Body) -> World:
    """The world a body is in.

    Raises:
        ValueError: The body was removed from it, or the world was reset or left.
    """
    if body.world.bodies.get(body.id) is not body:
        raise ValueError(f"body {body.id} ({body.name!r}) is no longer in its world")
    return body.world
