"""Zip archives, unpacked into a temporary folder while they are in use."""

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
"""Limits on unpacked size and number of members, against archives made to fill discs (zip bombs)."""

# Exceptions that damaged archives cause. RuntimeError: the archive is encrypted, or zipfile does not know its
# compression method. The decompressors raise the last three.
_DAMAGES = (
    OSError, ValueError, RuntimeError, zipfile.BadZipFile, struct.error, EOFError, zlib.error, lzma.LZMAError
)  # fmt: skip


class Archive:
    """A zip file, unpacked for as long as it is in use.

    Attributes:
        path: The file.
        folder: The temporary folder that contains its members.

    Raises:
        DescriptionError: The file is missing, damaged, encrypted or too large.
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
                # `extractall` changes member names that point outside the folder.
                archive.extractall(self.folder)
        except _DAMAGES as problem:
            self.close()
            raise DescriptionError(f"it cannot be unpacked: {problem}", file=path) from problem
        except DescriptionError:
            self.close()
            raise

    def close(self) -> None:
        """Delete the temporary folder."""
        self._temporary.cleanup()
