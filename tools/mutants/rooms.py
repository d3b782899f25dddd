"""The rooms of the house that mutants are drawn from."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from tools.mutants.change import Change
from tools.mutants.copies import ROOT
from tools.mutants.python_changes import python_changes
from tools.mutants.text_changes import text_changes

CHANGES: dict[str, Callable[[str], Iterator[Change]]] = {
    ".py": python_changes,
    ".cpp": text_changes,
    ".h": text_changes,
    ".js": text_changes,
}
"""What is changed in files, by their suffixes."""
_LANGUAGES = {".cpp": "C++", ".h": "C++", ".js": "JavaScript"}
# Assets, scripts that nobody runs but to look at them, and what only `make cluster` tests, with Ray.
_LEFT_OUT = ("src/pybullet_data/", "src/pybullet_examples/", "src/carom/cluster/")


def room_of(file: str) -> str:
    """The room of a file: its language if it isn't Python, else its package."""
    language = _LANGUAGES.get(Path(file).suffix)
    if language is not None:
        return language
    _, top, *below = file.split("/")
    return below[0] if top == "carom" and len(below) > 1 else top


def rooms() -> dict[str, list[str]]:
    """The files of each room, by their paths from the root."""
    found: dict[str, list[str]] = {}
    for path in sorted((ROOT / "src").rglob("*")):
        file = path.relative_to(ROOT).as_posix()
        if path.suffix in CHANGES and not file.startswith(_LEFT_OUT):
            found.setdefault(room_of(file), []).append(file)
    return dict(sorted(found.items()))
