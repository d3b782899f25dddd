"""Pickles of worlds and bodies: a world goes through its file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.world.world import World

_NAME = "world.carom"


def packed_world(world: World) -> bytes:
    """The content of the file that `World.save` writes."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        path = Path(folder) / _NAME
        world.save(path)
        return path.read_bytes()


def unpacked_world(kind: type[World], content: bytes) -> World:
    """The world of `packed_world`."""
    from tempfile import TemporaryDirectory

    world = kind()
    with TemporaryDirectory() as folder:
        path = Path(folder) / _NAME
        path.write_bytes(content)
        world.load_saved(path)
    return world
