"""An MJCF document with all that it includes."""

from __future__ import annotations

from pathlib import Path

from carom.formats.files import read_bounded
from carom.formats.mjcf.context import MjcfContext
from carom.formats.reading.cursor import Cursor, TracedElement
from carom.formats.robot.file import Includes
from carom.formats.xml_element import Element
from carom.formats.xml_tree import parse_root

_ROOTS = ("mujoco", "mujocoinclude")


def read_root(file: Path, cursor: Cursor | None) -> Element:
    """The root of a document, which a cursor traces if there is one; raises `DescriptionError`."""
    data, _ = read_bounded(file, "document_bytes")
    root = parse_root(data, file, *_ROOTS)
    return root if cursor is None else cursor.trace(root, file)


class Inclusion:
    """Replaces `<include>` elements by the content of the files they include."""

    def __init__(self, context: MjcfContext, cursor: Cursor | None) -> None:
        self.context = context
        self.cursor = cursor
        self.includes = Includes()

    def expand(self, parent: Element, file: Path, including: tuple[Path, ...]) -> None:
        """Replaces every `<include>` below an element; `including` are its file and those around that."""
        children: list[Element] = []
        for child in parent.children:
            if child.tag != "include":
                self.expand(child, file, including)
                children.append(child)
                continue
            other = self._file(child, file, including)
            root = read_root(other, self.cursor)
            self.expand(root, other, (*including, other))
            for element in root.children:
                self.context.origins.setdefault(id(element), other)
            children += root.children
            if isinstance(root, TracedElement):
                # From now on they are reported below the element that includes them.
                root.children = []
        parent.children = children

    def _file(self, element: Element, file: Path, including: tuple[Path, ...]) -> Path:
        name = self.context.required(element, "file")
        found = self.context.search.find_referenced(name, file)
        return self.includes.admit(self.context, element, name, found, including)
