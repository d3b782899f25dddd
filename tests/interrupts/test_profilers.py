"""Profilers see what a script calls, and stay on."""

from __future__ import annotations

import cProfile
import pstats
import sys
from typing import Any

import pybullet as p
import pybullet_data


def work() -> None:
    """Calls of all kinds of conduct."""
    p.connect(p.DIRECT)
    try:
        p.loadURDF(f"{pybullet_data.getDataPath()}/r2d2.urdf")
        p.saveState()
        p.stepSimulation()
        p.getLinkStates(0, [1, 2])
    finally:
        p.disconnect()


def after() -> None:
    """Called when all is done."""


def test_cprofile_goes_on_through_calls() -> None:
    profile = cProfile.Profile()
    profile.enable()
    work()
    after()
    profile.disable()
    names = {name for _, _, name in pstats.Stats(profile).stats}  # type: ignore[attr-defined]
    assert {"work", "after", "loadURDF"} <= names


def test_a_profile_function_goes_on_and_sees_no_half_of_a_change() -> None:
    seen: set[str] = set()

    def note(frame: Any, event: str, _argument: object) -> None:
        seen.add(frame.f_code.co_name)

    sys.setprofile(note)
    try:
        work()
        after()
        assert sys.getprofile() is note
    finally:
        sys.setprofile(None)
    assert {"work", "after"} <= seen
