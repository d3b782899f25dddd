"""Files that `World.load` reads mean what they mean in MuJoCo: masses, inertia, frames, joints."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.compiled import CASES

from carom import World
from carom.description.transform import rotation_matrix

ANSWERS = json.loads((Path(__file__).parent / "cases" / "mujoco_answers.json").read_text())


def load(world, folder, name):
    (folder / "file.xml").write_text(CASES[name])
    return world.load(folder / "file.xml")


def links_of(scene):
    return {
        link.name: (body, index, link)
        for body in scene.bodies
        for index in range(-1, len(body.spec.links))
        for link in [body.spec.link(index)]
        if "@" not in link.name and link.name != "world"
    }


@pytest.mark.parametrize("name", CASES)
def test_masses_and_inertia_are_those_of_mujoco(tmp_path, name):
    with World() as world:
        links = links_of(load(world, tmp_path, name))
        assert set(links) == set(ANSWERS[name]["bodies"])
        for one, expected in ANSWERS[name]["bodies"].items():
            body, _, link = links[one]
            assert_allclose(link.mass, expected["mass"], rtol=2e-7, atol=2e-7)
            if link.mass == 0.0 or (body.fixed_base and link is body.spec.base):
                continue
            assert_allclose(link.inertial_frame.position, expected["centre"], rtol=2e-7, atol=2e-7)
            turn = np.array(rotation_matrix(link.inertial_frame.orientation))
            tensor = turn @ np.diag(link.inertia) @ turn.T
            assert_allclose(
                tensor, expected["tensor"], rtol=1e-6, atol=1e-6 * np.abs(expected["tensor"]).max()
            )


@pytest.mark.parametrize("name", ["tree", "copies"])
def test_joints_put_bodies_where_mujoco_puts_them(tmp_path, name):
    with World() as world:
        scene = load(world, tmp_path, name)
        joints = {
            joint.name: joint for body in scene.bodies for joint in body.joints if "@" not in joint.name
        }
        known = ANSWERS[name]["joints"]
        for one, expected in known.items():
            if not one:
                continue
            q = expected["position"]
            if len(q) == 1:
                assert_allclose(joints[one].position, expected["start"], atol=1e-15)
                low, high = expected["range"] or (-np.inf, np.inf)
                assert_allclose(joints[one].limits, (low, high), rtol=1e-15)
            body, index = joints[one].body, joints[one].index
            body.set_joint_state(index, q if len(q) == 1 else [*q[1:], q[0]], None)
        for body in scene.bodies:
            for index, link in enumerate(body.spec.links):
                if link.joint_name.startswith("joint"):
                    body.set_joint_state(index, known[""]["position"], None)
        for one, (body, index, _) in links_of(scene).items():
            pose, expected = body.links[index].pose, ANSWERS[name]["bodies"][one]
            assert_allclose(pose.position, expected["position"], atol=1e-12)
            turn = np.array(rotation_matrix(tuple(pose.orientation)))
            assert_allclose(turn.reshape(9), expected["rotation"], atol=1e-12)
