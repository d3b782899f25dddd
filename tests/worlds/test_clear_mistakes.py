"""Mistakes with worlds and bodies are told, not lost; and all of them say what they are."""

from __future__ import annotations

import pickle
from copy import deepcopy

import numpy as np
import pytest

import pybullet_data
from carom import Body, Camera, World, Worlds


@pytest.fixture
def arm() -> tuple[World, Body]:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    path = f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf"
    return world, world.load_urdf(path, fixed_base=True)


def test_link_poses_mean_the_same_in_one_world_and_in_many(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, 2)
    batch = worlds[panda]
    batch.joints.positions[1] = np.linspace(-0.5, 0.5, 9)
    links = worlds.extract(1).bodies[panda.id].links
    for row, name in enumerate(batch.links.names[1:]):
        for poses, pose in (
            (batch.links.poses, links[name].pose),
            (batch.links.inertial_poses, links[name].inertial_pose),
        ):
            np.testing.assert_allclose(poses[1, row], [*pose.position, *pose.orientation], atol=1e-14)


def test_joint_positions_that_are_copies_cannot_be_written_to(arm: tuple[World, Body]) -> None:
    _, panda = arm
    for copied in (panda.joints.positions, panda.joints.velocities):
        with pytest.raises(ValueError, match="read-only"):
            copied[0] = 0.5


@pytest.mark.parametrize("many", [False, True])
def test_misspelt_attributes_are_refused(arm: tuple[World, Body], many: bool) -> None:
    world = Worlds(arm[0], 2) if many else arm[0]
    with pytest.raises(AttributeError, match=r"has no attribute 'gravty'; did you mean 'gravity'\?"):
        world.gravty = (0.0, 0.0, -1.0)  # type: ignore[union-attr]
    world.gravity = (0.0, 0.0, -1.0)


def test_misspelt_attributes_of_bodies_and_cameras_are_refused(arm: tuple[World, Body]) -> None:
    world, panda = arm
    camera = Camera.with_field_of_view(32, 32, 50)
    things = (
        panda,
        panda.joints,
        panda.links,
        panda.joints[0],
        panda.links[0],
        Worlds(world, 2)[panda],
        camera,
    )
    for thing in things:
        with pytest.raises(AttributeError, match="has no attribute 'positons'"):
            thing.positons = 1.0  # type: ignore[union-attr]
    with pytest.raises(AttributeError, match="did you mean 'positions'"):
        Worlds(world, 2)[panda].joints.positons = 1.0  # type: ignore[attr-defined]
    camera.width = 16


def test_classes_of_ones_own_have_attributes_of_their_own() -> None:
    class Mine(World):
        def __init__(self) -> None:
            super().__init__()
            self.score = 3

    assert Mine().score == 3


@pytest.mark.parametrize("many", [False, True])
def test_steps_are_not_undone(arm: tuple[World, Body], many: bool) -> None:
    world = Worlds(arm[0], 2) if many else arm[0]
    with pytest.raises(ValueError, match="count must be at least 0, not -1"):
        world.step(-1)
    world.step(0)


def test_a_body_that_is_not_there_is_named_with_those_that_are(arm: tuple[World, Body]) -> None:
    with pytest.raises(KeyError, match=r"there is no body 5; the world has 0 \('panda'\)"):
        arm[0].bodies[5]
    with pytest.raises(KeyError, match="the world has none"):
        World().remove(0)
    assert arm[0].bodies.get(5) is None


def test_dynamics_change_by_name(arm: tuple[World, Body]) -> None:
    _, panda = arm
    panda.change_dynamics("panda_link3", lateral_friction=0.7)
    assert panda.dynamics(2).lateral_friction == 0.7
    with pytest.raises(KeyError, match="no link is called 'elbow'"):
        panda.change_dynamics("elbow", lateral_friction=0.7)


def test_everything_says_what_it_is(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, 3)
    camera = Camera.with_field_of_view(16, 12, 60.0).look_at((2.0, 0.0, 1.0), (0.0, 0.0, 0.5))
    with world.log("position") as log:
        world.step(2)
    assert repr(world) == "<World at 0.0083 s with 'panda'>"
    assert repr(World()) == "<World at 0.0000 s with no bodies>"
    assert repr(panda) == "<Body 0 'panda': 12 joints, fixed base>"
    assert repr(panda.joints).startswith("<Joints of 'panda': 'panda_joint1', ")
    assert repr(worlds) == "<Worlds: 3 on 'cpu' with 'panda', 0 halted>"
    assert repr(camera) == "<Camera 16 x 12 in the world>"
    assert repr(camera.capture(world)) == "<CameraImage 16 x 12, 1 bodies in view>"
    assert repr(worlds.images(camera)) == "<Images of 3 worlds, 16 x 12>"
    assert repr(log) == "<Log of position, time: 2 steps recorded>"


@pytest.mark.parametrize("copied", [deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_copies_and_pickles_go_on_as_the_world_does(arm: tuple[World, Body], copied: object) -> None:
    world, panda = arm
    world.step(3)
    other = copied(world)  # type: ignore[operator]
    body = copied(panda)  # type: ignore[operator]
    assert body.world is not world
    world.step(20)
    other.step(20)
    body.world.step(20)
    np.testing.assert_array_equal(other.position, world.position)
    np.testing.assert_array_equal(body.joints.positions, panda.joints.positions)
    assert other.time == world.time


def test_many_worlds_say_how_they_are_kept(arm: tuple[World, Body]) -> None:
    worlds = Worlds(arm[0], 2)
    for make in (pickle.dumps, deepcopy):
        with pytest.raises(TypeError, match=r"save\(path\).*extract\(number\)"):
            make(worlds)
