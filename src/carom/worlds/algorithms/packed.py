"""Saved states of worlds as one array of bytes, for programs that pass nothing but arrays."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from carom.layouts.contacts import Contacts
from carom.native.tables import fields_of
from carom.worlds.saved import SavedWorlds

_LONE = ("times", "unspent_times")
_AXES = {name: field.axis for name, field in fields_of(Contacts).items()}


class Packing:
    """How the saved states of some worlds become an array (n, size) of bytes, and such an array a state.

    Attributes:
        size: Number of bytes of a world.

    Args:
        saved: A state of these worlds.
        rooms: How many contacts and overlaps there is room for in each world, by the axes of their fields.
    """

    def __init__(self, saved: SavedWorlds, rooms: dict[str, int]) -> None:
        self._worlds = saved.worlds
        self._rooms = rooms
        # Parts in their order: (part of the state, name, type, shape in one world).
        self._layout = [
            (part, name, array.dtype, self._shape(name, array) if part == "contacts" else array.shape[1:])
            for part, name, array in _arrays(saved)
        ]
        self.size: int = sum(dtype.itemsize * int(np.prod(shape)) for _, _, dtype, shape in self._layout)

    def _shape(self, name: str, array: np.ndarray) -> tuple[int, ...]:
        room = self._rooms.get(_AXES[name])
        return array.shape[1:] if room is None else (room, *array.shape[2:])

    def pack(self, saved: SavedWorlds) -> np.ndarray:
        """The bytes of a state, (n, size).

        Raises:
            ValueError: A world has more contacts or overlaps than there is room for.
        """
        blocks: list[np.ndarray] = []
        for (part, name, dtype, shape), (_, _, array) in zip(self._layout, _arrays(saved), strict=True):
            block = np.zeros((len(saved), *shape), dtype)
            if part == "contacts" and (kind := _AXES[name]) in self._rooms:
                if array.shape[1] > shape[0]:
                    raise ValueError(
                        f"a world has {array.shape[1]} {kind}s, and the memory has room for {shape[0]}: make "
                        f"the stepper with contact_room={array.shape[1]} or more"
                    )
                block[:, : array.shape[1]] = array
            else:
                block[:] = array
            blocks.append(block.reshape(len(saved), int(np.prod(shape))).view(np.uint8))
        return np.concatenate(blocks, axis=1)

    def unpack(self, packed: np.ndarray, worlds: np.ndarray | None = None) -> SavedWorlds:
        """The state whose bytes (n, size) `pack` gave, of worlds (n,); None for those of the first state."""
        found: dict[str, dict[str, np.ndarray]] = {"state": {}, "contacts": {}, "times": {}}
        first = 0
        for part, name, dtype, shape in self._layout:
            size = dtype.itemsize * int(np.prod(shape))
            block = np.ascontiguousarray(packed[:, first : first + size])
            found[part][name] = block.view(dtype).reshape(len(packed), *shape)
            first += size
        times = found["times"]
        return SavedWorlds(
            self._worlds if worlds is None else worlds,
            times["times"],
            times["unspent_times"],
            found["state"],
            found["contacts"],
        )


def _arrays(saved: SavedWorlds) -> Iterator[tuple[str, str, np.ndarray]]:
    for name in _LONE:
        yield "times", name, getattr(saved, name)
    for part in ("state", "contacts"):
        for name, array in getattr(saved, part).items():
            yield part, name, array
