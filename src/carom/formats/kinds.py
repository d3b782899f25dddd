"""Which format a robot file has, by its content."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum
from pathlib import Path

from carom.errors import DescriptionError
from carom.files.bounded import open_regular, read_bounded


class FileKind(Enum):
    """The formats of files that `World.load` tells apart."""

    URDF = "URDF"
    SDF = "SDF"
    MJCF = "MJCF"
    USD = "USD"
    SAVED_WORLD = "saved world"


_ROOTS = {
    "robot": FileKind.URDF,
    "sdf": FileKind.SDF,
    "gazebo": FileKind.SDF,
    "mujoco": FileKind.MJCF,
    "mujocoinclude": FileKind.MJCF,
}
_SAVED = b"\x89CAROM"
_USD = (b"PXR-USDC", b"#usda")
_ROBOT_SUFFIXES = (".urdf", ".sdf", ".world", ".xml", ".mjcf", ".xacro")
_START = 256
USD_SUFFIXES: tuple[str, ...] = (".usd", ".usda", ".usdc", ".usdz")
"""What names of USD stages end in."""
# What begins an element, or what is none and goes up to what closes it.
_MARKUP = re.compile(rb"<(?:(!--|\?|!)|\s*([A-Za-z_][\w:.-]*))")
_CLOSING = {b"!--": b"-->", b"?": b"?>", b"!": b">"}


def kind_of(file: Path) -> FileKind:
    """The format of a file, by its first bytes or its root element.

    Raises:
        DescriptionError: It cannot be read, or has none of these formats.
    """
    if file.suffix.lower() in USD_SUFFIXES:
        # They may be larger than what is read, and a .usdz file is an archive.
        return FileKind.USD
    data, _ = read_bounded(file, "document_bytes")
    if data.startswith(_SAVED):
        return FileKind.SAVED_WORLD
    if data.startswith(_USD):
        return FileKind.USD
    # Robot files in use have other elements beside the root.
    first = ""
    for name in _element_names(data):
        if name in _ROOTS:
            return _ROOTS[name]
        first = first or name
    what = f"its first element is <{first}>" if first else "it has no element"
    raise DescriptionError(
        f"{what}; a robot file begins with <robot> (URDF), <sdf> (SDF) or <mujoco> (MJCF)", file=file
    )


def _element_names(data: bytes) -> Iterator[str]:
    """The names of all elements, in order; comments, declarations and instructions are none."""
    at = 0
    open_ended: set[bytes] = set()
    while (match := _MARKUP.search(data, at)) is not None:
        opening, name = match.groups()
        at = match.end()
        if name is not None:
            yield name.decode("utf-8", errors="replace")
        elif opening not in open_ended:
            end = data.find(_CLOSING[opening], at)
            if end < 0:
                # Nor is any after it closed; looking again each time could take hours.
                open_ended.add(opening)
            else:
                at = end + len(_CLOSING[opening])


def is_robot_file(path: Path) -> bool:
    """Whether `World.load` takes a path for that of a robot file, not of a saved world.

    That is so for XML and USD, for suffixes of robot files, and for files that do not exist but as files of
    `pybullet_data`, which are found by their names.
    """
    by_suffix = path.suffix.lower() in (*_ROBOT_SUFFIXES, *USD_SUFFIXES)
    try:
        with open_regular(path)[0] as stream:
            start = stream.read(_START)
    except (OSError, ValueError, DescriptionError):
        return by_suffix
    if by_suffix or start.startswith(_SAVED):
        return not start.startswith(_SAVED)
    return start.startswith(_USD) or start.lstrip(b"\xef\xbb\xbf \t\r\n\0").startswith(b"<")
