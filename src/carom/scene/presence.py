"""Letting a body of a single world come or go; `engine.presence` says what that changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.engine.presence import change_presence
from carom.native.uninterrupted import uninterrupted

if TYPE_CHECKING:
    from carom.scene.body import Body


def set_present(body: Body, present: bool) -> None:
    """Let a body come or go, or leave it as it is; see `Body.present`."""
    world = body.world
    with uninterrupted:
        world.undo.settle()
        wanted, only = np.array([present]), np.zeros(1, dtype=np.int64)
        change = change_presence(world.arrays, world.contact_arrays, body.rows, only, wanted)

        def apply() -> None:
            change()
            world.scene_changed()

        world.undo.at_once(apply)
