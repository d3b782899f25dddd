"""Traps that people have met, each of them gone, or answered with the sentence that helps."""

from __future__ import annotations

import subprocess
import sys
import warnings
from typing import Any

import numpy as np
import pytest
from tests.face.scene import made

import carom
import pybullet_data
from carom import Pose, World, Worlds, algorithms
from carom.scene.joints import JointGroup
from carom.suggestions import suggestion

_PANDA = f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf"


def test_worlds_are_made_with_the_arguments_that_people_try() -> None:
    world = World(gravity=(0.0, 0.0, -3.0), time_step=0.002)
    assert (world.gravity[2], world.time_step) == (-3.0, 0.002)
    world.time_step = 0.001
    assert world.time_step == 0.001
    wrong: Any = World
    with pytest.raises(TypeError, match="'timestep'") as told:
        wrong(timestep=0.01)
    assert suggestion(told.value) == "Did you mean 'time_step'?"
    with pytest.raises(ValueError, match="time_step must be finite and > 0"):
        World(0)


def test_a_joint_is_put_where_it_is_told() -> None:
    _, arm, _ = made()
    arm.joints["elbow"].position = 1.0
    assert arm.joints.positions.tolist() == [0.0, 1.0]
    assert arm.joints[:1].names == ["shoulder"]
    group = arm.joints["e*"]
    assert isinstance(group, JointGroup)
    assert group.positions.tolist() == [1.0]


def test_a_body_is_removed_by_any_of_its_names() -> None:
    for key in ("handle", "name", "number"):
        world, _, box = made()
        world.remove({"handle": box, "name": "box", "number": box.id}[key])
        assert "box" not in world
        with pytest.raises(KeyError, match="there is no body 'box'"):
            world.remove("box")


def test_a_world_that_was_left_refuses_to_step() -> None:
    with World() as world:
        world.step()
    with pytest.raises(carom.errors.StateError, match="make another one"):
        world.step()


def test_targets_of_inverse_kinematics_are_link_frames_in_position_and_orientation() -> None:
    _, arm, _ = made()
    arm.joints.positions = (0.3, 0.4)
    wanted = arm.links["hand"].pose
    arm.joints.positions = (0.1, 0.1)
    found = algorithms.inverse_kinematics(arm, ["hand"], [wanted.position])
    assert isinstance(found.positions, tuple)
    arm.joints.positions = arm.inverse_kinematics("hand", wanted).positions
    np.testing.assert_allclose(arm.links["hand"].pose.array, wanted.array, atol=1e-4)


def test_a_pose_that_is_read_and_set_changes_nothing() -> None:
    world = World()
    world.load(
        '<mujoco><worldbody><body name="b"><freejoint/><inertial pos=".1 .2 .3" mass="1" '
        'fullinertia="2 2.5 3 .1 .2 .3"/></body></worldbody></mujoco>'
    )
    body = world["b"]
    body.pose = Pose((1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5))
    before = world.position.copy()
    body.pose = body.pose
    assert np.array_equal(world.position, before)
    np.testing.assert_allclose(body.links[-1].pose.array, body.pose.array, atol=1e-12)


def test_many_worlds_find_bodies_by_name_and_have_poses_of_bases() -> None:
    world, arm, box = made()
    worlds = Worlds(world, 2)
    assert worlds["arm"] is worlds[arm]
    assert worlds["box"].links.poses.shape == (2, 0, 7)
    assert worlds["box"].pose.array.shape == worlds["box"].base.pose.array.shape == (2, 7)
    assert worlds.contacts(worlds[arm], worlds[box]).touching.tolist() == [False, False]
    with pytest.raises(KeyError, match="there is no body 'panda'"):
        worlds["panda"]


def test_the_bundled_arm_is_loaded_without_a_warning() -> None:
    world = World()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        world.load_urdf(_PANDA, fixed_base=True)


def test_a_missing_mesh_is_named_with_its_whole_path() -> None:
    name = "a_folder_with_a_long_name/" * 6 + "missing.obj"
    mesh = f'<collision><geometry><mesh filename="{name}"/></geometry></collision>'
    text = f'<robot name="r"><link name="l">{mesh}</link></robot>'
    with pytest.raises(carom.errors.DescriptionError) as told:
        World().load(text)
    assert name in str(told.value)


def test_packages_are_there_after_import_carom() -> None:
    code = "import carom; carom.algorithms.jacobian; carom.viewer.Viewer; carom.vector.WorldsEnv"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_world_that_was_left_refuses_all_that_would_change_it() -> None:
    with World() as world:
        world.add_plane()
    for use in (world.add_plane, lambda: world.load(_PANDA), lambda: world.load_urdf(_PANDA)):
        with pytest.raises(carom.errors.StateError, match="this world was left"):
            use()


def test_any_kind_but_those_that_there_are_is_refused_and_the_world_goes_on() -> None:
    world, _, box = made()
    wrong: Any = world.constrain
    for kind in ("weld", "fix", 99):
        with pytest.raises(
            ValueError, match="kind must be one of 'fixed', 'point', 'hinge', 'slide', 'gear'"
        ):
            wrong(box, None, kind)
    world.step(3)
    assert len(world.constraints) == 0


def test_what_was_called_tie_is_constrain() -> None:
    world, _, _ = made()
    with pytest.raises(AttributeError) as told:
        world.tie  # type: ignore[attr-defined]  # noqa: B018
    assert "constrain" in str(suggestion(told.value))
