"""Beginning a change of the scene, which is then made completely or not at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.native.undo import Undo
    from carom.world.world import World


def begin(world: World) -> Undo:
    """Begin a change; first complete an earlier one that was interrupted."""
    world.undo.settle()
    # Derived data of the old world must not be used before the change is complete.
    world.undo.note(world.scene_changed)
    world.scene_changed()
    return world.undo
