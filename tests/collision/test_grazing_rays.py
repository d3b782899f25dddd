"""Rays that graze convex shapes: PyBullet hits what they miss by up to a millimetre."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.scene import Scene, box, hull, sphere, triangles
from tests.collision.test_rays import CORNERS, MAKERS, TENT, TENT_FACES

import pybullet as p

RECORD = json.loads(Path(__file__).with_name("grazing_rays.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", RECORD["shapes"])
def test_grazing_rays_hit_where_they_do_in_pybullet(name: str) -> None:
    record = RECORD["shapes"][name]
    rays, hits = np.array(record["rays"]), np.array(record["hits"], dtype=float)
    scene = Scene([MAKERS[name](position=RECORD["position"], orientation=RECORD["orientation"])])
    shape, fraction, normal = scene.rays(rays[:, :3], rays[:, 3:])
    # Within a few micrometres of a millimetre, and along a face, rounding decides in PyBullet.
    same = (shape >= 0) == (hits[:, 0] > 0)
    assert same.sum() >= len(rays) - 3
    both = same & (shape >= 0)
    assert both.sum() > 20
    assert_allclose(fraction[both], hits[both, 1], rtol=0, atol=2e-3)
    assert np.median(np.abs(fraction - hits[:, 1])[both]) < 1e-4
    # PyBullet rounds edges, which those of these rays that hit exactly meet sharp.
    agreeing = np.abs(normal[both] - hits[both, 2:]).max(axis=1) < 0.01
    assert agreeing.mean() > (0.95 if name in ("sphere", "capsule") else 0.35)


@pytest.mark.parametrize("apart", [-1e-9, -1e-16, 0.0, 1e-16, 1e-9, 1e-6, 5e-4, 9e-4])
@pytest.mark.parametrize("turn", [(0, 0, 0), (0.4, 0.7, 0.2), (1.1, 0, 2.0)])
def test_a_ray_in_the_plane_of_a_face_hits_the_edge(apart: float, turn: tuple[float, float, float]) -> None:
    """0.4 and 1e-6 to 1.4e-3 more in PyBullet, which the rounding of turned axes must not change."""
    orientation = p.getQuaternionFromEuler(turn)
    matrix = np.array(p.getMatrixFromQuaternion(orientation)).reshape(3, 3)
    scene = Scene([box((0.2, 0.3, 0.1), position=(1, 2, 3), orientation=orientation)])
    start, end = ((1, 2, 3) + matrix @ (x, 0, 0.1 + apart) for x in (-1.0, 1.0))
    shape, fraction, _ = scene.rays(start, end)
    assert shape.tolist() == [0]
    assert 0.4 - 1e-9 <= fraction[0] < 0.4015


def test_a_ray_more_than_a_millimetre_away_hits_nothing() -> None:
    scene = Scene([box((0.2, 0.3, 0.1)), sphere(0.1, position=(0, 2, 0)), hull(CORNERS, position=(0, 4, 0))])
    for y in (0, 2, 4):
        shape, _, _ = scene.rays([-1, y, 0.10101], [1, y, 0.10101])
        assert shape.tolist() == [-1]


def test_a_ray_that_starts_beside_a_face_and_goes_along_it_or_away_hits_nothing() -> None:
    scene = Scene([box((0.2, 0.3, 0.1))])
    shape, _, _ = scene.rays([[0, 0, 0.1005]] * 2, [[1, 0, 0.1005], [1, 0, 0.2]])
    assert shape.tolist() == [-1, -1]


def test_a_ray_that_ends_before_it_comes_near_hits_nothing() -> None:
    scene = Scene([box((0.2, 0.3, 0.1))])
    shape, _, _ = scene.rays([-1, 0, 0.1005], [-0.21, 0, 0.1005])
    assert shape.tolist() == [-1]


def test_a_nearer_hit_is_not_replaced_and_the_next_one_is_found() -> None:
    scene = Scene([box((0.1, 0.1, 0.1), position=(x, 0, 0)) for x in (1.0, 0.0)])
    ends = [-1, 0, 0.1005], [3, 0, 0.1005]
    found = [scene.rays(*ends, hit_number=number) for number in range(3)]
    assert [shape[0] for shape, _, _ in found] == [1, 0, -1]
    assert_allclose([fraction[0] for _, fraction, _ in found[:2]], [0.225, 0.475], atol=1e-5)


def test_surfaces_of_triangles_are_hit_exactly() -> None:
    scene = Scene([triangles(TENT, TENT_FACES)])
    shape, _, _ = scene.rays([-2, 0, 0.5005], [2, 0, 0.5005])
    assert shape.tolist() == [-1]
