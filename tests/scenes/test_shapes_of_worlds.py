"""Bodies of one shape that a world makes: where they come to rest, what they weigh, how they look."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from carom import Body, Camera, World
from carom.errors import DescriptionError
from carom.render.lights import Light

GRAVITY = 9.81
BRIGHT = Light(ambient=1.0, diffuse=0.0, specular=0.0)

CUBE = """
v 0 0 0
v 2 0 0
v 0 2 0
v 2 2 0
v 0 0 2
v 2 0 2
v 0 2 2
v 2 2 2
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
"""


@pytest.fixture
def world() -> World:
    world = World()
    world.gravity = (0.0, 0.0, -GRAVITY)
    return world


@pytest.fixture
def cube(tmp_path: Path) -> Path:
    """A cube with edges of 2 m, whose corner is at the origin."""
    file = tmp_path / "cube.obj"
    file.write_text(CUBE)
    return file


Add = Callable[[World, float], Body]

SHAPES: dict[str, tuple[Add, float, tuple[float, float, float]]] = {
    # How to add a body of a mass, its height at rest on a floor, its moments for each kilogram.
    "box": (
        lambda world, mass: world.add_box((0.1, 0.2, 0.3), (0.0, 0.0, 0.4), mass=mass),
        0.3,
        (0.13 / 3.0, 0.1 / 3.0, 0.05 / 3.0),
    ),
    "sphere": (
        lambda world, mass: world.add_sphere(0.2, (0.0, 0.0, 0.3), mass=mass),
        0.2,
        (0.016, 0.016, 0.016),
    ),
    "cylinder": (
        lambda world, mass: world.add_cylinder(0.2, 0.6, (0.0, 0.0, 0.4), mass=mass),
        0.3,
        (0.04, 0.04, 0.02),
    ),
    "capsule": (
        lambda world, mass: world.add_capsule(
            0.1, 0.4, (0.0, 0.0, 0.2), (0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5)), mass=mass
        ),
        0.1,
        # Of the tube and the ball of which it consists, whose volumes are 0.004 π and 0.004 π / 3.
        (
            (0.004 * (0.0025 + 0.04 / 3.0) + 0.004 / 3.0 * (0.004 + 0.04 + 0.015)) / (0.004 + 0.004 / 3.0),
            (0.004 * (0.0025 + 0.04 / 3.0) + 0.004 / 3.0 * (0.004 + 0.04 + 0.015)) / (0.004 + 0.004 / 3.0),
            (0.004 * 0.005 + 0.004 / 3.0 * 0.004) / (0.004 + 0.004 / 3.0),
        ),
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_shape_comes_to_rest_on_a_floor(world: World, shape: str) -> None:
    add, height, moments = SHAPES[shape]
    floor = world.add_plane()
    body = add(world, 2.5)
    assert (floor.name, body.name) == ("plane", shape)
    assert body.links.base.mass == 2.5
    assert body.links.base.inertia == pytest.approx(2.5 * np.array(moments), rel=1e-12)
    assert not body.fixed_base
    assert floor.fixed_base
    world.step(480)
    assert body.links.base.pose.position == pytest.approx([0.0, 0.0, height], abs=2e-3)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_shape_without_mass_is_fixed(world: World, shape: str) -> None:
    body = SHAPES[shape][0](world, 0.0)
    start = body.links.base.pose.position
    world.step(50)
    assert body.fixed_base
    assert body.links.base.pose.position == pytest.approx(start, abs=0.0)


def test_a_falling_sphere_is_not_damped(world: World) -> None:
    ball = world.add_sphere(0.1, (0.0, 0.0, 100.0))
    world.step(240)
    assert ball.links.base.velocity.linear[2] == pytest.approx(-GRAVITY, rel=1e-12)


def test_friction_and_restitution(world: World) -> None:
    world.add_plane(friction=1.0, restitution=1.0)
    slides, sticks = (
        world.add_box((0.1, 0.1, 0.1), (0.0, y, 0.1), friction=friction)
        for y, friction in ((0.0, 0.0), (1.0, 1.0))
    )
    bounces = world.add_sphere(0.1, (0.0, 2.0, 1.0), restitution=0.9)
    for box in (slides, sticks):
        box.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    highest = 0.0
    for number in range(240):
        world.step()
        if number > 150:
            highest = max(highest, float(bounces.links.base.pose.position[2]))
    assert slides.links.base.pose.position[0] == pytest.approx(1.0, abs=0.02)
    assert sticks.links.base.pose.position[0] < 0.1
    assert 0.5 < highest < 1.0


def test_nothing_bounces_unless_it_is_told_to(world: World, cube: Path) -> None:
    bodies = [add(world, 1.0) for add, _, _ in SHAPES.values()]
    bodies += [world.add_plane(), world.add_heightfield(np.zeros((3, 3))), world.add_mesh(cube)]
    assert [body.dynamics(-1).restitution for body in bodies] == [0.0] * 7


def test_colours(world: World) -> None:
    world.add_box((0.2, 0.2, 0.2), (0.0, -0.5, 0.0), mass=0.0, colour=(1.0, 0.0, 0.0))
    world.add_sphere(0.2, (0.0, 0.5, 0.0), mass=0.0, colour=(0.0, 0.0, 1.0, 1.0))
    camera = Camera.with_field_of_view(60, 40, 60.0, light=BRIGHT)
    image = camera.look_at((2.0, 0.0, 0.0), (0.0, 0.0, 0.0)).capture(world)
    assert np.unique(image.colour[image.mask("box")], axis=0).tolist() == [[255, 0, 0]]
    assert np.unique(image.colour[image.mask("sphere")], axis=0).tolist() == [[0, 0, 255]]


def test_a_slanting_plane(world: World) -> None:
    world.add_plane((0.0, 0.0, 1.0), (0.0, -2.0, 2.0), friction=0.0)
    ball = world.add_sphere(0.1, (0.0, 0.0, 1.0 + 0.1 * np.sqrt(2.0)), friction=0.0)
    world.step(240)
    x, y, z = ball.links.base.pose.position
    assert (x, z - 1.0 - 0.1 * np.sqrt(2.0)) == pytest.approx((0.0, y), abs=5e-3)
    assert y == pytest.approx(-0.25 * GRAVITY, rel=0.02)


def test_terrain(world: World) -> None:
    heights = np.zeros((5, 7))
    heights[:, 4:] = 0.5
    world.add_heightfield(heights, (0.5, 0.4), (1.0, 0.0, 0.2))
    low, high = (world.add_sphere(0.1, (x, 0.1, 1.0)) for x in (0.3, 2.2))
    world.step(480)
    assert low.links.base.pose.position[2] == pytest.approx(0.3, abs=5e-3)
    assert high.links.base.pose.position[2] == pytest.approx(0.8, abs=5e-3)


def test_a_mesh_turns_about_its_centre(world: World, cube: Path) -> None:
    body = world.add_mesh(cube, (0.0, 0.0, 5.0), scale=0.5, mass=3.0)
    assert body.name == "cube"
    assert body.links.base.inertial_frame.position == pytest.approx((0.5, 0.5, 0.5), abs=1e-12)
    assert body.links.base.inertia == pytest.approx([0.5, 0.5, 0.5], rel=1e-9)
    assert body.links.base.pose.position == pytest.approx([0.0, 0.0, 5.0], abs=1e-12)
    world.add_plane()
    world.step(480)
    assert body.links.base.inertial_pose.position[2] == pytest.approx(0.5, abs=5e-3)


def test_a_concave_mesh_is_scenery(world: World, cube: Path) -> None:
    body = world.add_mesh(cube, mass=0.0, concave=True, name="rock")
    ball = world.add_sphere(0.1, (1.0, 1.0, 2.2))
    world.step(240)
    assert body.name == "rock"
    assert ball.links.base.pose.position[2] == pytest.approx(2.1, abs=5e-3)


@pytest.mark.parametrize(
    ("add", "message"),
    [
        (lambda world, _: world.add_box((0.1, 0.0, 0.1)), "half_extents"),
        (lambda world, _: world.add_box((0.1, 0.1)), "half_extents"),
        (lambda world, _: world.add_box(mass=-1.0), "mass"),
        (lambda world, _: world.add_box(orientation=(0.0, 0.0, 0.0, 0.0)), "orientation"),
        (lambda world, _: world.add_box(position=(0.0, np.nan, 0.0)), "position"),
        (lambda world, _: world.add_sphere(-1.0), "radius"),
        (lambda world, _: world.add_sphere(colour=(1.0, 2.0, 0.0)), "colour"),
        (lambda world, _: world.add_sphere(colour=(1.0, 0.0)), "colour"),
        (lambda world, _: world.add_sphere(friction=-0.1), "friction"),
        (lambda world, _: world.add_cylinder(0.1, 0.0), "length"),
        (lambda world, _: world.add_capsule(np.inf, 1.0), "radius"),
        (lambda world, _: world.add_plane(normal=(0.0, 0.0, 0.0)), "normal"),
        (lambda world, _: world.add_heightfield([[0.0, 1.0]]), "heights"),
        (lambda world, _: world.add_heightfield([[0.0, 1.0], [0.0, 1.0]], (0.0, 1.0)), "spacing"),
        (lambda world, cube: world.add_mesh(cube, concave=True), "concave"),
        (lambda world, cube: world.add_mesh(cube, scale=-1.0), "scale"),
    ],
)
def test_mistakes_are_named_and_change_nothing(
    world: World, cube: Path, add: Callable[[World, Path], Body], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        add(world, cube)
    assert not world.bodies


def test_a_mesh_that_is_missing(world: World, tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match=r"none\.obj"):
        world.add_mesh(tmp_path / "none.obj")
    assert not world.bodies


@pytest.mark.parametrize(
    "add",
    [
        lambda world: world.add_box((0.1, 0.2, 0.3)),
        lambda world: world.add_sphere(0.2),
        lambda world: world.add_cylinder(0.2, 0.6),
        lambda world: world.add_capsule(0.1, 0.4),
        lambda world: world.add_plane(),
    ],
)
def test_where_nothing_is_said_of_a_place_it_is_the_origin(
    world: World, add: Callable[[World], Body]
) -> None:
    pose = add(world).pose
    assert pose.position.tolist() == [0.0, 0.0, 0.0]
    assert pose.orientation.tolist() == [0.0, 0.0, 0.0, 1.0]
