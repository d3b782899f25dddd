"""Penetration depths by themselves: closed forms, and the hull of all differences by Qhull."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportGeneralTypeIssues=false, reportIndexIssue=false, reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from tests.kernels.convex_cores import (
    Solid,
    box,
    cores_of,
    cylinder,
    differences,
    hull_distance,
    moved,
    point,
    random_polytope,
    segment,
    triangle,
)

from carom.kernels.shapes.cores import Core
from carom.kernels.shapes.polytope import overlap
from carom.kernels.types import (
    Index4,
    Index4Rows,
    Int32,
    RealRows,
    Vector3,
    Vector3Rows,
    Vector4,
    Vector4Rows,
    Vectors3,
    kernel,
    real,
)
from carom.layouts.codes import BOX, CAPSULE, HULL, SPHERE
from carom.layouts.contacts import MAX_CORNERS

# Depths are exact to this [m]; the polytope is grown until its nearest face is nearer to the boundary.
PRECISION = 1e-7


@kernel
def overlap_kernel(
    a: Core,
    b: Core,
    vertex_position: Vectors3,
    points: Vector3Rows,
    points_a: Vector3Rows,
    planes: Vector4Rows,
    faces: Index4Rows,
    edges: Index4Rows,
    start: Vector3,
    common: Vector3,
    answers: RealRows,
):
    """Depth, normal and deepest points of two cores that overlap."""
    depth, normal, on_a, on_b = overlap(
        a, b, vertex_position, points, points_a, planes, faces, edges, 0, start, common, Int32(0)
    )
    answers[0, 0] = depth
    for axis in range(3):
        answers[0, 1 + axis] = normal[axis]
        answers[0, 4 + axis] = on_a[axis]
        answers[0, 7 + axis] = on_b[axis]


def penetration(
    a: Solid, b: Solid, start: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """Depth [m], normal from b towards a, and the deepest points of a and of b."""
    answers = np.zeros((1, 10))
    room = 2 * MAX_CORNERS
    types = (Vector3, Vector3, Vector4, Index4, Index4)
    work = [wp.zeros((1, room), dtype=dtype, device="cpu") for dtype in types]
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    inputs = [*cores_of(a, b), *work, Vector3(*start), Vector3(7.0, 8.0, 9.0), rows]
    wp.launch(overlap_kernel, dim=1, inputs=inputs, device="cpu")
    return answers[0, 0], answers[0, 1:4], answers[0, 4:7], answers[0, 7:]


@pytest.mark.parametrize(
    ("a", "b", "depth", "normal"),
    [
        # A point in a box, nearest to one face.
        (box(0.5, 0.4, 0.3), moved(point(), [0.1, 0.1, 0.2]), 0.1, [0, 0, -1]),
        (box(0.5, 0.4, 0.3), moved(point(), [-0.45, 0.1, 0.1]), 0.05, [1, 0, 0]),
        # Boxes whose faces overlap a little, and whose middles are in one place.
        (box(0.5, 0.4, 0.3), moved(box(0.1, 0.1, 0.1), [0.1, 0.48, 0.1]), 0.02, [0, -1, 0]),
        (box(0.5, 0.4, 0.3), moved(box(0.1, 0.1, 0.05), [0.05, 0.06, 0.07]), 0.28, [0, 0, -1]),
        # An edge in a face.
        (
            box(0.5, 0.5, 0.5),
            moved(box(0.1, 0.1, 0.1), [0.6, 0.0, 0.0], Rotation.from_euler("z", 45, degrees=True)),
            0.1 * np.sqrt(2.0) - 0.1,
            [-1, 0, 0],
        ),
        # A segment's end, and a point in a cylinder.
        (box(0.5, 0.5, 0.5), moved(segment(0.2), [0.1, 0.0, 0.6]), 0.1, [0, 0, -1]),
        (cylinder(0.3, 0.5), moved(point(), [0.25, 0.0, 0.0]), 0.05, [-1, 0, 0]),
        (cylinder(0.3, 0.5), moved(point(), [0.0, 0.1, -0.46]), 0.04, [0, 0, 1]),
    ],
)
def test_closed_forms(a: Solid, b: Solid, depth: float, normal: list[float]) -> None:
    found = penetration(a, b)
    # A round side is approached by a polytope; a plane one is met.
    tolerance = 2e-3 if a.kind == cylinder(1.0, 1.0).kind else 1e-9
    assert found[0] == pytest.approx(depth, abs=PRECISION)
    np.testing.assert_allclose(found[1], normal, atol=tolerance)
    np.testing.assert_allclose(found[2] - found[3], -found[1] * depth, atol=2 * PRECISION)


@settings(max_examples=cases(200), deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([(BOX, BOX), (BOX, HULL), (HULL, BOX), (HULL, HULL), (BOX, SPHERE), (CAPSULE, HULL)]),
)
def test_depths_are_those_of_the_hull_of_all_differences(seed: int, kinds: tuple[int, int]) -> None:
    random = np.random.default_rng(seed)
    a, b = (random_polytope(random, kind) for kind in kinds)
    # A point of each, put in the same place.
    shares = [random.dirichlet(np.ones(len(solid.corners()))) @ solid.corners() for solid in (a, b)]
    b = moved(b, shares[0] - shares[1], Rotation.from_matrix(b.frame))
    depth, normal, on_a, on_b = penetration(a, b, tuple(random.normal(size=3)))
    faces = ConvexHull(differences(a, b)).equations
    assert depth == pytest.approx(-faces[:, 3].max(), abs=PRECISION)
    # Moving a by the depth along the normal parts them, and they touch in these points.
    assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
    assert a.farthest(-normal) + b.farthest(normal) == pytest.approx(depth, abs=1e-9)
    np.testing.assert_allclose(on_a - on_b, -normal * depth, atol=1e-9)
    # Of a face that is met the points are exact; on a flat one nearby they are as near as it is.
    assert hull_distance(a.corners() - on_a) <= 1e-6
    assert hull_distance(b.corners() - on_b) <= 1e-6


@pytest.mark.parametrize("start", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.1)])
def test_flat_sets_have_no_depth_but_a_direction(start: tuple[float, float, float]) -> None:
    square = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]])
    depth, normal, on_a, on_b = penetration(triangle(square), triangle(-square), start)
    assert depth == 0.0
    np.testing.assert_allclose(normal, [0.0, 0.0, np.sign(start[2])], atol=1e-12)
    # There the caller's point stands for both.
    np.testing.assert_array_equal([on_a, on_b], [[7.0, 8.0, 9.0]] * 2)
