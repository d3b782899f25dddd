"""The corners of hulls, and where these touch a cylinder, against the recorded answers of PyBullet."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hull_cases import CORNERS, TOUCHING, touches

import pybullet as p

ANSWERS = json.loads(Path(__file__).with_name("hulls.json").read_text(encoding="utf-8"))

ROUNDING = 1e-12
ELSEWHERE = 1e-8
"""A contact this far away is another one [m]."""


@pytest.fixture(autouse=True)
def _world() -> None:
    p.connect(p.DIRECT)


def test_every_case_is_recorded() -> None:
    assert set(ANSWERS["corners"]) == set(CORNERS)
    assert set(ANSWERS["touches"]) == set(TOUCHING)


@pytest.mark.parametrize("name", CORNERS)
def test_corners_come_in_the_order_of_pybullet(name: str) -> None:
    ours, theirs = np.array(CORNERS[name](p)), np.array(ANSWERS["corners"][name])
    assert ours.shape == theirs.shape
    assert np.abs(ours - theirs).max() <= ROUNDING


@pytest.mark.parametrize("name", TOUCHING)
def test_a_hull_touches_a_cylinder_where_it_does_in_pybullet(name: str) -> None:
    for ours, theirs in zip(touches(p, name), ANSWERS["touches"][name], strict=True):
        assert np.array(ours).shape == np.array(theirs).shape
        if ours:
            assert np.abs(np.array(ours) - np.array(theirs)).max() <= ELSEWHERE
