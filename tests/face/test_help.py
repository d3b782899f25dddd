"""`help(World)` and `help(world)` in a terminal of 80 columns and 24 lines, and what `dir` lists."""

from __future__ import annotations

import pydoc
import re
from collections.abc import Callable
from typing import Any

import carom
from carom.internal_names import INTERNAL

COLUMNS, LINES, SCREENS = 80, 24, 3


def rows_of(thing: Any) -> list[str]:
    """The rows that `help` fills on a terminal."""
    text = pydoc.plain(pydoc.render_doc(thing))
    return [
        line[at : at + COLUMNS] for line in text.splitlines() for at in range(0, max(len(line), 1), COLUMNS)
    ]


def names_for_users(it: Any) -> set[str]:
    return {name for name in dir(it) if name[0] != "_"}


def test_help_names_all_that_a_world_has_within_three_screens() -> None:
    world = carom.World()
    everything = names_for_users(world)
    assert len(everything) > 45
    for thing in (carom.World, world):
        named = set(re.findall(r"`(\w+)`", "".join(rows_of(thing)[: SCREENS * LINES])))
        assert everything - named - {"bodies"} == set()
    # Of a world that is all; of the class it goes on with what each does.
    assert len(rows_of(world)) < 2 * LINES


def test_help_and_dir_list_no_names_for_other_packages() -> None:
    listed = set(re.findall(r"^ \|  (\w+)(?=\(| = |$)", "\n".join(rows_of(carom.World)), re.MULTILINE))
    assert {"load", "step", "gravity"} <= listed
    assert listed & INTERNAL["World"] == set()
    assert names_for_users(carom.World) <= names_for_users(carom.World())
    # They are there nevertheless, for subclasses and for Carom itself.
    assert all(hasattr(carom.World, name) for name in ("load_all", "grow", "change_scene"))


def test_worlds_are_copied_with_their_help() -> None:
    made: list[Callable[[], carom.World]] = [carom.World, carom.World().copy]
    for make in made:
        assert (make().__doc__ or "").rstrip().endswith("help(carom.World) says more of each.")
