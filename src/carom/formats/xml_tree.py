"""XML as a small tree that remembers line numbers, from untrusted files and in bounded time.

Well-formed documents go through expat. What expat refuses goes to the tolerant reader in `xml_tolerant`,
because robot files in the wild are sloppy.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.parsers import expat

from carom.errors import DescriptionError

MAX_DEPTH = 100
"""Deepest nesting of elements."""

MAX_ELEMENTS = 200_000
"""Most elements in one document."""


class Element:
    """An element of an XML document.

    Attributes:
        tag: Name.
        attributes: Attribute values by name, entities replaced.
        line: Line of the start tag, counted from 1.
        children: Child elements in document order.
        text: Character data before the first child element.
    """

    __slots__ = ("attributes", "children", "line", "tag", "text")

    def __init__(self, tag: str, attributes: dict[str, str], line: int) -> None:
        self.tag: str = tag
        self.attributes: dict[str, str] = attributes
        self.line: int = line
        self.children: list[Element] = []
        self.text: str = ""

    def first(self, tag: str) -> Element | None:
        """The first child of that name."""
        for child in self.children:
            if child.tag == tag:
                return child
        return None

    def all(self, tag: str) -> Iterator[Element]:
        """Every child of that name, in order."""
        return (child for child in self.children if child.tag == tag)

    def path_to(self, target: Element) -> list[Element]:
        """The elements from this one down to `target`, both included; empty where it is not inside."""
        if target is self:
            return [self]
        for child in self.children:
            below = child.path_to(target)
            if below:
                return [self, *below]
        return []


class TreeBuilder:
    """Grows the tree from a stream of start tags, end tags and text, and keeps it within bounds."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.roots: list[Element] = []
        self.open: list[Element] = []
        self._count = 0
        self._chunks: list[str] = []

    def start(self, tag: str, attributes: dict[str, str], line: int) -> None:
        """A start tag."""
        element = Element(tag, attributes, line)
        self._count += 1
        if self._count > MAX_ELEMENTS:
            raise self.error(f"more than {MAX_ELEMENTS} elements", line)
        if len(self.open) >= MAX_DEPTH:
            raise self.error(f"elements nested deeper than {MAX_DEPTH}", line)
        if self.open:
            parent = self.open[-1]
            if self._chunks:
                self._flush(parent)
            parent.children.append(element)
        else:
            self.roots.append(element)
        self.open.append(element)

    def end(self) -> None:
        """The end tag of the innermost open element."""
        element = self.open.pop()
        if self._chunks:
            self._flush(element)

    def data(self, text: str) -> None:
        """Character data."""
        self._chunks.append(text)

    def error(self, reason: str, line: int) -> DescriptionError:
        """An error at a line of this document."""
        return DescriptionError(reason, file=self.file, line=line)

    def _flush(self, owner: Element) -> None:
        if not owner.children:
            owner.text = "".join(self._chunks)
        self._chunks.clear()


def parse_xml(data: bytes, file: Path) -> list[Element]:
    """Reads a document.

    Entity declarations and external entities are refused; nothing but `data` is ever read.

    Args:
        data: Content of the file, in UTF-8, or in Latin-1 where it is not.
        file: Named in errors.

    Returns:
        The elements at the top level: one for a well-formed document, perhaps more for a sloppy one.

    Raises:
        DescriptionError: The document is broken beyond what PyBullet reads, or out of bounds.
    """
    if not data.strip():
        raise DescriptionError("the file is empty", file=file)
    # PyBullet takes a stray NUL for a line end, and robot files with one are in use.
    data = data.replace(b"\0", b" ")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    builder = TreeBuilder(file)
    try:
        _run_expat(text, builder)
    except expat.ExpatError:
        from carom.formats.xml_tolerant import read_tolerantly

        builder = TreeBuilder(file)
        read_tolerantly(text, builder)
    return builder.roots


def parse_root(data: bytes, file: Path, *tags: str) -> Element:
    """The element of a document that has one of these names.

    Raises:
        DescriptionError: There is none, or the document is broken.
    """
    root = next((element for element in parse_xml(data, file) if element.tag in tags), None)
    if root is None:
        raise DescriptionError(f"there is no <{tags[0]}> element", file=file)
    return root


def _run_expat(text: str, builder: TreeBuilder) -> None:
    # The text is decoded already: an encoding named in the declaration must not be applied again.
    parser = expat.ParserCreate("utf-8")
    parser.buffer_text = True
    parser.buffer_size = 1 << 16

    def start(tag: str, attributes: dict[str, str]) -> None:
        builder.start(tag, attributes, parser.CurrentLineNumber)

    def end(_tag: str) -> None:
        builder.end()

    def doctype(_name: str, system_id: str | None, public_id: str | None, has_subset: int) -> None:
        if system_id or public_id or has_subset:
            raise builder.error(DOCTYPE_REFUSED, parser.CurrentLineNumber)

    def entity(*_declaration: Any) -> None:
        raise builder.error(DOCTYPE_REFUSED, parser.CurrentLineNumber)

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = builder.data
    parser.StartDoctypeDeclHandler = doctype
    parser.EntityDeclHandler = entity
    parser.Parse(text.encode("utf-8"), True)


DOCTYPE_REFUSED = "document types with external or internal declarations (entities) are not accepted"
