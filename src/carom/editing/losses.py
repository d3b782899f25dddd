"""What a format cannot say of a description, gathered while it is written."""

from __future__ import annotations

from pathlib import Path

from carom.editing.elements import file_of
from carom.files.xml_element import Element
from carom.formats.reading.ignored import Ignored, IgnoredList


class Losses:
    """A list of what is lost, with places in the file that something came from.

    Args:
        file: The file where nothing else is known.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self._found: list[Ignored] = []

    def add(
        self, element: str, consequence: str, reason: str, *attributes: str, of: Element | None = None
    ) -> None:
        """Note what is lost with an element, written as `joint/mimic`, or with attributes of it."""
        file, line = (self.file, 1) if of is None or not of.line else (file_of(of), of.line)
        self._found.append(Ignored(element, file, line, attributes, 1, consequence, reason))

    def list(self) -> IgnoredList:
        """All of it, equal entries together."""
        return IgnoredList.of(self._found)
