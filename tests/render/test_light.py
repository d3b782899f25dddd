"""Colours under the light, and shadows."""

from typing import Any

import numpy as np
import pytest
from drawing import add_shape, draw

from carom.description import Box, Material, Plane
from carom.render.appearance import appearance_of
from carom.render.lights import Light
from carom.render.projection import look_at, parallel_projection
from carom.render.renderer import renderer_of
from carom.world.world import World

ABOVE: dict[str, Any] = {"eye": (0.0, 0.0, 4.0), "target": (0.0, 0.0, 0.0)}


def box_colour(light: Light, rgba=(1.0, 1.0, 1.0, 1.0)) -> list[int]:
    """Colour of the upper side of a box."""
    world = World()
    add_shape(world, Box((2.0, 2.0, 1.0)), material=Material("paint", rgba=rgba))
    return draw(world, light=light, **ABOVE).rgba[10, 10].tolist()


@pytest.mark.parametrize("slant", [0.0, 0.5, 1.2])
def test_light_and_colour_multiply(slant):
    direction = (np.sin(slant), 0.0, np.cos(slant))
    light = Light(direction=direction, colour=(1.0, 0.5, 0.25), ambient=0.2, diffuse=0.6, specular=0.0)
    directed = 0.6 * np.cos(slant)
    expected = [
        int(int(255 * tint) * (0.2 + directed * colour))
        for tint, colour in zip((0.8, 0.4, 1.0), light.colour, strict=True)
    ]
    assert box_colour(light, (0.8, 0.4, 1.0, 1.0)) == pytest.approx([*expected, 255], abs=1)


def test_the_length_of_the_direction_does_not_matter():
    assert box_colour(Light(direction=(0.1, 0.2, 0.3))) == box_colour(Light(direction=(10.0, 20.0, 30.0)))


def test_a_surface_that_faces_away_has_only_the_ambient_light():
    assert box_colour(Light(direction=(0.0, 0.0, -1.0), ambient=0.5)) == [127, 127, 127, 255]


def test_colours_stay_in_their_range():
    assert box_colour(Light(ambient=9.0)) == [255, 255, 255, 255]
    assert box_colour(Light(), (3.0, -1.0, 0.0, 1.0))[1:] == [0, 0, 255]


def floor_with_box() -> World:
    """A white floor, and a box that floats 1 m above it."""
    world = World()
    floor = add_shape(world, Plane())
    appearance_of(world).change(floor, -1, texture=-1)
    add_shape(world, Box((0.2, 0.2, 0.1)), (0.0, 0.0, 1.0))
    return world


# One metre below the box parallel light has gone one metre to the side; that of a lamp 3 m away, whose rays
# are flatter up there, nearly two.
@pytest.mark.parametrize(("distance", "shift"), [(3.0, 1.95), (np.inf, 1.0)])
def test_a_box_casts_a_shadow_away_from_the_light(distance, shift):
    light = Light(direction=(-1.0, 0.0, 1.0), distance=distance, shadow=True, shade=0.0)
    view: dict[str, Any] = {
        "eye": (1.0, -0.01, 5.0),
        "target": (1.0, 0.0, 0.0),
        "size": (240, 240),
        "focal": 180.0,
    }
    world = floor_with_box()
    shadowed = draw(world, light=light, **view)
    plain = draw(world, light=Light(direction=(-1.0, 0.0, 1.0)), **view)
    dark = (shadowed.rgba[:, :, 0] < plain.rgba[:, :, 0]) & (shadowed.label == 0)
    rows, columns = np.nonzero(dark)
    assert len(rows) > 10
    x = 1.0 + (columns.mean() - 119.5) / 180.0 * 5.0
    y = (119.5 - rows.mean()) / 180.0 * 5.0
    assert (x, y) == pytest.approx((shift, 0.0), abs=0.1)
    assert np.all(shadowed.rgba[dark][:, 0] == int(255 * light.ambient))


def test_parallel_light_casts_shadows_of_the_same_size():
    light = Light(direction=(0.0, 0.0, 1.0), distance=np.inf, shadow=True, shade=0.0, specular=0.0)
    view: dict[str, Any] = {
        "eye": (0.0, -3.0, 0.5),
        "target": (0.0, 0.0, 0.1),
        "size": (160, 120),
        "focal": 100.0,
    }
    image = draw(floor_with_box(), light=light, **view)
    floor = image.label == 0
    dark = floor & (image.rgba[:, :, 0] < 200)
    columns = np.nonzero(dark)[1]
    # Its front edge is 2.8 m away.
    assert (np.ptp(columns) + 1) / 100.0 * 2.8 == pytest.approx(0.4, abs=0.04)


def test_surfaces_in_the_light_do_not_shade_themselves():
    light = Light(direction=(-1.0, 0.5, 2.0), distance=np.inf, shadow=True, shade=0.0)
    view: dict[str, Any] = {"eye": (1.0, -4.0, 3.0), "target": (0.0, 0.0, 1.0), "focal": 100.0}
    world = floor_with_box()
    box = draw(world, light=light, **view).label == 1
    with_shadows = draw(world, light=light, **view).rgba[box]
    without = draw(world, light=Light(direction=light.direction), **view).rgba[box]
    assert np.mean(with_shadows == without) > 0.97


def test_a_projector_casts_the_texture():
    world = World()
    box = add_shape(world, Box((2.0, 2.0, 1.0)))
    halves = np.array([[[255, 0, 0], [0, 255, 0]]], dtype=np.uint8)
    appearance = appearance_of(world)
    appearance.change(box, -1, texture=appearance.textures.add(halves))
    # u = x + 0.5: the left half of the texture falls on -0.5 < x < 0, the right half on 0 < x < 0.5.
    projector = np.eye(4)
    projector[0, 3] = 0.5
    view = look_at((0.0, 0.0, 4.0), (0.0, 0.0, 0.0))
    image = renderer_of(world).draw(
        world, view, parallel_projection(0.45, 0.1, 10.0), 20, 20, Light(), projector
    )
    red, green = image.rgba[:, :, 0] > 100, image.rgba[:, :, 1] > 100
    assert red.mean() == pytest.approx(0.5, abs=0.06)
    assert green.mean() == pytest.approx(0.5, abs=0.06)


@pytest.mark.parametrize(
    "options",
    [
        {"direction": (0.0, 0.0, 0.0)},
        {"direction": (np.nan, 0.0, 1.0)},
        {"colour": (np.inf, 0.0, 0.0)},
        {"ambient": np.nan},
        {"distance": np.nan},
        {"distance": -1.0},
    ],
)
def test_lights_that_make_no_sense_are_refused(options):
    with pytest.raises(ValueError):
        Light(**options)


@pytest.mark.parametrize("distance", [0.0, 1e-9, 1e9])
def test_lamps_anywhere_give_an_image(distance):
    light = Light(direction=(0.0, 0.0, 1.0), distance=distance, shadow=True)
    assert set(np.unique(draw(floor_with_box(), light=light, **ABOVE).label)) == {0, 1}
