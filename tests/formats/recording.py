"""What the recorders of PyBullet's answers have in common. Knows neither PyBullet nor Carom."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any


def plain(value: Any) -> Any:
    """Tuples as lists and bytes as text, as JSON has them."""
    if isinstance(value, bytes):
        return value.decode("utf-8")
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return value


def is_refused(load: Callable[[str], Any], error: type[Exception], text: str, scratch: Path) -> bool:
    """Whether loading a file raises an error.

    Args:
        load: Loads the file of a name.
        error: What it raises then.
        text: Content of the file.
        scratch: Where the file may be meanwhile.
    """
    scratch.write_text(text, encoding="utf-8")
    try:
        load(str(scratch))
    except error:
        return True
    finally:
        scratch.unlink()
    return False
