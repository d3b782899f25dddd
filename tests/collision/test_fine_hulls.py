"""Fine hulls roll, tumble and walk as in PyBullet, to the tenth of a millimetre."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.collision.fine_hulls import GROUNDS, HULLS, roll, walk

import pybullet as p

RECORDED = json.loads((Path(__file__).parent / "fine_hulls.json").read_text())
CLOSE = 1e-4


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def _is_recorded(found: list[list[float]], name: str) -> None:
    ours, theirs = np.array(found), np.array(RECORDED[name])
    assert np.abs(ours[:, 1:] - theirs[:, 1:]).max() < CLOSE
    assert np.abs(ours[:, 0] - theirs[:, 0]).max() <= 1


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("hull", HULLS)
def test_a_hull_rolls(hull: str, ground: str) -> None:
    _is_recorded(roll(p, hull, ground), f"{hull} on {ground}")


def test_a_quadruped_with_finely_rounded_feet_walks() -> None:
    _is_recorded(walk(p), "walk")
