"""An MJCF document with all that it includes."""

from __future__ import annotations

from pathlib import Path

from carom.files.bounded import read_bounded
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.formats.mjcf.context import MjcfContext
from carom.formats.reading.cursor import Cursor, TracedElement
from carom.formats.robot.file import Includes

_ROOTS = ("mujoco", "mujocoinclude")
# Those that state options, and `<default>`, count in their order, also for MuJoCo.
_MERGED = (
    "worldbody", "asset", "actuator", "sensor", "contact", "equality", "tendon", "deformable", "keyframe",
    "visual", "custom", "extension",
)  # fmt: skip


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


def merge_sections(context: MjcfContext) -> None:
    """Make one section of all of a name, in the order of the document, whose includes are expanded.

    MuJoCo lets sections appear several times, as where a scene adds a floor to a robot that it includes; they
    are one section for it. A section that has attributes stays, without what was in it, so that these are
    reported. What states options, and `<default>`, is left as it is: of several, all are read in order.
    """
    firsts: dict[str, Element] = {}
    kept: list[Element] = []
    for section in context.root.children:
        first = firsts.setdefault(section.tag, section)
        if first is section or section.tag not in _MERGED:
            kept.append(section)
            continue
        file = context.origins.get(id(section), context.file)
        for child in section.children:
            context.origins.setdefault(id(child), file)
        first.children += section.children
        section.children = []
        if section.attributes:
            kept.append(section)
        else:
            # Another element may get its id.
            context.origins.pop(id(section), None)
    context.root.children = kept
