"""Files that users drop on the page: kept in a temporary folder for as long as the simulator runs."""

from __future__ import annotations

import binascii
from base64 import b64decode
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory

_MAX_BYTES = 2**30
_MAX_FILES = 10_000
_FORBIDDEN = frozenset('<>:"|?*\\')


class Uploads:
    """Receives files in pieces, page by page.

    Each drop has a folder of its own, in which files have the paths that they had where they came from.
    """

    def __init__(self) -> None:
        self._folder = TemporaryDirectory(prefix="carom-dropped-", ignore_cleanup_errors=True)
        self._drops: dict[int, tuple[Path, dict[Path, int]]] = {}
        self._count = 0

    def close(self) -> None:
        """Delete all."""
        self._folder.cleanup()

    def take(self, page: int, name: str, data: str, *, start: bool) -> None:
        """Take a piece of a file that a page sends.

        Args:
            page: Number of the page.
            name: Path of the file in what was dropped, with slashes.
            data: The piece, in base 64.
            start: It is the first one.

        Raises:
            ValueError: The name is not that of a file below a folder, the data is not in base 64, or there is
                too much.
        """
        if page not in self._drops:
            self._count += 1
            self._drops[page] = (Path(self._folder.name) / str(self._count), {})
        folder, sizes = self._drops[page]
        path = folder / _inside(name)
        try:
            content = b64decode(data, validate=True)
        except binascii.Error as problem:
            raise ValueError(f"a piece of {name!r} is not in base 64: {problem}") from problem
        if start == (path in sizes):
            raise ValueError(f"{name!r} comes twice" if start else f"{name!r} has not begun")
        if sum(sizes.values()) + len(content) > _MAX_BYTES or len(sizes) > _MAX_FILES:
            del self._drops[page]
            raise ValueError(f"more than {_MAX_BYTES >> 20} MB or {_MAX_FILES} files were dropped")
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(path, "wb" if start else "ab") as file:
            file.write(content)
        sizes[path] = sizes.get(path, 0) + len(content)

    def finish(self, page: int) -> list[Path]:
        """The files that a page has sent since the last time."""
        return [*self._drops.pop(page, (Path(), {}))[1]]


def _inside(name: str) -> PurePosixPath:
    """A path below a folder; raises `ValueError` for any other."""
    path = PurePosixPath(name)
    parts = path.parts
    if (
        not parts
        or path.is_absolute()
        or any(it in ("..", ".") or not _FORBIDDEN.isdisjoint(it) or not it.isprintable() for it in parts)
    ):
        raise ValueError(f"{name!r} is not the path of a file that was dropped")
    return path
