"""Pickles and deep copies of worlds and bodies: a world goes through its file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

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


class Picklable:
    """Pickling and deep-copying of a world; observers and logs are left out."""

    def __deepcopy__(self, memo: dict[int, Any]) -> World:
        from carom.world.copying import copy_world

        world: Any = self
        other = memo[id(self)] = copy_world(world)
        return other

    def __reduce__(self) -> tuple[Any, ...]:
        world: Any = self
        return unpacked_world, (type(world), packed_world(world))
