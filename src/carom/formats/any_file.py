"""Reading robots from a file of any supported format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description import Robot
from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.xml_tree import parse_root
from carom.formats.kinds import FileKind, kind_of
from carom.formats.mjcf import read_mjcf
from carom.formats.placed import PlacedRobot
from carom.formats.reading.written import Written
from carom.formats.robot.file import locate
from carom.formats.sdf import read_sdf
from carom.formats.search import AssetSearch
from carom.formats.urdf import read_urdf
from carom.formats.urdf.reader import read_written_urdf

if TYPE_CHECKING:
    from carom.formats.usd.stage import Solids


def read_robots(
    source: Path, *, search: AssetSearch | None = None, solids: Callable[[], Solids] | None = None
) -> tuple[FileKind, list[PlacedRobot]]:
    """The format of an SDF, MJCF, URDF or USD file, by its content; all robots in it, and their poses.

    USD needs `solids`, as `carom.file_bodies.usd_solids` makes them.

    Raises:
        DescriptionError: The file cannot be used, or its format is not known.
    """
    search = search or AssetSearch()
    file = locate(source, search)
    with reading(file):
        kind = kind_of(file)
        if kind is FileKind.USD and solids is not None:
            from carom.formats.usd.reader import read_usd

            return kind, [robot.placed for robot in read_usd(file, solids())[0].robots]
        return _read(file, kind, search)


def _read(file: Path, kind: FileKind, search: AssetSearch) -> tuple[FileKind, list[PlacedRobot]]:
    match kind:
        case FileKind.SDF:
            return kind, read_sdf(file, search=search)
        case FileKind.MJCF:
            return kind, read_mjcf(file, colours=True, search=search)
        case FileKind.URDF:
            return kind, [PlacedRobot(_read_urdf(file, search))]
        case FileKind.USD:
            raise DescriptionError("USD is not read here; use World.load", file=file)
        case FileKind.SAVED_WORLD:
            raise DescriptionError("it is a saved world, and no robot file", file=file)


def _read_urdf(file: Path, search: AssetSearch) -> Robot:
    """The robot of a URDF file as PyBullet reads it, which knows no xacro; that is expanded here."""
    from carom.formats.xacro import is_xacro

    data, _ = read_bounded(file, "document_bytes")
    if is_xacro(parse_root(data, file, "robot"), file):
        packages = search.packages or ()
        search = AssetSearch(search.additional, search.folders, packages)
        return read_written_urdf(file, Written(), search=search)[0]
    return read_urdf(file, search=search)
