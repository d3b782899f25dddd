"""Two boxes touch in PyBullet's points, in PyBullet's order; stacks of them move as there, to rounding."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.box_pairs import follow, pairs, points, scenes

import pybullet as p
from pybullet._clients.clients import client_of

RECORDED = json.loads((Path(__file__).parent / "box_pairs.json").read_text())


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def test_two_boxes_touch_in_the_recorded_points() -> None:
    touching = 0
    for name, boxes in pairs().items():
        found, recorded = np.array(points(p, boxes)), np.array(RECORDED[name])
        assert found.shape == recorded.shape, name
        assert_allclose(found, recorded, atol=1e-9, err_msg=name)
        touching += len(found) > 0
    assert touching > 0.5 * len(pairs())


@pytest.mark.parametrize("name", scenes())
def test_stacks_and_cubes_whose_faces_are_equally_deep_move_as_recorded(name: str) -> None:
    bodies = scenes()[name](p)
    client_of(0).world.parameters.contact_warm_starting = 0.0
    assert_allclose(follow(p, bodies), RECORDED[name], atol=1e-9)


def test_nothing_else_is_recorded() -> None:
    assert list(RECORDED) == [*pairs(), *scenes()]
