"""Welds that are off by large angles pull as MuJoCo's: their errors are the vector part of a quaternion."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.beside_mujoco.turned import MOVED, STEP, STEPS, TURNED

from carom import World

ANSWERS = json.loads((Path(__file__).parent / "turned_answers.json").read_text())


def started(world, folder, text):
    (folder / "file.xml").write_text(text)
    scene = world.load(folder / "file.xml")
    assert not scene.ignored.that_matter
    world.reset(next(iter(scene.keyframes)))
    return scene


def velocities(scene):
    if "c" not in [body.name for body in scene.bodies]:
        moving = scene["b"].links[-1].velocity
        # The body has not turned yet, so that these are also along its own axes, as MuJoCo's are.
        return np.array([*moving.linear, *moving.angular])
    return np.concatenate([scene[name].joints.velocities for name in ("b", "c")])


@pytest.mark.parametrize("name", TURNED)
def test_accelerations_are_those_of_mujoco(tmp_path, name):
    with World(contact="compliant") as world:
        scene = started(world, tmp_path, TURNED[name])
        before = velocities(scene)
        world.step()
        found = (velocities(scene) - before) / STEP
    answer = np.array(ANSWERS["accelerations"][name])
    assert_allclose(found, answer, atol=1e-5 * np.abs(answer).max())


@pytest.mark.parametrize("name", MOVED)
def test_motions_are_those_of_mujoco(tmp_path, name):
    with World(contact="compliant") as world:
        scene = started(world, tmp_path, MOVED[name])
        done = 0
        for steps, answer in zip(STEPS, ANSWERS["motions"][name], strict=True):
            world.step(steps - done)
            done = steps
            pose = scene["b"].links["b"].pose
            found = [*pose.position, *np.array(pose.matrix)[:3, :3].ravel()]
            assert_allclose(found, answer, atol=2e-5)


def test_torque_of_a_weld_is_what_turns_the_body(tmp_path):
    text = TURNED["nearly half"].replace('timestep="1e-07"', 'timestep="1e-05" gravity="0 0 0"')
    with World(contact="compliant") as world:
        scene = started(world, tmp_path, text)
        body, (weld,) = scene["b"], scene.constraints.values()
        before = np.array(body.links[-1].velocity.angular)
        world.step()
        turned = (np.array(body.links[-1].velocity.angular) - before) / world.time_step
        moments = np.array(body.dynamics(-1).inertia)
        # At 1 to 2 rad/s the gyroscopic torque is a small part of it.
        gyroscopic = np.cross(before, moments * before)
        # The weld is 1 m below the body, in the world's origin.
        torque = weld.torque + np.cross([0.0, 0.0, -1.0], weld.force) - gyroscopic
        assert_allclose(moments * turned, torque, rtol=1e-3, atol=1e-2)


def test_derivatives_of_a_weld_at_rest_are_exact(tmp_path):
    text = TURNED["at rest"].replace('timestep="1e-07"', 'timestep="0.002" gravity="0 0 0"')
    with World(contact="compliant") as world:
        started(world, tmp_path, text)
        exact, differences = world.linearize(), world.linearize(method="differences")
        assert_allclose(exact.A, differences.A, atol=1e-6 * np.abs(differences.A).max())
