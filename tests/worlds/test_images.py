"""Camera images of many worlds are those of each world alone, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest
from tests.physics.contact_scenes import HALF, add_ball, add_floor, earth
from tests.soft.scenes import world as empty_world

import pybullet_data
from carom import Body, Camera, World, Worlds
from carom.render.lights import Light
from carom.worlds.images import Images

DATA = pybullet_data.getDataPath()
COUNT = 3


@pytest.fixture
def arm() -> tuple[World, Body]:
    world = earth()
    return world, world.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True)


@pytest.fixture
def balls() -> tuple[World, Body, Body]:
    """A floor and two balls over it."""
    world = earth()
    floor = add_floor(world)
    return world, floor, add_ball(world, (0.0, 0.0, HALF))


def assert_same_images(worlds: Worlds, camera: Camera, images: Images, numbers: list[int]) -> None:
    for place, number in enumerate(numbers):
        alone = camera.capture(worlds.extract(number))
        for name in Images._fields:
            np.testing.assert_array_equal(getattr(images, name)[place], getattr(alone, name))


def test_images_show_each_world(balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    worlds = Worlds(world, COUNT)
    worlds[ball].set_base_inertial_poses([[0, 0, 0.5], [0, 0.4, 0.5], [0, -0.4, 0.5]])
    camera = Camera.with_field_of_view(32, 24, 60.0).look_at((2.0, 0.0, 0.6), (0.0, 0.0, 0.5))
    images = worlds.images(camera)
    assert images.colour.shape == (COUNT, 24, 32, 3)
    for number in range(COUNT):
        alone = camera.capture(worlds.extract(number))
        np.testing.assert_array_equal(images.colour[number], alone.colour)
        np.testing.assert_array_equal(images.depth[number], alone.depth)
        np.testing.assert_array_equal(images.body_ids[number], alone.body_ids)
    assert worlds.images(camera, where=[]).depth.shape == (0, 24, 32)


def test_a_mounted_camera_goes_with_its_link(arm: tuple[World, Body]) -> None:
    world, panda = arm
    add_floor(world)
    worlds = Worlds(world, 2, threads=2)
    worlds[panda].joints.positions[1, 5] = 0.5
    camera = Camera.with_field_of_view(16, 16, 60.0).mount(panda.links["panda_hand"])
    camera.look_at((0.2, 0.0, 0.1), (0.3, 0.0, 1.0))
    images = worlds.images(camera)
    assert camera.link is panda.links["panda_hand"]
    assert (images.depth[0] != images.depth[1]).any()
    np.testing.assert_array_equal(images.depth[0], camera.capture().depth)


@pytest.mark.parametrize("light", [Light(), Light(shadow=True), Light(distance=np.inf, shadow=True)])
@pytest.mark.parametrize("threads", [1, 2, 5])
def test_any_light_and_number_of_threads(balls: tuple[World, Body, Body], light: Light, threads: int) -> None:
    world, _, ball = balls
    worlds = Worlds(world, 7, threads=threads)
    worlds[ball].set_base_inertial_poses([[0.1 * number, 0.0, 0.5] for number in range(7)])
    camera = Camera.with_field_of_view(24, 20, 60.0, light=light).look_at((2.0, 0.5, 0.9), (0.0, 0.0, 0.4))
    images = worlds.images(camera)
    assert np.isfinite(images.depth).any()
    assert (images.depth[0] != images.depth[6]).any()
    assert_same_images(worlds, camera, images, list(range(7)))
    some = [5, 2]
    assert_same_images(worlds, camera, worlds.images(camera, where=some), some)


def test_images_follow_steps_and_other_sizes(balls: tuple[World, Body, Body]) -> None:
    world, *_ = balls
    worlds = Worlds(world, COUNT, threads=2)
    for side in (12, 20, 12):
        worlds.step(20)
        camera = Camera.with_field_of_view(side, side, 60.0).look_at((2.0, 0.5, 0.9), (0.0, 0.0, 0.4))
        assert_same_images(worlds, camera, worlds.images(camera), list(range(COUNT)))


def test_images_of_soft_bodies_are_those_of_each_world() -> None:
    scene = empty_world()
    sheet = scene.load_cloth((0.5, 0.5), (8, 8), (0.0, 0.0, 0.5))
    worlds = Worlds(scene, COUNT)
    worlds[sheet].nodes[1, :, 2] += 0.1
    camera = Camera.with_field_of_view(24, 20, 60.0).look_at((1.0, 0.5, 1.0), (0.0, 0.0, 0.5))
    images = worlds.images(camera)
    assert (images.depth[0] != images.depth[1]).any()
    assert_same_images(worlds, camera, images, list(range(COUNT)))
