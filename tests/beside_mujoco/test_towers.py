"""Towers by the compliant law: an aligned one stands for ever, one off centre creeps as in MuJoCo."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.beside_mujoco.towers import COUNT, SECONDS, TIME_STEP, tower
from tests.converged.rigid_worlds import centres

from carom import World
from carom.scene.body import Body

_RECORDED = json.loads((Path(__file__).parent / "tower_answers.json").read_text())


def _tower(text: str) -> tuple[World, list[Body]]:
    world = World(contact="compliant")
    world.load(text).apply_options()
    return world, [world[f"b{i}"] for i in range(COUNT)]


@pytest.mark.parametrize("seconds", [10, pytest.param(600, marks=pytest.mark.long)])
def test_an_aligned_tower_stands(seconds: int) -> None:
    world, boxes = _tower(tower(share=0.0, time_step=1.0 / 240.0))
    world.step(240)
    start = centres(boxes)
    world.step(240 * (seconds - 1))
    assert np.abs(centres(boxes) - start).max() < 1e-9


@pytest.mark.parametrize("until", [1, pytest.param(2, marks=pytest.mark.long)])
@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_a_tower_off_centre_creeps_as_in_mujoco(cone: str, until: int) -> None:
    world, boxes = _tower(tower(cone))
    world.step(round(SECONDS[0] / TIME_STEP))
    start = centres(boxes)
    world.step(round((SECONDS[until] - SECONDS[0]) / TIME_STEP))
    expected = np.array(_RECORDED[cone][until - 1])
    farthest = np.linalg.norm(expected, axis=1).max()
    assert farthest > 1e-4
    assert np.abs(centres(boxes) - start - expected).max() < 1e-6 * farthest
