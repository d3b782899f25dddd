"""Actuators of ball joints turn them as in MuJoCo."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.ball import BALL, BALLS, CONTROL, HINGE

from carom import World

ANSWERS = json.loads((Path(__file__).parent / "cases" / "ball_answers.json").read_text())
STEP = 1e-7


def load(folder, text):
    (folder / "file.xml").write_text(text)
    return World().load(folder / "file.xml")


def joints_of(scene):
    return [scene["p"].joints["h"], scene["p"].joints["b"], scene["w"].joints["u"]]


def rates_of(joint):
    body = joint.body
    first, count = body.velocity_index[joint.index], body.velocity_count[joint.index]
    return body.world.arrays.state.numpy["dof_velocity"][0, first : first + count].copy()


@pytest.mark.parametrize("name", BALLS)
def test_motion_and_forces_are_those_of_mujoco(tmp_path, name):
    answer, scene = ANSWERS[name], load(tmp_path, BALLS[name])
    assert not scene.ignored.that_matter
    scene.apply_options()
    scene.world.change_parameters(time_step=STEP)
    hinge, *balls = joints_of(scene)
    hinge.body.set_joint_state(hinge.index, [HINGE], None)
    for ball, quaternion in zip(balls, BALL, strict=True):
        w, x, y, z = (np.array(quaternion) / np.linalg.norm(quaternion)).tolist()
        ball.body.set_joint_state(ball.index, [x, y, z, w], None)
    actuators = list(scene.actuators.values())
    for actuator in actuators:
        actuator.control = CONTROL
    if name == "motor on the world":
        assert any("its length is 0" in one.consequence for one in scene.ignored)
    else:
        assert_allclose([it.length for it in actuators], answer["length"], atol=1e-9)
    assert_allclose([it.spec.bias[2] for it in actuators], answer["damping"], rtol=1e-9, atol=1e-12)
    scene.world.step()
    rates = np.concatenate([rates_of(joint) for joint in joints_of(scene)])
    assert_allclose(rates / STEP, answer["acceleration"], rtol=1e-5, atol=1e-4)
    assert_allclose([it.force for it in actuators], answer["force"], rtol=1e-5)


def test_what_is_not_built_is_said(tmp_path):
    text = BALLS["servo in the world"].replace("jointinparent", "joint")
    (lost,) = load(tmp_path, text).ignored.that_matter
    assert "its force depends on angles" in lost.reason
    text = BALLS["motor"].replace('<joint name="b"', '<joint name="s" type="slide"/><joint name="b"')
    (lost,) = load(tmp_path, text).ignored.that_matter
    assert lost.reason == "its body has other joints as well"
