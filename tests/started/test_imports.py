"""Imports during which the garbage collector pauses."""

from __future__ import annotations

import gc
import subprocess
import sys

import pytest

from carom.imports import uncollected


@pytest.fixture(autouse=True)
def collector():
    collects = gc.isenabled()
    yield
    (gc.enable if collects else gc.disable)()


@pytest.mark.parametrize("collects", [True, False])
def test_the_collector_goes_on_as_before(collects):
    (gc.enable if collects else gc.disable)()
    assert uncollected(gc.isenabled) is False
    assert gc.isenabled() is collects
    with pytest.raises(ZeroDivisionError):
        uncollected(lambda: 1 / 0)
    assert gc.isenabled() is collects


def test_what_was_made_is_not_gone_through_as_young():
    made = uncollected(lambda: [[] for _ in range(5000)])
    assert len(gc.get_objects(generation=0)) < 5000
    assert gc.get_freeze_count() == 0
    assert gc.is_tracked(made)


def test_garbage_that_was_young_is_still_found():
    class Loop:
        found = 0

        def __del__(self) -> None:
            Loop.found += 1

    def tie() -> None:
        one = Loop()
        one.itself = one  # type: ignore[attr-defined]

    uncollected(tie)
    gc.collect()
    assert Loop.found == 1


def test_objects_that_a_user_has_frozen_stay_frozen():
    text = (
        "import gc\n"
        "gc.freeze()\n"
        "count = gc.get_freeze_count()\n"
        "import pybullet as p\n"
        "p.connect(p.DIRECT)\n"
        # Some of them are gone since.
        "assert gc.get_freeze_count() > 0.9 * count > 0, gc.get_freeze_count()\n"
        "assert gc.isenabled()\n"
    )
    subprocess.run([sys.executable, "-c", text], check=True)


def test_importing_pybullet_leaves_the_collector_as_it_was():
    text = "import gc\n{}\nimport pybullet\nassert gc.isenabled() is {}\nassert gc.get_freeze_count() == 0\n"
    for first, collects in (("", True), ("gc.disable()", False)):
        subprocess.run([sys.executable, "-c", text.format(first, collects)], check=True)
