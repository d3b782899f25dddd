"""Zip archives, whose members are unpacked into a temporary folder when they are asked for."""

from __future__ import annotations

import lzma
import os
import struct
import zipfile
import zlib
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import RLock

from carom.errors import DescriptionError
from carom.files.unpacking import in_use
from carom.forks import free_in_forks
from carom.writing import write_whole

MAX_MEMBER_BYTES = 256 << 20
MAX_BYTES = 2 << 30
MAX_MEMBERS = 100_000
"""Limits on the unpacked size of a member and of all that are asked for, and on the number of members,
against archives made to fill discs (zip bombs)."""

# Exceptions that damaged archives cause. RuntimeError: the archive is encrypted, or zipfile does not know its
# compression method. The decompressors raise the last three.
_DAMAGES = (
    OSError, ValueError, RuntimeError, zipfile.BadZipFile, struct.error, EOFError, zlib.error, lzma.LZMAError
)  # fmt: skip


class Archive:
    """A zip file whose members appear in a folder when they are asked for, by `unpack`, until it is closed.

    Attributes:
        path: The file.
        folder: The temporary folder in which its members appear.

    Raises:
        DescriptionError: The file is missing or damaged, or has too many members.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = free_in_forks(RLock())
        self._unpacked = 0
        self._temporary = TemporaryDirectory(prefix="carom-zip-")
        # Without symbolic links, which readers may resolve.
        self.folder: Path = Path(os.path.realpath(self._temporary.name))
        self._prefix = os.path.join(self.folder, "")
        try:
            with zipfile.ZipFile(path) as archive:
                members = archive.infolist()
                if len(members) > MAX_MEMBERS:
                    raise DescriptionError(
                        f"it has {len(members)} members; at most {MAX_MEMBERS} are accepted", file=path
                    )
                self._members = {_inside(it.filename): it for it in members if not it.is_dir()}
                # A path may pass through a folder, as `a/../b` does.
                for folder in {os.path.dirname(name) for name in self._members}:
                    (self.folder / folder).mkdir(parents=True, exist_ok=True)
        except _DAMAGES as problem:
            self.close()
            raise DescriptionError(f"it cannot be unpacked: {problem}", file=path) from problem
        except DescriptionError:
            self.close()
            raise
        in_use[self._prefix] = self

    def close(self) -> None:
        """Delete the temporary folder."""
        in_use.pop(self._prefix, None)
        self._temporary.cleanup()

    def has(self, path: str) -> bool:
        """Whether a member appears at a path in the folder."""
        return self._name(path) in self._members

    def unpack(self, path: str) -> None:
        """Unpack the member that appears at a path in the folder, if there is one and it is not there yet.

        Raises:
            DescriptionError: It is damaged or encrypted, or exceeds a limit.
        """
        name = self._name(path)
        target = self.folder / name
        member = self._members.get(name)
        if member is None:
            return
        with self._lock:
            if target.exists():
                return
            size, left = member.file_size, MAX_BYTES - self._unpacked
            whose = f"its member {member.filename!r} has {size} bytes"
            if size > MAX_MEMBER_BYTES:
                problem = f"{whose}; at most {MAX_MEMBER_BYTES} are accepted"
                raise DescriptionError(problem, file=self.path)
            if size > left:
                problem = f"{whose}; of the {MAX_BYTES} accepted for all members {left} are left"
                raise DescriptionError(problem, file=self.path)
            try:
                with zipfile.ZipFile(self.path) as archive, archive.open(member) as stream:
                    # No more than is stated.
                    write_whole(target, stream.read(size))
            except _DAMAGES as problem:
                text = f"its member {member.filename!r} cannot be unpacked: {problem}"
                raise DescriptionError(text, file=self.path) from problem
            self._unpacked += size

    def _name(self, path: str) -> str:
        return os.path.normpath(path[len(self._prefix) :]).replace(os.sep, "/")


def _inside(name: str) -> str:
    """The name of a member without what would lead out of the folder."""
    parts = os.path.splitdrive(name.replace("\\", "/"))[1].split("/")
    return "/".join(part for part in parts if part not in ("", ".", ".."))
