"""Boxes touch in as many points as in MuJoCo; cylinders and hulls touch planes where they do there."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.beside_mujoco.point import RESTING, STEP, STEPS, TOUCHING

from carom import World

ANSWERS = json.loads((Path(__file__).parent / "point_answers.json").read_text())


@pytest.mark.parametrize("name", TOUCHING)
def test_accelerations_are_those_of_mujoco(tmp_path, name):
    (tmp_path / "file.xml").write_text(TOUCHING[name])
    with World(contact="compliant") as world:
        body = world.load(tmp_path / "file.xml")["b"]
        world.step()
        moving = body.links[-1].velocity
        found = np.array([*moving.linear, *moving.angular]) / STEP
    answer = ANSWERS["touching"][name]
    expected = np.array(answer["acceleration"])
    assert_allclose(found, expected, atol=2e-5 * np.abs(expected).max())


@pytest.mark.parametrize("name", RESTING)
def test_bodies_come_to_rest_where_they_do_in_mujoco(tmp_path, name):
    (tmp_path / "file.xml").write_text(RESTING[name])
    with World(contact="compliant") as world:
        body = world.load(tmp_path / "file.xml")["b"]
        done = 0
        for steps, answer in zip(STEPS, ANSWERS["resting"][name], strict=True):
            world.step(steps - done)
            done = steps
            assert_allclose(body.links[-1].pose.position, answer, atol=1e-5)


def test_boxes_of_other_files_touch_in_four_points():
    with World(contact="bullet") as world:
        world.add_box((0.2, 0.2, 0.2), position=(0.0, 0.0, 0.0), mass=0.0)
        world.add_box(
            (0.2, 0.2, 0.2), position=(0.0, 0.0, 0.199), orientation=(0.0, 0.0, 0.38, 0.92), mass=1.0
        )
        world.step()
        assert world.contact_arrays.contact_count == 4
