"""Tree of XML elements with their line numbers; its depth is limited, and the budget limits its size."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from carom.errors import DescriptionError
from carom.files.budget import BudgetError, excess, left

DOCTYPE_REFUSED = "document types with external or internal declarations (entities) are not accepted"
"""Error message for a document that declares entities."""

MAX_DEPTH = 100
"""Deepest nesting of elements."""


MAX_ATTRIBUTES = 1000
"""Most attributes of an element: they are copied where it is a default of others."""


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

    def note(self) -> None:
        """Note that a reader has used it, which only elements of a `carom.formats.reading.Cursor` keep."""

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
    """Builds the tree from a stream of start tags, end tags and text, and enforces the limits.

    Attributes:
        count: Number of elements, which whoever made it charges to the budget at the end.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self.roots: list[Element] = []
        self.open: list[Element] = []
        self._left = left("elements")
        self.count = 0
        self._chunks: list[str] = []

    def start(self, tag: str, attributes: dict[str, str], line: int) -> None:
        """Open an element, at its start tag."""
        element = Element(tag, attributes, line)
        self.count += 1
        if self.count > self._left:
            raise BudgetError(excess("elements"), file=self.file, line=line)
        if len(attributes) > MAX_ATTRIBUTES:
            raise self.error(f"<{tag[:60]}> has more than {MAX_ATTRIBUTES} attributes", line)
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
        """Close the innermost open element, at its end tag."""
        element = self.open.pop()
        if self._chunks:
            self._flush(element)

    def data(self, text: str) -> None:
        """Add character data."""
        self._chunks.append(text)

    def error(self, reason: str, line: int) -> DescriptionError:
        """An error at a line of this document."""
        return DescriptionError(reason, file=self.file, line=line)

    def _flush(self, owner: Element) -> None:
        if not owner.children:
            owner.text = "".join(self._chunks)
        self._chunks.clear()


class PlacedElement(Element):
    """An element of a document that is put together from several files.

    Attributes:
        file: The file that contains it.
        calls: Where the macros around it were called, the innermost first, as in
            `macro 'leg' called at robot.xacro:12`; empty outside macros.
    """

    __slots__ = ("calls", "file")

    def __init__(
        self, tag: str, attributes: dict[str, str], line: int, file: Path, calls: tuple[str, ...] = ()
    ) -> None:
        super().__init__(tag, attributes, line)
        self.file = file
        self.calls = calls

    @classmethod
    def of(cls, element: Element, file: Path) -> PlacedElement:
        """The same element, with all inside it, in a file."""
        placed = cls(element.tag, element.attributes, element.line, file)
        placed.text = element.text
        placed.children = [cls.of(child, file) for child in element.children]
        return placed


def from_calls(element: Element) -> str:
    """What an error message adds for an element that macros made: where they were called."""
    calls = getattr(element, "calls", ())
    return f" (in {', in '.join(calls)})" if calls else ""
