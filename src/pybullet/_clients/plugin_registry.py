"""The plugins of one client, and the folders and archives that its file plugin has added to the search."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.formats.archives import Archive
    from carom.formats.search import AssetSearch

BUILT_IN = {"pdControlPlugin": 0, "collisionFilterPlugin": 1, "tinyRendererPlugin": 2, "fileIOPlugin": 3}
"""Ids of the plugins that are part of PyBullet."""
FILE_IO = BUILT_IN["fileIOPlugin"]
EGL_RENDERER = len(BUILT_IN)
"""Id of `eglRenderer`, the only plugin that scripts load from a separate library."""


def is_egl_renderer(path: str) -> bool:
    """Whether a path is that of the library `eglRenderer`, as Python's import system finds it."""
    file = Path(path)
    # Not `Path.is_file`, which raises an exception for names that no file can have.
    return os.path.isfile(path) and "eglRenderer" in (file.parent.name, file.name.partition(".")[0])


class Plugins:
    """Plugins of a client.

    Attributes:
        loaded: Ids of the plugins that have been loaded.
        places: Folders and archives that are searched, by slot. Slot 0 stands for the file system itself.
    """

    def __init__(self) -> None:
        self.loaded: set[int] = set()
        self.places: dict[int, Path | Archive] = {}
        self._search: AssetSearch | None = None

    def slot_of(self, path: Path) -> int | None:
        """The slot of a folder or an archive; None if it is not searched."""
        for slot, place in self.places.items():
            if path == (place if isinstance(place, Path) else place.path):
                return slot
        return None

    def add_place(self, place: Path | Archive) -> int:
        """Adds a folder or an archive to the search; returns its slot: the lowest free one."""
        slot = next(n for n in range(1, len(self.places) + 2) if n not in self.places)
        self.places[slot] = place
        return slot

    def remove_place(self, slot: int) -> None:
        """Removes a place from the search, if it exists."""
        place = self.places.pop(slot, None)
        if place is not None and not isinstance(place, Path):
            place.close()

    def remove_all_places(self) -> None:
        """Removes all places except the file system."""
        for slot in list(self.places):
            self.remove_place(slot)

    def search(self, additional: Path | None, last: Path | None) -> AssetSearch:
        """The folders and archives searched for files: `additional`, those of the plugin, and `last`."""
        folders: tuple[Path, ...] = ()
        if self.places:
            places = [self.places[slot] for slot in sorted(self.places)]
            folders = tuple([place if isinstance(place, Path) else place.folder for place in places])
        if last is not None and last is not additional and last != additional:
            folders = (*folders, last)
        search = self._search
        if search is None or (search.additional, search.folders) != (additional, folders):
            from carom.formats.search import AssetSearch

            # The same object as long as possible, because files are cached by it.
            search = self._search = AssetSearch(additional, folders)
        return search
