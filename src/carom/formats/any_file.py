"""Reading robots from a file of any supported format."""

from __future__ import annotations

from pathlib import Path

from carom.errors import DescriptionError
from carom.formats.mjcf import read_mjcf
from carom.formats.placed import PlacedRobot
from carom.formats.sdf import read_sdf
from carom.formats.search import AssetSearch
from carom.formats.urdf import read_urdf

MJCF_SUFFIXES = (".xml", ".mjcf")


def read_robots(source: Path, *, search: AssetSearch | None = None) -> list[PlacedRobot]:
    """All robots of an SDF, MJCF (`.xml` or `.mjcf`) or URDF file, and their poses.

    Raises:
        DescriptionError: The file cannot be used, or its format is not known.
    """
    match source.suffix.lower():
        case ".sdf" | ".world":
            return read_sdf(source, search=search)
        case suffix if suffix in MJCF_SUFFIXES:
            return read_mjcf(source, colours=True, search=search)
        case ".urdf":
            return [PlacedRobot(read_urdf(source, search=search))]
        case suffix:
            raise DescriptionError(
                f"files of type {suffix!r} are not known; known are .sdf, .world, .xml, .mjcf and .urdf",
                file=source,
            )
