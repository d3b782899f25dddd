"""Files embedded in a saved world: meshes with their materials and textures.

The document lists them as `{"path": ..., "members": [[name, offset, size], ...]}`. `path` is where the file
was. The members are the file itself and the files it refers to, with paths relative to their nearest common
folder; there are none if the file did not exist any more. If all of them are still there, unchanged, they
are used; otherwise the copies are unpacked to a temporary folder, which exists until the process ends.
"""

from __future__ import annotations

import hashlib
import os
from functools import cache
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Any

from carom.errors import DescriptionError
from carom.files.bounded import read_bounded
from carom.world_files.container import Blocks
from carom.world_files.references import references
from carom.writing import write_whole


class FileTable:
    """The files of a world that is being saved."""

    def __init__(self, blocks: Blocks) -> None:
        self._blocks = blocks
        self._numbers: dict[Path, int] = {}
        self._stored: dict[str, int] = {}
        self.records: list[dict[str, Any]] = []

    def add(self, path: Path) -> int:
        """Add a file with the files it refers to, and return its number; raises `DescriptionError`."""
        path = Path(os.path.abspath(path))
        if path not in self._numbers:
            members = _with_references(path) if path.is_file() else {}
            root = os.path.commonpath([member.parent for member in members] or [path])
            self._numbers[path] = len(self.records)
            self.records.append(
                {
                    "path": str(path),
                    "members": [
                        [member.relative_to(root).as_posix(), self._store(data), len(data)]
                        for member, data in members.items()
                    ],
                }
            )
        return self._numbers[path]

    def _store(self, data: bytes) -> int:
        digest = hashlib.sha256(data).hexdigest()
        if digest not in self._stored:
            self._stored[digest] = self._blocks.add(data)
        return self._stored[digest]


def _with_references(path: Path) -> dict[Path, bytes]:
    """Content of a file, and of the existing files it refers to, directly or through others."""
    contents = {path: read_bounded(path)[0]}
    waiting = [path]
    while waiting:
        source = waiting.pop()
        for other in references(source, contents[source]):
            if other not in contents and other.drive == path.drive:
                contents[other] = read_bounded(other)[0]
                waiting.append(other)
    return contents


def restored(records: Any, blocks: memoryview, file: Path) -> list[Path]:
    """Paths of the files listed in a saved world, unpacked if the originals are missing or have changed.

    Raises:
        DescriptionError: The list is invalid, or a file cannot be unpacked.
    """
    try:
        return [_place(record["path"], _members(record["members"], blocks)) for record in records]
    except (TypeError, KeyError, ValueError) as problem:
        raise DescriptionError("its list of files is invalid", file=file) from problem
    except OSError as problem:
        raise DescriptionError(f"its files cannot be unpacked: {problem}", file=file) from problem


def _members(records: Any, blocks: memoryview) -> dict[PurePosixPath, memoryview]:
    members = {}
    for text, offset, size in records:
        name = PurePosixPath(text)
        inside = 0 <= offset <= offset + size <= len(blocks)
        if (
            not inside
            or not name.parts
            or name.is_absolute()
            or ".." in name.parts
            or "\\" in text
            or ":" in text
        ):
            raise ValueError(text)
        members[name] = blocks[offset : offset + size]
    return members


def _place(path: str, members: dict[PurePosixPath, memoryview]) -> Path:
    original = Path(path)
    first = next(iter(members), None)
    if first is None:
        return original
    if len(original.parts) > len(first.parts):
        root = original.parents[len(first.parts) - 1]
        if root / first == original and all(_same(root / name, data) for name, data in members.items()):
            return original
    digest = hashlib.sha256()
    for name, data in members.items():
        digest.update(f"{name}\0{len(data)}\0".encode())
        digest.update(data)
    folder = Path(_folder().name) / digest.hexdigest()
    for name, data in members.items():
        target = folder / name
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            write_whole(target, data)
    return folder / first


def _same(path: Path, data: memoryview) -> bool:
    try:
        return path.stat().st_size == len(data) and path.read_bytes() == data
    except (OSError, ValueError):
        return False


@cache
def _folder() -> TemporaryDirectory[str]:
    """Temporary folder for unpacked files, which is removed when the process ends."""
    return TemporaryDirectory(prefix="carom-")
