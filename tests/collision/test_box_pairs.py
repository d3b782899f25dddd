"""Two boxes touch in PyBullet's points, in PyBullet's order; stacks of them move as there, to rounding."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.box_pairs import (
    DROPS,
    STACKS,
    aligned_pairs,
    build_cubes,
    build_stack,
    follow,
    points,
    tilted_pairs,
)

import pybullet as p
from pybullet._clients.clients import client_of

RECORDED = json.loads((Path(__file__).parent / "box_pairs.json").read_text())


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


@pytest.mark.parametrize("pairs", [aligned_pairs(), tilted_pairs()], ids=["aligned", "tilted"])
def test_two_boxes_touch_in_the_recorded_points(pairs: dict[str, tuple]) -> None:
    touching = 0
    for name, boxes in pairs.items():
        found, recorded = np.array(points(p, boxes)), np.array(RECORDED[name])
        assert found.shape == recorded.shape, name
        assert_allclose(found, recorded, atol=1e-9, err_msg=name)
        touching += len(found) > 0
    assert touching > 0.5 * len(pairs)


@pytest.mark.parametrize("seed", STACKS)
def test_a_stack_of_turned_boxes_moves_as_recorded(seed: int) -> None:
    bodies = build_stack(p, seed)
    client_of(0).world.parameters.contact_warm_starting = 0.0
    assert_allclose(follow(p, bodies), RECORDED[f"stack {seed}"], atol=1e-9)


@pytest.mark.parametrize("drop", DROPS)
def test_cubes_land_as_recorded_although_their_faces_are_equally_deep(drop: float) -> None:
    bodies = build_cubes(p, drop)
    client_of(0).world.parameters.contact_warm_starting = 0.0
    assert_allclose(follow(p, bodies), RECORDED[f"cubes {drop}"], atol=1e-9)
