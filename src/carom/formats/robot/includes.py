"""Limits on the files that a file includes."""

from __future__ import annotations

from pathlib import Path

from carom.formats.robot.context import FileContext, shown
from carom.formats.xml_element import Element

MAX_INCLUDES = 512
"""Most files that one file may include, directly or through others."""

MAX_INCLUDE_DEPTH = 16
"""Deepest nesting of includes."""


class Includes:
    """Counts the files that one file includes, directly or through others."""

    def __init__(self) -> None:
        self._files = 0

    def admit(
        self,
        context: FileContext,
        element: Element,
        name: str,
        found: Path | None,
        including: tuple[Path, ...],
    ) -> Path:
        """The absolute path of an included file, `found` by the name that the `<include>` element states.

        `including` are the files by which it is included, outermost first.

        Raises:
            DescriptionError: There is no such file, it includes itself, or there are too many.
        """
        if found is None:
            raise context.not_found(element, name)
        file = found.absolute()
        if file in including:
            raise context.error(element, f"{shown(name)} includes itself")
        self._files += 1
        if self._files > MAX_INCLUDES or len(including) > MAX_INCLUDE_DEPTH:
            raise context.error(
                element, f"more than {MAX_INCLUDES} includes, or nested deeper than {MAX_INCLUDE_DEPTH}"
            )
        return file
