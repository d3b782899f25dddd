"""The library `usd-core`, an extra that is imported when the first stage is read or written."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

from carom.errors import DescriptionError

_MISSING = "USD files need the library usd-core; install it with: pip install 'carom[usd]'"


class Library:
    """Modules of `pxr`, each imported when it is first asked for."""

    def __getattr__(self, name: str) -> Any:
        return import_module(f"pxr.{name}")


def library(file: Path) -> Library:
    """The library.

    Raises:
        DescriptionError: It is not installed; `file` is what needs it.
    """
    try:
        import_module("pxr.Usd")
    except ImportError as problem:
        raise DescriptionError(_MISSING, file=file) from problem
    return Library()
