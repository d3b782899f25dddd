"""What environments ask many worlds besides: touching links, poses of the step, steps of some worlds."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet_data
from carom import World, Worlds

ASSETS = pybullet_data.getDataPath()


def scene() -> tuple[World, int, int]:
    world = World(time_step=1 / 240)
    world.gravity = (0, 0, -9.81)
    floor = world.load_urdf(f"{ASSETS}/plane.urdf")
    robot = world.load_urdf(f"{ASSETS}/r2d2.urdf", (0, 0, 0.5))
    return world, floor.id, robot.id


def test_links_that_touch_are_those_that_contacts_name():
    world, floor, robot = scene()
    worlds = Worlds(world, 3)
    heights = np.array([0.5, 5.0, 0.6])
    worlds[robot].base_inertial_poses[:, 2] = heights
    worlds.step(60)
    touching = worlds.links_in_contact(robot, floor)
    links = range(-1, len(worlds[robot].links.names[1:]))
    expected = [worlds.contacts(robot, floor, link=link).number > 0 for link in links]
    assert (touching == np.array(expected).T).all()
    assert touching[0].sum() >= 2
    assert not touching[1].any()
    # Of the floor it is the base, the only link there is.
    assert (worlds.links_in_contact(floor, robot)[:, 0] == touching.any(axis=1)).all()
    assert (worlds.links_in_contact(robot, floor, -1) == touching).all()


def test_without_contacts_nothing_touches():
    world, floor, robot = scene()
    worlds = Worlds(world, 2)
    assert not worlds.links_in_contact(robot, floor).any()


def test_only_the_worlds_asked_for_are_stepped():
    world, _, robot = scene()
    worlds, twin = Worlds(world, 4), Worlds(world, 4)
    before = worlds[robot].base_inertial_poses.copy()
    worlds.step(10, where=[2, 0, 2])
    twin.step(10)
    assert np.allclose(worlds.time, [10 / 240, 0.0, 10 / 240, 0.0])
    assert (worlds[robot].base_inertial_poses[[0, 2]] == twin[robot].base_inertial_poses[[0, 2]]).all()
    assert (worlds[robot].base_inertial_poses[[1, 3]] == before[[1, 3]]).all()
    worlds.step(10, where=np.array([False, True, False, True]))
    assert (worlds[robot].base_inertial_poses == twin[robot].base_inertial_poses).all()
    with pytest.raises(IndexError, match="do not exist"):
        worlds.step(where=[4])


def test_poses_of_the_step_are_those_at_the_start_of_its_last_substep():
    world, _, robot = scene()
    worlds = Worlds(world, 2)
    worlds.step(5)
    present = worlds[robot].links.inertial_poses
    worlds.step()
    batch = worlds[robot]
    assert np.allclose(batch.links.stepped_poses, present, atol=1e-12)
    moving = batch.links.stepped_velocities[:, 0, 2].copy()
    assert np.allclose(moving, batch.base_velocities[:, 2])
    batch.links.update_poses([1])
    poses = batch.links.stepped_poses.copy()
    assert np.allclose(poses[0], present[0], atol=1e-12)
    assert (poses[1] == batch.links.inertial_poses[1]).all()


def test_columns_of_joints():
    world, _, robot = scene()
    batch = Worlds(world, 1)[robot]
    names = [name for name in batch.joints.names if name.endswith("wheel_joint")]
    columns = batch.joints[list(names)].columns
    batch.joints.velocities[:, columns] = 3.0
    everything = batch.joints.columns
    assert isinstance(everything, slice)
    assert everything.stop == batch.joints.velocities.shape[1]
    assert np.count_nonzero(batch.joints.velocities == 3.0) == len(names) == 4
    fixed = next(name for name in batch.joints.names if name not in names and "gripper" not in name)
    assert batch.joints[[fixed]].columns == slice(0, 0)


def test_coordinates_are_copied_to_a_world_that_has_the_same_bodies():
    world, _, robot = scene()
    worlds = Worlds(world, 2)
    worlds[robot].base_inertial_poses[1, 0] = 3.0
    worlds.copy_coordinates(1, world)
    assert world.bodies[robot].links[-1].inertial_pose.position[0] == 3.0
    with pytest.raises(ValueError, match="other bodies"):
        worlds.copy_coordinates(1, World())
    with pytest.raises(IndexError):
        worlds.copy_coordinates(2, world)
