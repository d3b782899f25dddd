"""Drawings go with a reset of the world, at once with everything else."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from tests.interrupts.faults import Fault, Fuse
from tests.interrupts.test_prepared_changes import at_lines

import pybullet as p
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow

# Of the instructions of a call, so many are tried.
_TRIED = 40


@pytest.fixture
def window(monkeypatch: pytest.MonkeyPatch) -> Iterator[PageWindow]:
    """A window that no browser shows."""
    monkeypatch.setenv("CI", "true")
    number = p.connect(p.GUI, options="--port=0")
    window = clients[number].window
    assert isinstance(window, PageWindow)
    yield window
    p.disconnect(number)


def _draw() -> None:
    p.removeAllUserDebugItems()
    p.resetSimulation()
    p.createMultiBody(1.0)
    p.addUserDebugLine([0, 0, 0], [0, 0, 1])
    p.addUserDebugText("here", [0, 0, 1], lifeTime=100.0)


def _seen(window: PageWindow) -> tuple[Any, ...]:
    return p.getNumBodies(), len(window.items), window._next_item


def _told(window: PageWindow) -> list[int]:
    """The items that a page which joins now is told of."""
    return [number for number in range(9) if window.viewer._latest.holds(("item", number))]


def test_a_reset_that_is_broken_off_has_removed_all_drawings_or_none(window: PageWindow) -> None:
    _draw()
    fuse = Fuse()
    fuse.blow(p.resetSimulation)
    not_begun = 0
    for index in range(_TRIED):
        _draw()
        before = _seen(window)
        assert before == (1, 2, 2)
        try:
            Fuse(1 + index * fuse.count // _TRIED).blow(p.resetSimulation)
        except Fault:
            now = _seen(window)
            not_begun += now == before
            assert now in (before, (0, 0, 0))
            # The next frame tells pages what this could not.
            window.viewer.drawings.expire()
            assert _told(window) == ([0, 1] if now == before else [])
        else:
            assert _seen(window) == (0, 0, 0)
            assert _told(window) == []
        assert p.addUserDebugLine([0, 0, 0], [0, 0, 1]) == len(window.items) - 1
    assert not_begun


def test_whoever_looks_at_any_line_of_a_reset_sees_drawings_and_bodies_or_neither(window: PageWindow) -> None:
    _draw()
    p.resetSimulation()
    _draw()
    world, found = clients[0].world, list[tuple[int, ...]]()

    def look() -> None:
        now = len(world.bodies), len(window.items), window._next_item
        if not found or found[-1] != now:
            found.append(now)

    at_lines(p.resetSimulation, look)
    look()
    assert found == [(1, 2, 2), (0, 0, 0)]
