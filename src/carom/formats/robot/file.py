"""Locating robot files, and checks that all readers share."""

from __future__ import annotations

import os
from pathlib import Path

from carom.errors import DescriptionError
from carom.formats.robot.context import MAX_MAGNITUDE, FileContext
from carom.formats.search import AssetSearch, path_of
from carom.formats.shipped import advice
from carom.logger import Logger

_log = Logger(__name__)

MAX_FILE_BYTES = 16 << 20
"""Largest robot file that is read."""


def locate(path: Path, search: AssetSearch) -> Path:
    """The absolute path that `AssetSearch.find` finds; raises `DescriptionError` if there is none."""
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
