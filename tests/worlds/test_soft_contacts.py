"""Contacts of soft bodies in many worlds: those that each world alone lists."""

from __future__ import annotations

import numpy as np
import pytest
from tests.soft.scenes import rigid, world

from carom import Body, Camera, World, Worlds
from carom.description import Plane, Sphere

COUNT, STEPS = 3, 50


@pytest.fixture
def cloth() -> tuple[World, Body, Body, Body]:
    """Cloth over a ball on a plane."""
    scene = world()
    floor = rigid(scene, Plane())
    ball = rigid(scene, Sphere(0.12), 0.5, (0.0, 0.0, 0.121))
    return scene, floor, ball, scene.load_cloth((0.5, 0.5), (8, 8), (0.0, 0.0, 0.26))


def test_contacts_of_cloth_are_those_of_each_world(cloth: tuple[World, Body, Body, Body]) -> None:
    scene, floor, ball, sheet = cloth
    worlds = Worlds(scene, COUNT)
    worlds[sheet].nodes[2, :, 2] += 2.0
    lone = [worlds.extract(number) for number in range(COUNT)]
    worlds.step(STEPS)
    found = worlds.contacts(ball, sheet)
    assert found.touching.tolist() == [True, True, False]
    assert found.number[2] == 0
    for number, one in enumerate(lone[:2]):
        one.step(STEPS)
        count, columns = one.queries().contact_columns(ball.id, -2, sheet.id, -2, one.parameters.substep_time)
        # A lone world also lists contacts of faces; in many, their forces are shared among nodes. Shares of
        # nodes that are not near the ball are missing, as at step 40; there are none at this step.
        assert found.number[number] > 0
        assert count > 0
        normal, along, friction, across = (np.array(list(columns[k])[:count]) for k in (6, 8, 9, 10))
        force = (along[:, None] * normal + friction[:, None] * across).sum(axis=0)
        np.testing.assert_allclose(found.forces[number], force, atol=1e-9)
        assert found.forces[number, 2] < 0.0
    np.testing.assert_allclose(worlds.contacts(sheet, ball).forces, -found.forces, atol=1e-12)
    assert worlds.contacts(sheet).number[0] >= found.number[0]
    # What the ball lies on is there as well as what lies on it.
    alone = worlds.contacts(ball, floor)
    assert alone.touching.all()
    whole = worlds.contacts(ball)
    np.testing.assert_array_equal(whole.number, alone.number + found.number)
    np.testing.assert_allclose(whole.forces, alone.forces + found.forces, atol=1e-12)
    assert worlds.links_in_contact(sheet, ball)[:, 0].tolist() == [True, True, False]
    assert worlds.links_in_contact(ball, sheet)[:, 0].tolist() == [True, True, False]


def test_images_show_the_nodes_of_each_world(cloth: tuple[World, Body, Body, Body]) -> None:
    scene, _, _, sheet = cloth
    worlds = Worlds(scene, COUNT)
    worlds[sheet].nodes[1, :, 1] += 0.2
    camera = Camera.with_field_of_view(32, 24, 60.0).look_at((1.0, 0.0, 0.5), (0.0, 0.0, 0.2))
    images = worlds.images(camera)
    for number in range(COUNT):
        alone = camera.capture(worlds.extract(number))
        np.testing.assert_array_equal(images.depth[number], alone.depth)
    assert (images.depth[0] != images.depth[1]).any()
