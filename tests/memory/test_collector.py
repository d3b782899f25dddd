"""Python's garbage collector is the user's: what it is told, and when it runs, is left to them."""

from __future__ import annotations

import ast
import gc
import re
from collections.abc import Callable
from pathlib import Path
from weakref import ref

import pytest

import carom
import pybullet as p

SOURCE = Path(__file__).parents[2] / "src"
# Changes pause collection for some microseconds, so that no finalizer meets half of one; and go on with it
# only if the user had it on.
EXPECTED = {"carom/native/uninterrupted.py": {"isenabled", "disable", "enable"}}
LOOPS = 100


class Loop:
    def __init__(self) -> None:
        self.itself = self


def _uses(file: Path) -> set[str]:
    """What a module takes from `gc`."""
    uses: set[str] = set()
    text = file.read_text(encoding="utf-8")
    # Most modules need not be parsed.
    for node in ast.walk(ast.parse(text if re.search(r"\bgc\b", text) else "")):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "gc":
            uses.add(node.attr)
        elif isinstance(node, ast.ImportFrom) and node.module == "gc":
            uses |= {name.name for name in node.names}
        elif isinstance(node, ast.Import):
            uses |= {f"as {name.asname}" for name in node.names if name.name == "gc" and name.asname}
    return uses


def test_nothing_touches_the_collector_but_changes() -> None:
    used = {file.relative_to(SOURCE).as_posix(): _uses(file) for file in SOURCE.rglob("*.py")}
    assert {file: uses for file, uses in used.items() if uses} == EXPECTED
    native = [file.name for file in SOURCE.rglob("*.cpp") if "PyGC_" in file.read_text(encoding="utf-8")]
    assert native == []


def _connect() -> None:
    p.disconnect(p.connect(p.DIRECT))


def _look_at_world() -> None:
    carom.World  # noqa: B018


@pytest.mark.parametrize("work", [_connect, _look_at_world, carom.World])
def test_cycles_of_users_are_collected_meanwhile(work: Callable[[], object]) -> None:
    work()
    made: list[ref[Loop]] = []
    threshold = gc.get_threshold()
    gc.set_threshold(100)
    try:
        for _ in range(LOOPS):
            made.append(ref(Loop()))
            work()
            # Objects that stay, as those of scripts do, make collections due.
            made += [ref(Loop()) for _ in range(10)]
    finally:
        gc.set_threshold(*threshold)
    assert sum(one() is not None for one in made) < len(made) / 2


def test_names_are_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    assert carom.Worlds is carom.Worlds
    monkeypatch.setattr(carom, "__getattr__", None)
    assert carom.Worlds.__name__ == "Worlds"
    assert {"World", "Worlds", "control"} <= set(dir(carom))
