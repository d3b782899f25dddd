"""Cameras of MJCF files that follow bodies see what they see in MuJoCo."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.camera import CAMERAS, MOVED

from carom import World, Worlds
from carom.description.pose import Pose
from carom.description.transform import compose, rotation_matrix
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "cases" / "camera_answers.json").read_text())


def load(folder, text):
    (folder / "file.xml").write_text(text)
    return World().load(folder / "file.xml")


def unit(quaternion):
    size = sum(it * it for it in quaternion) ** 0.5
    return tuple(it / size for it in quaternion)


def move(scene):
    step, (w, x, y, z), angle, other = MOVED
    body, base = scene["t"], scene["t"].spec.base
    px, py, pz = (body.links[-1].pose.position + np.array(step)).tolist()
    pose = compose(Pose((px, py, pz), unit((x, y, z, w))), base.inertial_frame)
    body.set_inertial_pose(pose.position, pose.orientation)
    for joint, position in ((body.joints["j"], angle), (scene["m"].joints["k"], other)):
        joint.body.set_joint_state(joint.index, [position], None)


def check(pose, expected):
    assert_allclose(pose.position, expected[:3], atol=1e-9)
    x, y, z, w = pose.orientation.tolist()
    # MuJoCo's cameras look along -z, with y up.
    turn = np.array(rotation_matrix((x, y, z, w))) @ np.diag([1.0, -1.0, -1.0])
    assert_allclose(turn.reshape(9), expected[3:], atol=1e-9)


@pytest.mark.parametrize("name", CAMERAS)
def test_cameras_are_where_mujoco_has_them(tmp_path, name):
    scene = load(tmp_path, CAMERAS[name])
    assert not scene.ignored.that_matter
    for answer in ANSWERS[name]:
        for camera, expected in answer.items():
            check(scene.camera(camera, 8, 8).pose, expected)
        move(scene)


def test_cameras_follow_in_many_worlds_and_see_their_targets(tmp_path):
    scene = load(tmp_path, CAMERAS["targets"])
    camera = scene.camera("still", 9, 9)
    worlds = Worlds(scene.world, 2)
    worlds.step(40)
    assert worlds.images(camera).body_ids[:, 4, 4].tolist() == [scene["t"].id] * 2
    assert camera.capture(scene.world).body_ids[4, 4] == scene["t"].id


def test_a_scene_that_is_placed_has_its_cameras_there(tmp_path):
    load(tmp_path, CAMERAS["tracking"])
    turn = (0.0, 0.0, 1.0, 0.0)
    scene = World().load(tmp_path / "file.xml", position=(1.0, 0.0, 0.0), orientation=turn)
    place = Pose((1.0, 0.0, 0.0), turn)
    for name, (x, y, z, *_) in ANSWERS["tracking"][0].items():
        assert_allclose(scene.camera(name).pose.position, compose(place, Pose((x, y, z))).position, atol=1e-9)


def test_eyes_at_their_targets_and_straight_above_them_look_as_in_mujoco(tmp_path):
    text = (
        '<mujoco><worldbody><body name="t"><geom size=".1"/></body><camera name="c" pos="{}" '
        'euler="10 20 30" mode="targetbody" target="t"/></worldbody></mujoco>'
    )
    for place, z, turn in (
        ("0 0 1", 1, (1, 0, 0, 0, 1, 0, 0, 0, 1)),
        ("0 0 -1", -1, (1, 0, 0, 0, -1, 0, 0, 0, -1)),
        ("0 0 0", 0, (0, 0, 1, 1, 0, 0, 0, 1, 0)),
    ):
        check(load(tmp_path, text.format(place)).camera("c").pose, (0, 0, z, *turn))
    with pytest.raises(DescriptionError, match="there is no body 'u'"):
        load(tmp_path, text.format("0 0 1").replace('target="t"', 'target="u"'))
    with pytest.raises(DescriptionError, match="mode='aim' must be one of"):
        load(tmp_path, text.format("0 0 1").replace("targetbody", "aim"))
