"""State that all parts of the URDF reader share."""

from __future__ import annotations

from pathlib import Path

from carom.description import Material
from carom.formats.robot.context import FileContext
from carom.formats.search import AssetSearch
from carom.formats.xml_element import Element


class UrdfContext(FileContext):
    """State of one reading; its root is the `<robot>` element.

    Attributes:
        materials: The materials read so far, by name.
    """

    def __init__(self, file: Path, root: Element, scale: float, search: AssetSearch) -> None:
        super().__init__(file, root, scale, search)
        self.materials: dict[str, Material] = {}
