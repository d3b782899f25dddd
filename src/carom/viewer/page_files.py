"""The files of the page."""

from __future__ import annotations

from functools import cache
from pathlib import Path

_PAGE = Path(__file__).with_name("page")
_KINDS = frozenset({".html", ".css", ".js", ".svg"})


@cache
def page_files() -> dict[str, bytes]:
    """Content of every file of the page, by its path relative to the page's address."""
    return {
        path.relative_to(_PAGE).as_posix(): path.read_bytes()
        for path in sorted(_PAGE.rglob("*"))
        if path.suffix in _KINDS
    }
