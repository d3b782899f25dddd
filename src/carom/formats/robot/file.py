"""Locating robot files, limits on what they include, and checks that all readers share."""

from __future__ import annotations

import os
from pathlib import Path

from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown
from carom.formats.search import AssetSearch, path_of
from carom.formats.shipped import advice
from carom.layouts.magnitudes import MAX_MAGNITUDE
from carom.logger import Logger

_log = Logger(__name__)

MAX_INCLUDE_DEPTH = 16
"""Deepest nesting of includes."""


def locate(path: Path, search: AssetSearch) -> Path:
    """The absolute path that `AssetSearch.find` finds; raises `DescriptionError` if there is none."""
    if str(path).lstrip().startswith("<"):
        raise DescriptionError("this is the text of a file, not its path: `World.load` takes texts as well")
    found = search.find(path)
    if found is None:
        raise DescriptionError(f"no such file: {path}{advice(path, search.places)}", file=path)
    return found if found.is_absolute() else path_of(os.path.join(os.getcwd(), found))


def check_scale(scale: float) -> None:
    """Raise `ValueError` unless a factor on lengths is positive and at most `MAX_MAGNITUDE`."""
    if not 0.0 < scale <= MAX_MAGNITUDE:
        raise ValueError(f"scale must be positive and finite, not {scale}")


def warn_of_assumed_masses(context: FileContext) -> None:
    """Log a warning that lists the links without `<inertial>`."""
    if context.links_without_inertial:
        names = ", ".join(context.links_without_inertial)
        _log.warning("%s: no <inertial>, so 1 kg is assumed, for %s", context.file, names)


class Includes:
    """Admits the files that one file includes, directly or through others."""

    @staticmethod
    def admit(
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
        charge("includes", file=context.file, line=element.line, element=f"<{element.tag}>")
        if len(including) > MAX_INCLUDE_DEPTH:
            raise context.error(element, f"includes are nested deeper than {MAX_INCLUDE_DEPTH}")
        return file
