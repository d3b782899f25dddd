"""What is seen: colours, textures, lights and cameras of one world, and of each of many."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from carom import Body, Camera, Pose, World, Worlds
from carom.camera import DAYLIGHT

PLAIN = replace(DAYLIGHT, shadow=False)
RED, GREEN, BLUE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def crate() -> tuple[World, Body, Camera]:
    world = World()
    box = world.add_box((0.2, 0.2, 0.2), (0.0, 0.0, 0.5), name="crate", colour=(1.0, 1.0, 1.0))
    camera = Camera.with_field_of_view(24, 24, 40.0, light=PLAIN).look_at((2.0, 0.0, 0.5), (0.0, 0.0, 0.5))
    return world, box, camera


def hue(image: Any) -> list[bool]:
    """Which of red, green and blue the middle has."""
    return (np.asarray(image)[12, 12] > 40).tolist()


def test_shapes_and_links_have_colours() -> None:
    world, box, camera = crate()
    shape = box.shapes[0]
    assert shape.colour.tolist() == [1.0, 1.0, 1.0, 1.0]
    shape.colour = RED
    assert hue(world.image(camera).colour) == [True, False, False]
    box.base.colour = (0.0, 1.0, 0.0, 1.0)
    assert shape.colour.tolist() == [0.0, 1.0, 0.0, 1.0]
    assert hue(world.image(camera).colour) == [False, True, False]
    for wrong in ((255, 0, 0), (1.0, 0.0), (math.nan, 0.0, 0.0)):
        with pytest.raises(ValueError, match="colour"):
            shape.colour = wrong
    assert world.copy()["crate"].shapes[0].colour.tolist() == [0.0, 1.0, 0.0, 1.0]


def test_shapes_have_textures(tmp_path: Any) -> None:
    world, box, camera = crate()
    shape = box.shapes[0]
    assert shape.texture is None
    shape.texture = np.broadcast_to(BLUE, (2, 2, 3))
    assert hue(world.image(camera).colour) == [False, False, True]
    np.testing.assert_array_equal(shape.texture[0, 0], (0, 0, 255))  # type: ignore[index]
    shape.texture = None
    assert hue(world.image(camera).colour) == [True, True, True]
    with pytest.raises(ValueError, match=r"array \(height, width, 3\)"):
        shape.texture = np.zeros((2, 2))
    with pytest.raises(Exception, match=r"none\.png"):
        shape.texture = tmp_path / "none.png"


def test_each_world_has_its_own_colours_and_textures() -> None:
    world, box, camera = crate()
    worlds = Worlds(world, 4)
    shape = worlds[box].shapes[0]
    shape.colour = np.array([RED, GREEN, BLUE, (1.0, 1.0, 1.0)])
    images = worlds.images(camera)
    assert [hue(image) for image in images.colour] == [
        [True, False, False], [False, True, False], [False, False, True], [True, True, True],
    ]  # fmt: skip
    # Some of them, in any order.
    assert [hue(image) for image in worlds.images(camera, where=[2, 0]).colour] == [
        [False, False, True], [True, False, False],
    ]  # fmt: skip
    shape.change(colour=GREEN, where=[0])
    assert shape.colour[:2].tolist() == [[0.0, 1.0, 0.0, 1.0]] * 2
    worlds[box].base.colour = (1.0, 1.0, 1.0)
    shape.texture = [np.broadcast_to(RED, (2, 2, 3)), None, np.broadcast_to(BLUE, (4, 4, 3)), None]
    assert [hue(image) for image in worlds.images(camera).colour] == [
        [True, False, False], [True, True, True], [False, False, True], [True, True, True],
    ]  # fmt: skip
    assert shape.texture[1] is None
    assert shape.texture[2].shape == (4, 4, 3)  # type: ignore[union-attr]
    for number in (0, 1, 2):
        np.testing.assert_array_equal(
            worlds.extract(number).image(camera).colour, worlds.images(camera).colour[number]
        )
    with pytest.raises(ValueError, match="there are 4 worlds"):
        shape.texture = [None, None]
    with pytest.raises(ValueError, match="colour has shape"):
        shape.colour = np.zeros((3, 3))


def test_each_world_has_its_own_camera_and_light() -> None:
    world, box, camera = crate()
    worlds = Worlds(world, 3)
    eyes = [(2.0, 0.0, 0.5), (0.0, 2.0, 0.5), (4.0, 0.0, 0.5)]
    cameras = [
        Camera.with_field_of_view(24, 24, degrees, light=replace(DAYLIGHT, ambient=ambient)).look_at(
            eye, (0.0, 0.0, 0.5)
        )
        for eye, degrees, ambient in zip(eyes, (40.0, 60.0, 20.0), (0.2, 0.5, 0.9), strict=True)
    ]
    found = worlds.images(
        camera,
        poses=[each.pose.array for each in cameras],
        fields_of_view=[40.0, 60.0, 20.0],
        lights=[each.light for each in cameras],
    )
    for number, each in enumerate(cameras):
        wanted = each.capture(world)
        np.testing.assert_array_equal(found.colour[number], wanted.colour)
        np.testing.assert_array_equal(found.depth[number], wanted.depth)
    # One for all, and poses in the frame of a link.
    mounted = Camera.with_field_of_view(24, 24, 40.0, light=PLAIN).mount(box.base)
    seen = worlds.images(mounted, where=[1], poses=camera.pose).depth
    assert np.isfinite(worlds.images(camera, poses=camera.pose).depth[:, 12, 12]).all()
    assert seen.shape == (1, 24, 24)
    for words, wrong in (
        ("poses must be one for each of the 3", {"poses": np.tile(camera.pose.array, (2, 1))}),
        ("quaternion of a camera", {"poses": Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))}),
        ("between 0 and 180", {"fields_of_view": [10.0, 20.0, 190.0]}),
        ("lights must be 3", {"lights": [PLAIN]}),
        ("all be parallel", {"lights": [DAYLIGHT, DAYLIGHT, replace(DAYLIGHT, distance=3.0)]}),
    ):
        with pytest.raises(ValueError, match=words):
            worlds.images(camera, **wrong)  # type: ignore[arg-type]


def test_sizes_are_told() -> None:
    world, box, _ = crate()
    world.load(
        '<mujoco><worldbody><body name="b"><geom type="capsule" size=".1 .3" euler=".3 0 0"/>'
        '<geom type="cylinder" size=".2 .1" pos="1 0 0"/><geom size=".5"/></body>'
        '<geom type="plane" name="floor" size="1 1 1"/></worldbody></mujoco>'
    )
    sizes = [shape.size for shape in world["b"].shapes]
    np.testing.assert_allclose(sizes, [(0.2, 0.2, 0.8), (0.4, 0.4, 0.2), (1.0, 1.0, 1.0)], atol=1e-12)
    np.testing.assert_allclose(box.shapes[0].size, (0.4, 0.4, 0.4), atol=1e-12)
    worlds = Worlds(world, 2)
    assert worlds[box].shapes[0].size.shape == (2, 3)
    with pytest.raises(NotImplementedError, match=r"worlds\[body\]\.present = mask"):
        worlds["world"].shapes["floor"].size = (1.0, 1.0, 1.0)


def test_bounds_are_tight_in_one_world_and_in_many() -> None:
    world, box, _ = crate()
    half = math.sqrt(0.5)
    eighth = math.radians(22.5)
    box.pose = Pose((1.0, 2.0, 3.0), (0.0, 0.0, math.sin(eighth), math.cos(eighth)))
    reach = 0.4 * half
    np.testing.assert_allclose(box.bounds.lower, (1.0 - reach, 2.0 - reach, 2.8), atol=1e-9)
    np.testing.assert_allclose(box.bounds.size, (2 * reach, 2 * reach, 0.4), atol=1e-9)
    ball = world.add_sphere(0.3, (0.0, 0.0, 1.0), mass=1.0)
    np.testing.assert_allclose((ball.bounds.lower, ball.bounds.upper), ((-0.3, -0.3, 0.7), (0.3, 0.3, 1.3)))
    floor = world.add_plane()
    assert floor.bounds.upper.tolist() == [math.inf, math.inf, 0.0]
    worlds = Worlds(world, 3)
    worlds[ball].pose = np.array([(0, 0, 1, 0, 0, 0, 1), (1, 0, 1, 0, 0, 0, 1), (0, 2, 1, 0, 0, 0, 1)], float)
    np.testing.assert_allclose(worlds[ball].bounds.centre, [(0, 0, 1), (1, 0, 1), (0, 2, 1)], atol=1e-12)
    np.testing.assert_allclose(worlds[box].bounds.lower[1], box.bounds.lower, atol=1e-12)


def test_bounds_of_a_soft_body_are_those_of_its_nodes_in_each_world() -> None:
    world = World(gravity=(0.0, 0.0, -9.81))
    cloth = world.load_cloth(size=(0.2, 0.2), cells=(2, 2), position=(0.0, 0.0, 1.0))
    worlds = Worlds(world, 2)
    worlds.step(10)
    found, nodes = worlds[cloth].bounds, worlds[cloth].nodes
    assert found.lower.shape == (2, 3)
    assert found.lower == pytest.approx(nodes.min(axis=1))
    assert found.upper == pytest.approx(nodes.max(axis=1))
    assert worlds.extract(1).bodies[cloth.id].bounds.lower == pytest.approx(found.lower[1])
