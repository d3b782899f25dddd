"""Which format a robot file has, by its content."""

from __future__ import annotations

import re
from enum import Enum
from pathlib import Path

from carom.errors import DescriptionError
from carom.formats.files import read_bounded
from carom.formats.robot.file import MAX_FILE_BYTES


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
_USD_SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")
_NO_ELEMENT = re.compile(rb"<!--.*?-->|<\?.*?\?>|<![^>]*>", re.DOTALL)
_ROOT = re.compile(rb"<\s*([A-Za-z_][\w:.-]*)")


def kind_of(file: Path) -> FileKind:
    """The format of a file, by its first bytes or its root element.

    Raises:
        DescriptionError: It cannot be read, or has none of these formats.
    """
    if file.suffix.lower() in _USD_SUFFIXES:
        # They may be larger than what is read, and a .usdz file is an archive.
        return FileKind.USD
    data, _ = read_bounded(file, MAX_FILE_BYTES)
    if data.startswith(_SAVED):
        return FileKind.SAVED_WORLD
    if data.startswith(_USD):
        return FileKind.USD
    names = [match.group(1).decode() for match in _ROOT.finditer(_NO_ELEMENT.sub(b"", data))]
    # Robot files in use have other elements beside the root.
    found = next((name for name in names if name in _ROOTS), None)
    if found is not None:
        return _ROOTS[found]
    what = f"its first element is <{names[0]}>" if names else "it has no element"
    raise DescriptionError(
        f"{what}; a robot file begins with <robot> (URDF), <sdf> (SDF) or <mujoco> (MJCF)", file=file
    )


def is_robot_file(path: Path) -> bool:
    """Whether `World.load` takes a path for that of a robot file, not of a saved world.

    That is so for XML and USD, for suffixes of robot files, and for files that do not exist but as files of
    `pybullet_data`, which are found by their names.
    """
    by_suffix = path.suffix.lower() in (*_ROBOT_SUFFIXES, *_USD_SUFFIXES)
    try:
        with open(path, "rb") as stream:
            start = stream.read(_START)
    except (OSError, ValueError):
        return by_suffix
    if by_suffix or start.startswith(_SAVED):
        return not start.startswith(_SAVED)
    return start.startswith(_USD) or start.lstrip(b"\xef\xbb\xbf \t\r\n\0").startswith(b"<")


def refuse_usd(file: Path) -> DescriptionError:
    """The error for a USD file."""
    return DescriptionError(
        "USD files are not read yet; convert it to URDF or MJCF first, for example with Isaac Sim's exporter",
        file=file,
    )
