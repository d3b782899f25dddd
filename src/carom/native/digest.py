"""The digest of the sources of the native library.

A library contains the digest of its sources. It fits the present sources if they have the same digest, so
in a clone this digest is needed at every start. It is computed from the files' contents alone.
"""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ["blake2b", "source_digest"]

try:
    # `hashlib` would import OpenSSL, which takes as long to load as all the rest.
    from _blake2 import blake2b
except ImportError:
    from hashlib import blake2b

_DIGEST_BYTES = 16
# Kernels, the data structures that they share with Python, the build code, and C and C++ sources; also of the
# folders in each.
_FOLDERS = (
    "carom/kernels",
    "carom/layouts",
    "carom/native/building",
    "carom/native/source",
)
_SUFFIXES = (".c", ".cpp", ".h", ".py")


def source_digest(root: Path) -> str:
    """Digest of all sources of the native library, in the folder that contains the package `carom`.

    Returns:
        32 hexadecimal digits; line endings make no difference.

    Raises:
        OSError: A folder is missing, or a file cannot be read.
    """
    # Wheels need no digest.
    from binascii import crc32

    digest = blake2b(digest_size=_DIGEST_BYTES)
    rooms = [
        f"{folder}/{entry.name}"
        for folder in _FOLDERS
        for entry in os.scandir(root / folder)
        if entry.is_dir() and entry.name != "__pycache__"
    ]
    for folder in (*_FOLDERS, *sorted(rooms)):
        for name in sorted(os.listdir(root / folder)):
            if name.endswith(_SUFFIXES):
                content = _read(f"{root}/{folder}/{name}")
                # BLAKE2 of all contents would take 20 million instructions more at every start. The digest
                # notices edits; it is no defence against anyone.
                digest.update(f"{folder}/{name}\n{len(content)} {crc32(content)}\n".encode())
    return digest.hexdigest()


def _read(path: str) -> bytes:
    with open(path, "rb") as file:
        content = file.read()
    return content.replace(b"\r\n", b"\n") if b"\r" in content else content
