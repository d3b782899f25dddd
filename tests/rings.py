"""Which tests `make test` runs, which run in `make test-all`, and which only in `make thorough`.

`make test` has everything that Carom promises, once. What varies numbers, compares with recordings at length,
or looks at the build and what is installed is *long*: single tests by the marker `long`, whole folders and
files by `LONG`. Both run with `--long`, and where they are named: an entry of the list, or a test with `::`.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
LONG: dict[str, str] = {
    "cluster": "starts Ray, on several nodes",
    "installation": "builds and installs wheels",
    "native/building": "builds libraries",
    "workers": "starts and ends processes for minutes",
}
"""Folders and files below `tests` of which every test is long, and why."""


def is_long(path: Path) -> bool:
    """Whether a file or folder is, or is in, one of `LONG`."""
    place = path.relative_to(TESTS)
    return any(str(part) in LONG for part in map(Path.as_posix, (place, *place.parents)))


def has_long_tests(file: Path) -> bool:
    """Whether a file of tests has some that are long."""
    return is_long(file) or "mark.long" in file.read_text(encoding="utf-8")


def names(argument: str, path: Path) -> bool:
    """Whether an argument of the command line names something long that a path is in, or leads to."""
    named = Path(argument.partition("::")[0]).resolve()
    return is_within(named, TESTS) and is_long(named) and (is_within(path, named) or is_within(named, path))


def is_within(path: Path, folder: Path) -> bool:
    """Whether a path is a folder or in it."""
    return path == folder or folder in path.parents


def left_out(config: pytest.Config, items: Iterable[pytest.Item]) -> list[pytest.Item]:
    """The tests of other rings than the one that runs."""
    if any("::" in argument for argument in config.args):
        return []
    rings = ["thorough", "long"]
    chosen = [ring for ring in rings if ring in config.option.markexpr]
    if config.option.long or "thorough" in chosen:
        chosen.append("long")
    return [
        item for item in items if any(item.get_closest_marker(ring) for ring in rings if ring not in chosen)
    ]
