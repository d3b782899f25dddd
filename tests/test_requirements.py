"""What Carom requires, and the oldest versions of it that `make oldest` tests."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
OLDEST = ROOT / "tools" / "wheels" / "oldest.txt"


def _version(text: str) -> tuple[int, ...]:
    """A version as numbers, without zeros at its end."""
    return tuple(map(int, re.sub(r"(\.0)+$", "", text).split(".")))


def test_the_oldest_versions_that_are_allowed_are_those_that_are_tested():
    required = (
        (ROOT / "pyproject.toml").read_text("utf-8").partition("\ndependencies = [")[2].partition("\n]")[0]
    )
    bounds = {name: _version(least) for name, least in re.findall(r'"(\w+)>=([\d.]+)', required)}
    tested: dict[str, list[tuple[int, ...]]] = {}
    for name, version in re.findall(r"^(\w+)==([\d.]+)", OLDEST.read_text("utf-8"), re.MULTILINE):
        tested.setdefault(name, []).append(_version(version))
    assert {name: min(versions) for name, versions in tested.items()} == bounds
