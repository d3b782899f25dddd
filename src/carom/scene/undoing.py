"""How a change of the scene begins, so that it is made as a whole or not at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.native.undo import Undo
    from carom.world.world import World


def begin(world: World) -> Undo:
    """Begin a change; what may be left of one that was interrupted comes to its end before."""
    world.undo.settle()
    # Nothing that was made for the world as it was may be used before it is whole again.
    world.undo.note(world.scene_changed)
    world.scene_changed()
    return world.undo
