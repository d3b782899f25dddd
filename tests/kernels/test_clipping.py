"""Clipping of touching faces by itself, against convex polygons by brute force in NumPy."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportGeneralTypeIssues=false, reportArgumentType=false

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp
from scipy.spatial.transform import Rotation
from tests.kernels.convex_cores import Solid, box, hull, moved

from carom.engine.detection_capacity import CANDIDATES
from carom.kernels.shapes.clip import clip_faces
from carom.kernels.shapes.cores import Core
from carom.kernels.structs import Candidate, CandidateRows
from carom.kernels.types import (
    Int32,
    Ints,
    RealRows,
    Vector3,
    Vector3Rows,
    kernel,
    real,
)

UP = np.array([0.0, 0.0, 1.0])
ROOM = 32


@kernel
def clip_faces_kernel(
    core: Core,
    reference: Vector3Rows,
    reference_count: Int32,
    outward: Vector3,
    incident: Vector3Rows,
    incident_count: Int32,
    clipped: Vector3Rows,
    normal: Vector3,
    reference_is_a: Int32,
    radii: RealRows,
    max_distance: real,
    candidates: CandidateRows,
    found: Ints,
):
    """Candidates of two faces, after one that is there already."""
    found[0] = clip_faces(
        core, reference, reference_count, outward, incident, incident_count, clipped, normal, reference_is_a,
        radii[0, 0], radii[0, 1], max_distance, candidates, 0, 1,
    )  # fmt: skip


def clip(
    core: Solid,
    reference: np.ndarray,
    incident: np.ndarray,
    *,
    outward: np.ndarray = UP,
    reference_is_a: bool = False,
    radii: tuple[float, float] = (0.0, 0.0),
    max_distance: float = np.inf,
) -> np.ndarray:
    """Clip the incident face by the reference face, that of b unless said otherwise.

    The contact normal, on b towards a, is that of the reference face.

    Returns:
        (n, 7): point on b, normal, distance.
    """
    polygons = [np.zeros((1, ROOM, 3)) for _ in range(3)]
    for polygon, corners in zip(polygons, (reference, incident), strict=False):
        polygon[0, : len(corners)] = corners
    reference_rows, incident_rows, clipped = (
        wp.array(polygon, dtype=Vector3, device="cpu") for polygon in polygons
    )
    candidates = wp.zeros((1, CANDIDATES), dtype=Candidate, device="cpu")
    found = wp.zeros(1, dtype=Int32, device="cpu")
    inputs = [
        core.core(), reference_rows, len(reference), Vector3(*outward), incident_rows, len(incident), clipped,
        Vector3(*(-outward if reference_is_a else outward)), int(reference_is_a),
        wp.array([radii], dtype=real, device="cpu"), max_distance, candidates, found,
    ]  # fmt: skip
    wp.launch(clip_faces_kernel, dim=1, inputs=inputs, device="cpu")
    left = candidates.numpy()[0]
    rows = np.column_stack([left["point"], left["normal"], left["distance"]])
    assert not rows[0].any()
    return rows[1 : found.numpy()[0]]


def polygon(random: np.random.Generator, corners: int, radius: float, middle: np.ndarray) -> np.ndarray:
    """Corners of a convex polygon in the plane, counter-clockwise (n, 2)."""
    angles = np.sort(random.uniform(0.0, 2.0 * np.pi, corners))
    return middle + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def sides(corners: np.ndarray) -> np.ndarray:
    """Outward normals and offsets of the sides of a polygon: (n, 3)."""
    edges = np.roll(corners, -1, axis=0) - corners
    outward = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    return np.column_stack([outward, (outward * corners).sum(axis=1)])


def common_corners(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Corners of the common part of two polygons: of all crossings of their sides' lines those in both."""
    planes = np.concatenate([sides(a), sides(b)])
    points = [
        np.linalg.solve(planes[[i, j], :2], planes[[i, j], 2])
        for i, j in combinations(range(len(planes)), 2)
        if abs(np.linalg.det(planes[[i, j], :2])) > 1e-9
    ]
    inside = [p for p in points if (planes[:, :2] @ p <= planes[:, 2] + 1e-9).all()]
    return np.array(inside).reshape(-1, 2)


def assert_same_points(found: np.ndarray, expected: np.ndarray) -> None:
    """Each point of one set is one of the other."""
    apart = np.linalg.norm(found[:, None] - expected[None], axis=2).reshape(len(found), len(expected))
    for axis in range(2):
        assert (apart.min(axis=axis, initial=np.inf) < 1e-7).all()


def lifted(corners: np.ndarray, height: float = 0.0) -> np.ndarray:
    return np.column_stack([corners, np.full(len(corners), height)])


@settings(max_examples=cases(200), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 8), st.integers(3, 8), st.floats(0.0, 2.0), st.booleans())
def test_what_is_left_is_the_common_part(
    seed: int, reference_count: int, incident_count: int, apart: float, reference_is_a: bool
) -> None:
    random = np.random.default_rng(seed)
    reference = polygon(random, reference_count, 1.0, np.zeros(2))
    incident = polygon(random, incident_count, random.uniform(0.2, 2.0), random.normal(size=2) * apart)
    # The incident face is clockwise as seen from the reference face: it looks the other way.
    found = clip(
        hull(np.zeros((1, 3))),
        lifted(reference),
        lifted(incident[::-1], 0.1),
        reference_is_a=reference_is_a,
    )
    expected = common_corners(reference, incident)
    if len(expected) < 3:
        # They share next to nothing.
        assert len(found) <= 3
        return
    # On b is what is below; if the reference face is that of a, the incident one is that of b.
    assert_same_points(found[:, :3], lifted(expected, 0.1 if reference_is_a else 0.0))
    np.testing.assert_allclose(found[:, 3:6], np.tile(-UP if reference_is_a else UP, (len(found), 1)))
    np.testing.assert_allclose(found[:, 6], 0.1, atol=1e-12)


@settings(max_examples=cases(100), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 8))
def test_a_box_clips_as_its_face_does(seed: int, incident_count: int) -> None:
    random = np.random.default_rng(seed)
    half = random.uniform(0.3, 1.0, 3)
    turn, middle = Rotation.from_quat(random.normal(size=4)), random.normal(size=3)
    axis, sign = random.integers(3), random.choice([-1.0, 1.0])
    u, v = (axis + 1) % 3, (axis + 2) % 3
    axes = turn.as_matrix()
    outward = sign * axes[:, axis]
    incident = polygon(random, incident_count, 1.0, random.normal(size=2) * 0.5)
    face = middle + outward * half[axis]
    in_world = face + incident @ axes[:, [u, v]].T + outward * 0.2
    # Of the reference face one corner is read, for its height.
    found = clip(moved(box(*half), middle, turn), np.tile(face, (4, 1)), in_world, outward=outward)
    square = np.array([[half[u], half[v]], [-half[u], half[v]], [-half[u], -half[v]], [half[u], -half[v]]])
    expected = common_corners(square, incident)
    if len(expected) >= 3:
        assert_same_points((found[:, :3] - face) @ axes[:, [u, v]], expected)
        np.testing.assert_allclose((found[:, :3] - face) @ outward, 0.0, atol=1e-12)
        np.testing.assert_allclose(found[:, 6], 0.2, atol=1e-12)


SQUARE = lifted(np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]))


@pytest.mark.parametrize(
    ("ends", "left"),
    [
        ([[0.5, 0.0], [-0.5, 0.0]], [[0.5, 0.0], [-0.5, 0.0]]),
        ([[3.0, 0.5], [0.0, 0.5]], [[1.0, 0.5], [0.0, 0.5]]),
        ([[-3.0, 0.0], [3.0, 0.0]], [[-1.0, 0.0], [1.0, 0.0]]),
        ([[0.0, 3.0], [3.0, 0.0]], []),
        ([[0.5, 0.5]], [[0.5, 0.5]]),
        ([[1.5, 0.5]], []),
    ],
)
@pytest.mark.parametrize("core", [hull(np.zeros((1, 3))), box(1.0, 1.0, 0.0)], ids=["hull", "box"])
def test_lines_and_points_are_clipped_too(
    core: Solid, ends: list[list[float]], left: list[list[float]]
) -> None:
    found = clip(core, SQUARE, lifted(np.array(ends), 0.1))
    assert len(found) == len(left)
    assert_same_points(found[:, :3], lifted(np.array(left).reshape(-1, 2)))


def test_distances_are_measured_between_the_rounded_faces() -> None:
    slanted = SQUARE * 0.5 + [[0.0, 0.0, 0.1], [0.0, 0.0, 0.1], [0.0, 0.0, 0.3], [0.0, 0.0, 0.3]]
    found = clip(hull(np.zeros((1, 3))), SQUARE, slanted, radii=(0.02, 0.03))
    np.testing.assert_allclose(found[:, 6], slanted[:, 2] - 0.05, atol=1e-12)
    # On b, rounded by 0.03 above the reference face.
    np.testing.assert_allclose(found[:, 2], 0.03, atol=1e-12)
    below = clip(hull(np.zeros((1, 3))), SQUARE, slanted, radii=(0.02, 0.03), reference_is_a=True)
    np.testing.assert_allclose(below[:, 6], slanted[:, 2] - 0.05, atol=1e-12)
    np.testing.assert_allclose(below[:, 2], slanted[:, 2] - 0.03, atol=1e-12)


def test_what_is_too_far_away_is_left_out() -> None:
    slanted = SQUARE * 0.5 + [[0.0, 0.0, 0.1], [0.0, 0.0, 0.1], [0.0, 0.0, 0.3], [0.0, 0.0, 0.3]]
    assert len(clip(hull(np.zeros((1, 3))), SQUARE, slanted, max_distance=0.3)) == 4
    assert len(clip(hull(np.zeros((1, 3))), SQUARE, slanted, max_distance=0.29)) == 2
    assert len(clip(hull(np.zeros((1, 3))), SQUARE, slanted, max_distance=0.05)) == 0
