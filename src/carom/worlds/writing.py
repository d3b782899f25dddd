"""Writing to the arrays of many worlds so that Ctrl-C comes before all of it or after all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def assign(*writes: tuple[Any, Any, Any]) -> None:
    """Write to arrays: arrays, indices and values. Ctrl-C in a section comes before all or after all."""
    to_the_end(lambda: [array.__setitem__(place, values) for array, place, values in writes])


def to_the_end(write: Callable[[], object]) -> None:
    """Do what can be repeated, in a section: Ctrl-C comes before or after it."""
    try:
        write()
    except BaseException:
        write()
        raise
