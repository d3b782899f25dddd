"""A ray that starts in the margin of a shape, towards its core, hits at once; the normal comes from the core.

The margin of a ball goes to its middle, that of a capsule to its axis; boxes and cylinders have 1 mm.
PyBullet follows this in all but 2 of 12,000 random rays, which graze a cylinder.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from tests.collision.scene import Scene, hull

import pybullet as p

MARGIN = 1e-3
Place = Callable[[np.ndarray], np.ndarray]


def middle(start: np.ndarray) -> np.ndarray:
    return 0.0 * start


def axis(start: np.ndarray) -> np.ndarray:
    return np.array([0.0, 0.0, np.clip(start[2], -0.1, 0.1)])


def inner_box(start: np.ndarray) -> np.ndarray:
    return np.clip(start, MARGIN - 0.1, 0.1 - MARGIN)


def inner_cylinder(start: np.ndarray) -> np.ndarray:
    aside = np.hypot(start[0], start[1])
    shrink = min(1.0, (0.1 - MARGIN) / aside)
    return np.array([start[0] * shrink, start[1] * shrink, np.clip(start[2], MARGIN - 0.1, 0.1 - MARGIN)])


SHAPES: dict[str, tuple[dict[str, Any], Place, np.ndarray]] = {
    "ball": ({"shapeType": p.GEOM_SPHERE, "radius": 0.1}, middle, np.array([0.02, -0.03, 0.05])),
    "capsule": (
        {"shapeType": p.GEOM_CAPSULE, "radius": 0.1, "height": 0.2},
        axis,
        np.array([0.05, 0.01, 0.12]),
    ),
    "box": (
        {"shapeType": p.GEOM_BOX, "halfExtents": [0.1] * 3},
        inner_box,
        np.array([0.0995, 0.03, -0.09]),
    ),
    "cylinder": (
        {"shapeType": p.GEOM_CYLINDER, "radius": 0.1, "height": 0.2},
        inner_cylinder,
        np.array([0.0, 0.0997, 0.02]),
    ),
}


@pytest.fixture(scope="module", params=SHAPES)
def shape(request: pytest.FixtureRequest) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    arguments, core, start = SHAPES[request.param]
    client = p.connect(p.DIRECT)
    p.createMultiBody(0, p.createCollisionShape(**arguments, physicsClientId=client), physicsClientId=client)
    yield client, start, start - core(start)
    p.disconnect(client)


@given(way=st.tuples(*[st.floats(-1, 1)] * 3))
def test_it_hits_at_once_towards_the_core_and_not_on_the_way_out(
    shape: tuple[int, np.ndarray, np.ndarray], way: tuple[float, float, float]
) -> None:
    client, start, from_core = shape
    towards = float(np.dot(from_core, way)) / float(np.linalg.norm(from_core))
    assume(abs(towards) > 1e-6)
    body, _, fraction, place, normal = p.rayTest(
        start.tolist(), (start + way).tolist(), physicsClientId=client
    )[0]
    assert (body >= 0) == (towards < 0.0)
    if towards < 0.0:
        assert fraction == 0.0
        assert place == pytest.approx(start)
        assert normal == pytest.approx(from_core / np.linalg.norm(from_core))


def test_a_ray_from_the_middle_goes_out() -> None:
    client = p.connect(p.DIRECT)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    assert p.rayTest([0, 0, 0], [1, 0, 0])[0][0] == -1
    p.disconnect(client)


@pytest.mark.parametrize(
    ("start", "towards", "hit"),
    [(0.55, -1.0, True), (0.55, 1.0, False), (0.3, -1.0, False), (0.3, 1.0, False)],
    ids=["in the margin, inwards", "outwards", "in the core", "outwards from there"],
)
def test_the_margin_of_a_hull_is_around_its_faces(start: float, towards: float, hit: bool) -> None:
    corners = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    scene = Scene([hull(corners, margin=0.1)])
    shapes, fractions, normals = scene.rays([[start, 0.1, 0.2]], [[start + 2.0 * towards, 0.1, 0.2]])
    assert shapes.tolist() == [0 if hit else -1]
    if hit:
        assert fractions.tolist() == [0.0]
        assert normals.tolist() == [[1.0, 0.0, 0.0]]
