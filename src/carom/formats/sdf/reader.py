"""Reading an SDF file into robots and their world poses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from carom.description.transform import compose
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.formats.placed import PlacedRobot
from carom.formats.robot.context import shown
from carom.formats.robot.file import Includes, check_scale, locate, warn_of_assumed_masses
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.model import read_model
from carom.formats.search import AssetSearch

_MODEL_FILE = "model.sdf"


def read_sdf(
    path: Path,
    *,
    scale: float = 1.0,
    words_are_true: bool = True,
    search: AssetSearch | None = None,
) -> list[PlacedRobot]:
    """Reads and checks an SDF file, looked up with `AssetSearch.find`; models are in the order of the file.

    Only the first `<world>` is read; if there is one, models outside it are ignored. Lights, physics settings
    and plugins are ignored. `scale` is a factor on lengths: positions, boxes, cylinders, capsules and meshes,
    but as in PyBullet neither spheres nor limits. Without `words_are_true`, `<static>true</static>` means 0,
    as in PyBullet. `carom.formats.sdf.document` reads files as their authors mean them.

    Raises:
        DescriptionError: The file is missing, broken, or holds a model that is not a tree of links.
        ValueError: `scale` is not a positive number of sensible size.
    """
    check_scale(scale)
    search = search or AssetSearch()
    file = locate(path, search)
    with reading(file):
        return _Reading(scale, words_are_true, search).read(file, ())


class _Reading:
    """The reading of one file and of all files that it includes."""

    def __init__(self, scale: float, words_are_true: bool, search: AssetSearch) -> None:
        self.scale = scale
        self.words_are_true = words_are_true
        self.search = search
        self.includes = Includes()

    def read(self, file: Path, including: tuple[Path, ...]) -> list[PlacedRobot]:
        """The robots of a file; `including` are the files by which it is included, outermost first."""
        data, _ = read_bounded(file, "document_bytes")
        root = parse_root(data, file, "sdf")
        context = SdfContext(file, root, self.scale, self.search)
        context.words_are_true = self.words_are_true
        robots: list[PlacedRobot] = []
        for element in (root.first("world") or root).children:
            if element.tag == "model":
                robots += read_model(context, element)
            elif element.tag == "include":
                robots += self._include(context, element, (*including, file))
        warn_of_assumed_masses(context)
        return robots

    def _include(
        self, context: SdfContext, element: Element, including: tuple[Path, ...]
    ) -> list[PlacedRobot]:
        uri = context.text(element, "uri") or ""
        found = _included_file(context, uri)
        if found is None:
            # Worlds for Gazebo include models from Gazebo's own collection. PyBullet ignores all includes.
            context.warn(element, f"{shown(uri)} was not found; it is left out, as in PyBullet")
            return []
        file = self.includes.admit(context, element, uri, found, including)
        robots = self.read(file, including)
        name = context.text(element, "name")
        if name:
            robots = [replace(placed, robot=replace(placed.robot, name=name)) for placed in robots]
        if element.first("pose") is not None:
            pose = context.pose(element)
            # It replaces the pose of a single model; several models keep their poses relative to each other.
            robots = [
                replace(placed, pose=pose if len(robots) == 1 else compose(pose, placed.pose))
                for placed in robots
            ]
        return robots


def _included_file(context: SdfContext, uri: str) -> Path | None:
    """The file at a URI, or the model file in the directory at that URI."""
    for name in (uri, f"{uri.rstrip('/')}/{_MODEL_FILE}"):
        file = context.search.find_included(name, context.file)
        if file is not None:
            return file
    return None
