"""Archives whose files are found as if they lay in a folder."""

from __future__ import annotations

import lzma
import struct
import zipfile
import zlib
from pathlib import Path
from tempfile import TemporaryDirectory

from carom.errors import DescriptionError

MOST_BYTES = 2 << 30
MOST_MEMBERS = 100_000
"""Larger archives, unpacked, are refused: they are made to fill discs."""

# What reading a damaged archive raises. RuntimeError: encrypted, or compressed by a method that zipfile does
# not know; the last three come from the methods themselves.
_DAMAGES = (
    OSError, ValueError, RuntimeError, zipfile.BadZipFile, struct.error, EOFError, zlib.error, lzma.LZMAError
)  # fmt: skip


class Archive:
    """A zip file, unpacked for as long as it is in use.

    Attributes:
        path: The file.
        folder: Where its members are.

    Args:
        path: The file.

    Raises:
        DescriptionError: It is missing, damaged, encrypted or too large.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._temporary = TemporaryDirectory(prefix="carom-zip-")
        self.folder: Path = Path(self._temporary.name)
        try:
            with zipfile.ZipFile(path) as archive:
                members = archive.infolist()
                size = sum(member.file_size for member in members)
                if len(members) > MOST_MEMBERS or size > MOST_BYTES:
                    raise DescriptionError(
                        f"{len(members)} members of {size} bytes are too many to unpack", file=path
                    )
                # Names that point out of the folder are changed to names within.
                archive.extractall(self.folder)
        except _DAMAGES as problem:
            self.close()
            raise DescriptionError(f"it cannot be unpacked: {problem}", file=path) from problem
        except DescriptionError:
            self.close()
            raise

    def close(self) -> None:
        """Remove what was unpacked."""
        self._temporary.cleanup()
