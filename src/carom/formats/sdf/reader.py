"""An SDF file becomes robots, each with its place in the world."""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path

from carom.description.transform import compose
from carom.errors import DescriptionError
from carom.formats.files import read_bounded
from carom.formats.placed import PlacedRobot
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.model import read_model
from carom.formats.search import AssetSearch
from carom.formats.urdf.context import MAX_MAGNITUDE, shown
from carom.formats.urdf.reader import MAX_FILE_BYTES
from carom.formats.xml_tree import Element, parse_xml

_log = logging.getLogger(__name__)

MAX_INCLUDES = 512
"""Most files that one file may include, directly or through others."""

MAX_INCLUDE_DEPTH = 16
"""Deepest nesting of includes."""

_MODEL_FILE = "model.sdf"


def read_sdf(path: Path, *, scale: float = 1.0, search: AssetSearch | None = None) -> list[PlacedRobot]:
    """Reads and checks an SDF file.

    Only the first `<world>` counts, and where there is one, no model outside it. Lights, physics settings
    and plugins are left out.

    Args:
        path: The file; looked up with `AssetSearch.find`.
        scale: Factor on lengths: positions, boxes, cylinders, capsules and meshes, but as in PyBullet
            neither spheres nor limits.
        search: Where the file and what it refers to are looked for.

    Returns:
        The models of the world, in the order of the file.

    Raises:
        DescriptionError: The file is missing, broken, or holds a model that is not a tree of links.
        ValueError: `scale` is not a positive number of sensible size.
    """
    if not 0.0 < scale <= MAX_MAGNITUDE:
        raise ValueError(f"scale must be positive and finite, not {scale}")
    search = search or AssetSearch()
    found = search.find(path)
    if found is None:
        raise DescriptionError(f"no such file: {path}", file=path)
    return _Reading(scale, search).read(Path(found).absolute(), ())


class _Reading:
    """One file and all that it includes."""

    def __init__(self, scale: float, search: AssetSearch) -> None:
        self.scale = scale
        self.search = search
        self.included = 0

    def read(self, file: Path, including: tuple[Path, ...]) -> list[PlacedRobot]:
        """The robots of a file.

        Args:
            file: The file.
            including: The files by which it is included, outermost first.
        """
        data, _ = read_bounded(file, MAX_FILE_BYTES)
        root = next((element for element in parse_xml(data, file) if element.tag == "sdf"), None)
        if root is None:
            raise DescriptionError("there is no <sdf> element", file=file)
        context = SdfContext(file, root, self.scale, self.search)
        robots: list[PlacedRobot] = []
        for element in (root.first("world") or root).children:
            if element.tag == "model":
                robots += read_model(context, element)
            elif element.tag == "include":
                robots += self._include(context, element, (*including, file))
        if context.links_without_inertial:
            names = ", ".join(context.links_without_inertial)
            _log.warning("%s: no <inertial>, so 1 kg is assumed, for %s", file, names)
        return robots

    def _include(
        self, context: SdfContext, element: Element, including: tuple[Path, ...]
    ) -> list[PlacedRobot]:
        uri = context.text(element, "uri")
        if not uri:
            raise context.error(element, "<uri> is missing")
        file = _included_file(context, uri)
        if file is None:
            raise context.error(
                element, f"{shown(uri)} was found neither beside the file nor in a directory above it"
            )
        file = file.absolute()
        if file in including:
            raise context.error(element, f"{shown(uri)} includes itself")
        self.included += 1
        if self.included > MAX_INCLUDES or len(including) > MAX_INCLUDE_DEPTH:
            raise context.error(
                element, f"more than {MAX_INCLUDES} includes, or nested deeper than {MAX_INCLUDE_DEPTH}"
            )
        robots = self.read(file, including)
        name = context.text(element, "name")
        if name:
            robots = [replace(placed, robot=replace(placed.robot, name=name)) for placed in robots]
        if element.first("pose") is not None:
            pose = context.pose(element)
            # It takes the place of the model's own pose; several models keep their places to each other.
            robots = [
                replace(placed, pose=pose if len(robots) == 1 else compose(pose, placed.pose))
                for placed in robots
            ]
        return robots


def _included_file(context: SdfContext, uri: str) -> Path | None:
    """A file, or the model in a directory."""
    for name in (uri, f"{uri.rstrip('/')}/{_MODEL_FILE}"):
        file = context.find_file(name)
        if file is not None:
            return file
    return None
