"""Which tests `make test` runs, which run in `make test-all`, and which only in `make thorough`.

`make test` has everything that Carom promises, once. What varies numbers, compares with recordings at length,
or looks at the build and what is installed is *long*: single tests by the marker `long`, whole folders and
files by `LONG`. Both run with `--long`, and where they are named: an entry of the list, or a test with `::`.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

TESTS = Path(__file__).parent
LONG: dict[str, str] = {
    "cluster": "starts Ray, on several nodes",
    "installation": "builds and installs wheels",
    "memory/test_growth.py": "loads, resets and steps again and again",
    "memory/test_loops.py": "loops that must not take memory",
    "native/building/test_lanes.py": "builds libraries",
    "native/building/test_libm.py": "builds libraries",
    "native/building/test_library.py": "builds libraries",
    "gpu": "compiles the kernels of many worlds, and needs PyTorch",
    "gradients": "needs PyTorch or JAX",
    "vector/test_stable_baselines.py": "needs Stable-Baselines3",
    "viewer/graphics": "draws many pictures without a graphics card",
    "viewer/habits/test_dock.py": "opens a browser for each plot",
    "viewer/habits/test_endings.py": "starts scripts that end, and browsers",
    "viewer/habits/test_remembered.py": "loads pages again and again",
    "viewer/habits/test_runs.py": "starts one run after the other",
    "viewer/habits/test_shots.py": "films",
    "viewer/habits/test_small_things.py": "opens a page for each",
    "viewer/habits/test_spectator_page.py": "opens two pages for each",
    "viewer/habits/test_walking.py": "opens a page for each",
    "viewer/hands/test_teleoperation.py": "moves a robot in a browser",
    "viewer/hands/test_touch.py": "opens a page for each gesture",
    "viewer/looks": "looks at pictures of pages",
    "viewer/test_editors.py": "opens pages inside those of editors",
    "viewer/test_notebooks.py": "starts JupyterLab",
    "viewer/test_tutorial.py": "runs all tutorials",
    "worlds/test_dlpack.py": "needs PyTorch",
    "workers": "starts and ends processes for minutes",
}
"""Folders and files below `tests` of which every test is long, and why."""


def is_long(path: Path) -> bool:
    """Whether a file or folder is, or is in, one of `LONG`."""
    place = path.relative_to(TESTS)
    return any(str(part) in LONG for part in map(Path.as_posix, (place, *place.parents)))


def few(values: Iterable[Any], count: int) -> list[Any]:
    """Values of a parametrised test: so many of them, spread evenly, are for `make test`, the others long."""
    listed = list(values)
    short = {round(index * (len(listed) - 1) / max(1, count - 1)) for index in range(count)}
    return [value if index in short else _long(value) for index, value in enumerate(listed)]


def _long(value: Any) -> Any:
    if hasattr(value, "marks"):
        return pytest.param(*value.values, id=value.id, marks=[*value.marks, pytest.mark.long])
    values = value if isinstance(value, tuple) else (value,)
    return pytest.param(*values, marks=pytest.mark.long)


def has_long_tests(file: Path) -> bool:
    """Whether a file of tests has some that are long."""
    text = file.read_text(encoding="utf-8")
    return is_long(file) or "mark.long" in text or "few(" in text


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
