"""Contacts of two geoms mix condim, friction, solref, solimp and margin of both, each by MuJoCo's rule."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.beside_mujoco.mixed import MIXED, STEP

from carom import World, Worlds

ANSWERS = json.loads((Path(__file__).parent / "mixed_answers.json").read_text())
PAIR = """<mujoco><worldbody><geom name="floor" type="plane" size="9 9 .1" {floor}/>
<body name="box" pos="0 0 .1"><freejoint/><geom name="g" type="box" size=".1 .1 .1" {box}/></body>
</worldbody></mujoco>"""


def velocities(body):
    moving = body.links[-1].velocity
    # About axes of the body, as in MuJoCo; it has not turned yet.
    return np.array([*moving.linear, *moving.angular])


@pytest.mark.parametrize("name", MIXED)
def test_accelerations_are_those_of_mujoco(tmp_path, name):
    (tmp_path / "file.xml").write_text(MIXED[name])
    with World(contact="compliant") as world:
        scene = world.load(tmp_path / "file.xml")
        world.reset(next(iter(scene.keyframes)))
        before = velocities(scene["b"])
        world.step()
        found = (velocities(scene["b"]) - before) / STEP
    answer = np.array(ANSWERS[name])
    assert_allclose(found, answer, atol=2e-5 * max(1.0, np.abs(answer).max()))


def sliding(folder, floor, box, change=None, *, others=None):
    (folder / "file.xml").write_text(PAIR.format(floor=floor, box=box))
    with World(contact="compliant", integrator="discrete") as world:
        scene = world.load(folder / "file.xml")
        world.step(100)
        if change is not None:
            change(scene["box"])
        scene["box"].set_base_velocity([2.0, 0.0, 0.0], [0.0, 0.0, 0.0])
        world.step(50)
        return (2.0 - scene["box"].links[-1].velocity.linear[0]) / (50 * world.time_step) / 9.81


def test_friction_of_a_geom_without_counts_beside_one_with(tmp_path):
    # Of 1 and 3 dimensions the greater: both coefficients count.
    assert_allclose(sliding(tmp_path, 'condim="1" friction=".6"', 'friction=".2"'), 0.6, rtol=0.05)
    assert_allclose(sliding(tmp_path, 'condim="1" friction=".6"', 'condim="1"'), 0.0, atol=1e-6)
    assert_allclose(sliding(tmp_path, 'condim="1" priority="1"', 'friction=".2"'), 0.0, atol=1e-6)


def test_friction_that_is_set_counts(tmp_path):
    def rub(body):
        body.shapes["g"].friction = 0.3

    both = 'condim="1" friction=".1"'
    assert_allclose(sliding(tmp_path, both, both, rub), 0.3, rtol=0.05)


def test_friction_that_is_set_in_many_worlds_counts(tmp_path):
    both = 'condim="1" friction=".1"'
    (tmp_path / "file.xml").write_text(PAIR.format(floor=both, box=both))
    with World(contact="compliant", integrator="discrete") as world:
        scene = world.load(tmp_path / "file.xml")
        body = scene["box"]
        world.step(100)
        body.set_base_velocity([2.0, 0.0, 0.0], [0.0, 0.0, 0.0])
        worlds = Worlds(world, 3)
        box = worlds[body]
        box.shapes["g"].change(friction=0.3, where=[1])
        box.change_dynamics("box", lateral_friction=0.3, where=[2])
        worlds.step(50)
        slowed = (2.0 - box.velocity.linear[:, 0]) / (50 * world.time_step) / 9.81
    assert_allclose(slowed, [0.0, 0.3, 0.3], atol=0.02)


def test_friction_without_a_rank_is_multiplied_by_what_counts_of_a_geom(tmp_path):
    (tmp_path / "file.xml").write_text(PAIR.format(floor='condim="1"', box=""))
    with World(contact="bullet") as world:
        world.load(tmp_path / "file.xml")
        other = world.add_box((0.2, 0.2, 0.2), position=(1.0, 0.0, 0.1), mass=1.0)
        world.step(50)
        other.set_base_velocity([2.0, 0.0, 0.0], [0.0, 0.0, 0.0])
        world.step(50)
        assert_allclose(other.links[-1].velocity.linear[0], 2.0, atol=0.01)
