"""Rays at shapes in random poses against distance functions and single triangles, to 1e-6."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from tests.collision.scene import Scene, box, capsule, cylinder, hull, plane, sphere, triangles

RNG = np.random.default_rng(23)
RAYS = 400


def beyond(point: np.ndarray, size: tuple[float, ...]) -> float:
    """Signed distance of a point whose coordinates may be as large as `size`."""
    over = np.abs(point) - size
    return float(np.linalg.norm(np.maximum(over, 0.0)) + min(over.max(), 0.0))


# Signed distance of a point from the shape in its frame.
ROUND = {
    "sphere": (sphere(0.3), lambda p: float(np.linalg.norm(p)) - 0.3),
    "box": (box((0.2, 0.3, 0.1)), lambda p: beyond(p, (0.2, 0.3, 0.1))),
    "capsule": (
        capsule(0.2, 0.3),
        lambda p: float(np.linalg.norm(p - (0, 0, np.clip(p[2], -0.3, 0.3)))) - 0.2,
    ),
    "cylinder": (
        cylinder(0.2, 0.3),
        lambda p: beyond(np.array([np.hypot(p[0], p[1]), p[2]]), (0.2, 0.3)),
    ),
    "plane": (plane((0.6, 0.0, 0.8)), lambda p: float(p @ (0.6, 0.0, 0.8))),
}

POINTS = RNG.normal(size=(30, 3)) * (0.2, 0.3, 0.1)
SOLID = ConvexHull(POINTS)
HEIGHTS = RNG.normal(size=(6, 5)) * 0.1
BUMPS = np.array([(x - 2.0, y - 2.5, HEIGHTS[y, x]) for y in range(6) for x in range(5)]) * (0.3, 0.3, 1.0)
CELLS = [x + 5 * y for y in range(5) for x in range(4)]
FACES = np.array([face for a in CELLS for face in ((a, a + 1, a + 5), (a + 1, a + 6, a + 5))])
FLAT = {
    "hull": (hull(POINTS), POINTS[SOLID.simplices]),
    "mesh": (triangles(BUMPS, FACES), BUMPS[FACES]),
}


def random_rays() -> tuple[np.ndarray, np.ndarray, np.ndarray, Rotation]:
    """Starts, ends, and a pose."""
    starts = RNG.normal(size=(RAYS, 3))
    starts *= 1.5 / np.linalg.norm(starts, axis=1)[:, None]
    return starts, -starts + RNG.normal(size=(RAYS, 3)) * 0.4, RNG.normal(size=3), Rotation.random(None, RNG)


def cast(shape, starts, ends, position, turn):
    """Fractions of hits, 1 for none, of rays given in the frame of the shape."""
    scene = Scene([shape])
    scene.place(0, position, turn.as_quat())
    _, fraction, _ = scene.rays(turn.apply(starts) + position, turn.apply(ends) + position)
    return fraction


def march(distance, start: np.ndarray, end: np.ndarray) -> float:
    """Fraction of the first hit of a distance function by going as far as nothing can be; 1 for none."""
    along, length, gone = end - start, float(np.linalg.norm(end - start)), 0.0
    for _ in range(3000):
        free = distance(start + along * (gone / length))
        gone += free
        if free < 1e-10 or gone > length:
            break
    return min(gone / length, 1.0)


@pytest.mark.parametrize("name", ROUND)
def test_rays_at_round_shapes(name: str) -> None:
    shape, distance = ROUND[name]
    starts, ends, position, turn = random_rays()
    outside = np.array([distance(start) > 0 for start in starts])
    starts, ends = starts[outside], ends[outside]
    expected = np.array([march(distance, start, end) for start, end in zip(starts, ends, strict=True)])
    fraction = cast(shape, starts, ends, position, turn)
    assert (expected < 1.0).sum() > 50
    # A ray that grazes a shape hits it where it first comes within a millimetre.
    grazes = fraction < expected - 1e-6
    assert grazes.mean() < 0.05
    rays = zip(starts[grazes], ends[grazes], fraction[grazes], strict=True)
    assert all(0.0 < distance(start + at * (end - start)) < 1.001e-3 for start, end, at in rays)
    assert_allclose(fraction[~grazes], expected[~grazes], rtol=0, atol=1e-6)


def meet(start: np.ndarray, end: np.ndarray, corners: np.ndarray) -> float:
    """Fraction of the first hit of triangles (n, 3, 3), 1 for none."""
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    fractions = [1.0]
    for origin, first, second in zip(a, ab, ac, strict=True):
        matrix = np.stack([first, second, start - end], axis=1)
        if abs(np.linalg.det(matrix)) > 1e-14:
            u, v, t = np.linalg.solve(matrix, start - origin)
            if min(u, v) >= 0 and u + v <= 1 and 0 <= t <= 1:
                fractions.append(float(t))
    return min(fractions)


@pytest.mark.parametrize("name", FLAT)
def test_rays_at_flat_faces(name: str) -> None:
    shape, corners = FLAT[name]
    starts, ends, position, turn = random_rays()
    expected = np.array([meet(start, end, corners) for start, end in zip(starts, ends, strict=True)])
    fraction = cast(shape, starts, ends, position, turn)
    assert (expected < 1.0).sum() > 50
    assert_allclose(fraction, expected, rtol=0, atol=1e-6)
