"""Calls that change the scene are made as a whole or not at all, wherever an exception breaks them off."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy
from pathlib import Path

import pytest
from tests.interrupts.faults import Fault, Fuse
from tests.interrupts.scenes import CALLS, build, differences, follow, look
from tests.rings import few

import pybullet as p

# Of the instructions of a call, so many are tried, the same ones each time.
_TRIED = 12


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    number = p.connect(p.DIRECT)
    yield tmp_path_factory.mktemp("interrupts")
    p.disconnect(number)


@pytest.mark.parametrize("name", few(CALLS, 8))
def test_a_call_that_is_broken_off_is_done_or_not_begun(name: str, folder: Path) -> None:
    try_places(name, folder, _TRIED)


def _break_off(call: Callable[[], object], place: int) -> str:
    """Returns at which line it was; nothing where the call needed fewer instructions than the last time."""
    fuse = Fuse(place)
    try:
        fuse.blow(call)
    except Fault:
        return fuse.where
    assert not fuse.where, f"the fault at {fuse.where} came to nothing"
    return ""


def try_places(name: str, folder: Path, tried: int) -> tuple[int, int]:
    """Breaks a call off at so many places; returns how often it was not begun and how often done."""
    call = CALLS[name]
    build(folder)
    before, follows_before = deepcopy(look()), follow()
    # The second time files and shapes are known already, so that what is counted is what is tried.
    call(build(folder))
    scene, fuse = build(folder), Fuse()
    fuse.blow(lambda: call(scene))
    after, follows_after = deepcopy(look()), follow()
    not_begun = done = 0
    for index in range(tried):
        place = 1 + index * fuse.count // tried
        scene = build(folder)
        assert not differences(look(), before)
        where = _break_off(lambda: call(scene), place)  # noqa: B023 (it is called at once)
        if not where:
            continue
        seen = look()
        if not differences(seen, before):
            not_begun += 1
            assert follow() == follows_before, f"at {where}"
        else:
            done += 1
            found = differences(seen, after)
            assert not found, f"at {where}: {found[:10]}"
            assert follow() == follows_after, f"at {where}"
    assert not_begun
    return not_begun, done
