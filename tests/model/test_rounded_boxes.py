"""Rounded boxes: all points near a smaller box. Closed forms, and brute force by their distance function."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import carom
from carom.description import Box, Collision, Link, Robot, RoundedBox, Sphere
from carom.editing.elements import new, section
from carom.editing.from_shapes import ShapeWriter
from carom.editing.losses import Losses
from carom.errors import DescriptionError
from carom.formats.urdf_writer import urdf_text

HALF, RADIUS = (0.3, 0.2, 0.25), 0.08
SHAPE = RoundedBox(HALF, RADIUS)


def distance(points: np.ndarray, half: tuple[float, ...] = HALF, radius: float = RADIUS) -> np.ndarray:
    """Signed distance of points (n, 3) from a rounded box."""
    beyond = np.abs(points) - (np.array(half) - radius)
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return outside + np.minimum(beyond.max(axis=1), 0.0) - radius


def test_volume_and_moments_are_those_of_its_points():
    points = np.random.default_rng(3).uniform(-1.0, 1.0, (2_000_000, 3)) * HALF
    inside = points[distance(points) <= 0.0]
    solid = SHAPE.solid()
    assert solid.measure == pytest.approx(8.0 * np.prod(HALF) * len(inside) / len(points), rel=1e-3)
    spread = (inside * inside).mean(axis=0)
    np.testing.assert_allclose(np.diag(solid.tensor), spread.sum() - spread, rtol=2e-3)


def test_without_a_box_within_it_is_a_ball_and_with_a_small_radius_a_box():
    ball, box = RoundedBox((0.2, 0.2, 0.2), 0.2).solid(), RoundedBox(HALF, 1e-6).solid()
    assert ball.measure == pytest.approx(Sphere(0.2).volume(), rel=1e-6)
    np.testing.assert_allclose(ball.tensor, Sphere(0.2).solid().tensor, rtol=1e-6)
    assert box.measure == pytest.approx(Box(HALF).volume(), rel=1e-6)
    np.testing.assert_allclose(box.tensor, Box(HALF).solid().tensor, rtol=1e-5)


def test_what_is_drawn_lies_on_its_surface():
    surface = SHAPE.surface(48)
    np.testing.assert_allclose(distance(surface.positions.astype(float)), 0.0, atol=1e-7)
    ahead = distance(surface.positions + 0.01 * surface.normals)
    np.testing.assert_allclose(ahead, 0.01, atol=1e-6)


def test_a_world_has_its_mass_bounds_and_size():
    world = carom.World()
    body = world.add_box(HALF, (1.0, 2.0, 3.0), radius=RADIUS, mass=2.0)
    solid = SHAPE.solid()
    np.testing.assert_allclose(body.links.base.inertia, 2.0 * np.diag(solid.tensor), rtol=1e-12)
    np.testing.assert_allclose(body.bounds.lower, np.array((1.0, 2.0, 3.0)) - HALF, rtol=1e-12)
    np.testing.assert_allclose(body.bounds.upper, np.array((1.0, 2.0, 3.0)) + HALF, rtol=1e-12)


@pytest.mark.parametrize("radius", [-0.1, 0.21, np.nan])
def test_radii_that_do_not_fit_are_refused(radius: float):
    with pytest.raises(ValueError, match="radius"):
        carom.World().add_box(HALF, radius=radius)


def test_rays_meet_the_round_surface():
    world = carom.World()
    world.add_box(HALF, radius=RADIUS, mass=0.0)
    random = np.random.default_rng(4)
    starts = random.normal(size=(300, 3))
    starts *= (random.uniform(0.45, 1.5, 300) / np.linalg.norm(starts, axis=1))[:, None]
    ends = -starts + random.uniform(-0.7, 0.7, (300, 3))
    hits = world.rays(starts, ends)
    marched = np.zeros(300)
    for _ in range(500):
        now = starts + marched[:, None] * (ends - starts)
        marched = np.minimum(marched + distance(now) / np.linalg.norm(ends - starts, axis=1), 2.0)
    expected = marched <= 1.0
    least = np.array(
        [
            distance(s + np.linspace(0, 1, 400)[:, None] * (e - s)).min()
            for s, e in zip(starts, ends, strict=True)
        ]
    )
    clear = np.abs(least) > 2e-3
    fractions = np.asarray(hits.fractions)
    np.testing.assert_array_equal((fractions < 1.0)[clear], expected[clear])
    # Steep ones only: what goes along a surface meets it a millimetre before, as with all shapes.
    both = clear & expected & (least < -0.02)
    assert both.sum() > 50
    np.testing.assert_allclose(fractions[both], marched[both], atol=1e-6)


DOWN = (0.0, 0.0, -9.81)
ADD_OTHERS = {
    "sphere": lambda world: world.add_sphere(0.1, (0.0, 0.0, 5.0), mass=0.0),
    "box": lambda world: world.add_box((0.1, 0.15, 0.2), (0.0, 0.0, 5.0), mass=0.0),
    "cylinder": lambda world: world.add_cylinder(0.1, 0.3, (0.0, 0.0, 5.0), mass=0.0),
    "capsule": lambda world: world.add_capsule(0.1, 0.3, (0.0, 0.0, 5.0), mass=0.0),
    "rounded box": lambda world: world.add_box((0.1, 0.15, 0.2), (0.0, 0.0, 5.0), radius=0.05, mass=0.0),
    "plane": lambda world: world.add_plane((0.0, 0.0, 5.0)),
    "height field": lambda world: world.add_heightfield(np.full((5, 5), 5.0)),
}


@pytest.mark.parametrize("other", ADD_OTHERS)
def test_it_falls_onto_every_shape_and_comes_to_rest_there(other: str):
    """Its lower face on their upper side, 0.25 m below its centre."""
    world = carom.World(gravity=DOWN)
    ADD_OTHERS[other](world)
    top = {"sphere": 0.1, "box": 0.2, "cylinder": 0.15, "capsule": 0.25, "rounded box": 0.2}.get(other, 0.0)
    body = world.add_box(HALF, (0.0, 0.0, 5.0 + top + HALF[2] + 0.01), radius=RADIUS, friction=1.0)
    for _ in range(120):
        world.step()
    assert body.pose.position[2] == pytest.approx(5.0 + top + HALF[2], abs=2e-3)


def test_balls_are_as_far_from_it_as_its_distance_function_says():
    world = carom.World()
    box = world.add_box(HALF, radius=RADIUS, mass=0.0)
    ball = world.add_sphere(0.05)
    for place in np.random.default_rng(6).uniform(-0.5, 0.5, (60, 3)):
        ball.pose = carom.Pose(place)
        found = world.nearest(box, ball)[0].distance
        apart = float(distance(place[None])[0]) - 0.05
        assert found == pytest.approx(apart, abs=1e-9 if apart > -0.05 - RADIUS else 5e-3)


def test_it_stands_on_its_edge_as_far_as_it_is_round():
    """Turned so that its edge is below, its lowest point is the radius under the edge of the box within."""
    world = carom.World()
    world.add_plane()
    turn = (np.sin(np.pi / 8.0), 0.0, 0.0, np.cos(np.pi / 8.0))
    half, radius = (0.3, 0.2, 0.2), 0.08
    low = np.sqrt(2.0) * (0.2 - radius) + radius
    body = world.add_box(half, (0.0, 0.0, low + 0.02), turn, radius=radius)
    near = world.nearest(body, world.bodies[0], max_distance=1.0)[0]
    assert near.distance == pytest.approx(0.02, abs=1e-9)


def test_cloth_lies_on_it():
    world = carom.World(gravity=DOWN)
    world.add_box((0.3, 0.3, 0.2), radius=0.1, mass=0.0)
    cloth = world.load_cloth((1.0, 1.0), (20, 20), (0.0, 0.0, 0.24))
    for _ in range(200):
        world.step()
    apart = distance(np.asarray(cloth.nodes), (0.3, 0.3, 0.2), 0.1)
    assert -0.01 < apart.min() < 0.02


def test_margins_of_scripts_do_not_change_its_radius():
    world = carom.World()
    body = world.add_box(HALF, radius=RADIUS)
    body.change_dynamics(-1, collision_margin=0.2)
    assert world.contact_arrays.shapes.table.numpy["shape_margin"][0, 0] == RADIUS


def test_urdf_refuses_it(tmp_path: Path):
    link = Link("base", collisions=(Collision(SHAPE),))
    with pytest.raises(DescriptionError, match="link 'base' has a shape that URDF does not have: RoundedBox"):
        urdf_text(Robot("one", (link,), ()), tmp_path)


def test_mjcf_gets_its_facets_and_says_so():
    losses = Losses(Path("one.urdf"))
    root = new("mujoco")
    (geom,) = ShapeWriter(root, losses).geoms(Link("base", collisions=(Collision(SHAPE),)))
    assert geom.attributes["type"] == "mesh"
    vertices = np.array(section(root, "asset").children[0].attributes["vertex"].split(), float).reshape(-1, 3)
    np.testing.assert_allclose(np.abs(vertices).max(axis=0), HALF, rtol=1e-6)
    assert "its facets collide, by their hull" in [it.consequence for it in losses.list()]


def test_usd_gets_its_facets_and_says_so(tmp_path: Path):
    pytest.importorskip("pxr")
    from carom.formats.usd.writer import write_usd

    file = tmp_path / "one.usda"
    lost = write_usd(Robot("one", (Link("base", collisions=(Collision(SHAPE),)),), ()), file)
    assert "its facets collide, by their hull" in [it.consequence for it in lost]
    world = carom.World()
    world.load(file)
    assert world.bodies[0].bounds.size == pytest.approx(2.0 * np.array(HALF), rel=1e-6)


def test_scaling_keeps_its_edges_round():
    with pytest.raises(ValueError, match="one factor"):
        SHAPE.scaled((1.0, 2.0, 1.0))
