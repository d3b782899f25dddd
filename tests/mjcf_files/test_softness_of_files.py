"""Limits, friction, contacts and equality constraints yield as in MuJoCo, and flags switch them off."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from soft_cases import MOVED, STEPS, WEIGHED

from carom import World
from carom.formats.mjcf.compiled.reader import compile_mjcf
from carom.model.from_files import hull_triangles

# MuJoCo's Euler has explicit springs.
SPRINGS = ("springdamper", "damper off")
ANSWERS = json.loads(Path(__file__).with_name("soft_answers.json").read_text())


def test_inverse_masses_at_the_reference_are_those_of_mujoco(tmp_path):
    (tmp_path / "file.xml").write_text(WEIGHED)
    model = compile_mjcf(tmp_path / "file.xml", hull=hull_triangles)
    for name, weights in ANSWERS["weights"]["bodies"].items():
        assert_allclose(model.body_weights[name], weights, rtol=1e-9, atol=1e-15)
    for name, weight in ANSWERS["weights"]["joints"].items():
        assert_allclose(model.joint_weights[name], weight, rtol=1e-9)


@pytest.mark.parametrize("name", MOVED)
def test_bodies_move_as_in_mujoco(tmp_path, name):
    (tmp_path / "file.xml").write_text(MOVED[name])
    with World() as world:
        scene = world.load(tmp_path / "file.xml")
        assert not scene.ignored.that_matter
        scene.apply_options()
        # MuJoCo's solver converges.
        world.parameters.solver_residual_threshold, world.parameters.solver_iterations = 1e-16, 500
        world.apply_parameters()
        for actuator in scene.actuators.values():
            actuator.control = 2.0
        atol = 5e-3 if name in SPRINGS else 1e-6
        done = 0
        for steps, answer in zip(STEPS, ANSWERS[name], strict=True):
            world.step(steps - done)
            done = steps
            free = next((body for body in scene.bodies if body.name == "f"), None)
            if free is not None:
                found = np.array(free.links[-1].pose.position)
            else:
                body = scene["a"]
                found = np.concatenate([body.joints[joint].coordinates for joint in ("j", "k")])
            assert_allclose(found, answer, atol=atol, err_msg=f"after {steps} steps")
