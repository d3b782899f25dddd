"""Ellipsoids: contacts, distances, rays and bounds in closed form or by brute force; names in files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import carom
from carom.description import Ellipsoid

HALF = (0.3, 0.2, 0.1)
TURNS = np.random.default_rng(4).normal(size=(6, 4))
TURNS /= np.linalg.norm(TURNS, axis=1)[:, None]


def turned(quaternion: np.ndarray) -> np.ndarray:
    """The matrix of a quaternion (x, y, z, w)."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.mark.parametrize("turn", TURNS)
def test_bounds_and_distance_to_a_plane_are_those_of_its_surface(turn: np.ndarray) -> None:
    world = carom.World()
    world.add_plane()
    body = world.add_ellipsoid(HALF, (0.0, 0.0, 1.0), turn.tolist())
    reach = np.linalg.norm(turned(turn) * HALF, axis=1)
    np.testing.assert_allclose(body.bounds.upper - body.bounds.lower, 2.0 * reach, rtol=1e-12)
    (nearest,) = world.nearest(body, world.bodies[0], 2.0)
    assert nearest.distance == pytest.approx(1.0 - reach[2], abs=1e-12)


@pytest.mark.parametrize("turn", TURNS)
def test_it_touches_others_where_its_surface_is(turn: np.ndarray) -> None:
    world = carom.World(gravity=(0.0, 0.0, 0.0))
    ball = world.add_sphere(0.05, (0.5, 0.2, 0.1))
    body = world.add_ellipsoid(HALF, (0.0, 0.0, 0.0), turn.tolist())
    (nearest,) = world.nearest(body, ball, 2.0)
    # The points of the surface nearest to the middle of the ball, by many directions.
    directions = np.random.default_rng(1).normal(size=(400_000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = (directions * HALF) @ turned(turn).T
    expected = np.linalg.norm(points - (0.5, 0.2, 0.1), axis=1).min() - 0.05
    assert nearest.distance == pytest.approx(expected, abs=2e-5)
    assert nearest.distance <= expected + 1e-9


def test_two_that_overlap_are_as_deep_as_along_their_axis() -> None:
    world = carom.World(gravity=(0.0, 0.0, 0.0))
    first = world.add_ellipsoid(HALF)
    second = world.add_ellipsoid(HALF, (0.0, 0.0, 0.199))
    world.step()
    (point,) = world.contacts(first, second)
    assert point.distance == pytest.approx(-0.001, abs=1e-9)
    np.testing.assert_allclose(np.abs(point.normal), (0.0, 0.0, 1.0), atol=1e-5)


@pytest.mark.parametrize("contact", ["compliant", "rigid", "bullet"])
def test_it_rests_where_it_is_flattest(contact: str) -> None:
    world = carom.World(gravity=(0.0, 0.0, -9.81), contact=contact)
    world.add_plane()
    body = world.add_ellipsoid(HALF, (0.0, 0.0, 0.12))
    world.step(2000)
    assert body.pose.position[2] == pytest.approx(0.1, abs=2e-3)


def test_rays_meet_its_surface() -> None:
    world = carom.World()
    turn = TURNS[0]
    body = world.add_ellipsoid(HALF, (1.0, 2.0, 3.0), turn.tolist())
    random = np.random.default_rng(2)
    starts = random.normal(size=(200, 3))
    starts = 2.0 * starts / np.linalg.norm(starts, axis=1)[:, None]
    ends = random.uniform(-0.2, 0.2, (200, 3)) - starts
    place = np.array((1.0, 2.0, 3.0))
    hits = world.rays(starts + place, ends + place)
    matrix = turned(turn)
    origin, way = (starts @ matrix) / HALF, ((ends - starts) @ matrix) / HALF
    a, b, c = (way * way).sum(1), (origin * way).sum(1), (origin * origin).sum(1) - 1.0
    root = b * b - a * c
    met = root > 1e-9
    expected = (-b[met] - np.sqrt(root[met])) / a[met]
    assert 100 < met.sum() < 200
    np.testing.assert_allclose(np.asarray(hits.fractions)[met], expected, atol=1e-12)
    outward = ((origin + way * ((-b - np.sqrt(np.maximum(root, 0.0))) / a)[:, None]) / HALF) @ matrix.T
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    np.testing.assert_allclose(np.asarray(hits.normals)[met], outward[met], atol=1e-9)
    assert body.bounds.upper[0] > 1.0


def test_files_have_it(tmp_path: Path) -> None:
    world = carom.World()
    geom = '<geom type="ellipsoid" size=".3 .2 .1"/>'
    world.load(f"<mujoco><worldbody><body><freejoint/>{geom}</body></worldbody></mujoco>")
    assert world.bodies[-1].shapes[0].geometry == Ellipsoid(HALF)
    file = tmp_path / "world.sdf"
    shape = "<geometry><ellipsoid><radii>.3 .2 .1</radii></ellipsoid></geometry>"
    link = f'<link name="a"><collision name="c">{shape}</collision></link>'
    file.write_text(f'<sdf version="1.9"><model name="m">{link}</model></sdf>')
    other = carom.World()
    other.load(file)
    assert other.bodies[-1].shapes[0].geometry == Ellipsoid(HALF)


def test_its_size_can_be_set() -> None:
    world = carom.World()
    world.add_plane()
    body = world.add_ellipsoid(HALF, (0.0, 0.0, 1.0))
    body.shapes[0].size = (0.2, 0.4, 0.8)
    assert body.shapes[0].size == pytest.approx((0.2, 0.4, 0.8))
    np.testing.assert_allclose(body.bounds.upper - body.bounds.lower, (0.2, 0.4, 0.8))
    (nearest,) = world.nearest(body, world.bodies[0], 2.0)
    assert nearest.distance == pytest.approx(0.6, abs=1e-12)
    with pytest.raises(NotImplementedError, match="Ellipsoid, can't differ between worlds"):
        carom.Worlds(world, 2)[body].shapes[0].size = 1.0
