"""Inertia from shapes and from files, against closed forms and a second algorithm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from carom.description import Box, Capsule, Collision, Cylinder, Inertial, Mesh, Plane, Pose, Sphere
from carom.description.pose import IDENTITY
from carom.description.shapes.bounds import Bounds
from carom.description.transform import quaternion_from_rpy, rotation_matrix
from carom.layouts.contacts import MARGIN
from carom.model.body_spec import LinkSpec
from carom.model.bounds import placed_bounds
from carom.model.inertia import diagonalize, inertia_from_file, inertia_from_shapes

MASS = 2.5


def box_moments(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Moments of a solid box of these edges."""
    return MASS / 12 * (y * y + z * z), MASS / 12 * (x * x + z * z), MASS / 12 * (x * x + y * y)


def moments(*collisions: Collision, frame: Pose = IDENTITY, implicit: bool = False) -> tuple[float, ...]:
    link = LinkSpec("link", mass=MASS, inertial_frame=frame, collisions=collisions)
    return inertia_from_shapes(link, implicit_cylinder=implicit)


FRAMES = [IDENTITY, Pose((0.1, -0.2, 0.3)), Pose((0.1, 0.2, 0.3), quaternion_from_rpy(0.0, 0.0, 0.0))]


@pytest.mark.parametrize("frame", FRAMES)
def test_a_shape_in_the_inertial_frame_counts_by_itself(frame: Pose) -> None:
    def alone(shape: object, implicit: bool = False) -> tuple[float, ...]:
        return moments(Collision(shape, frame), frame=frame, implicit=implicit)  # type: ignore[arg-type]

    ball = 0.4 * MASS * 0.3**2
    assert alone(Sphere(0.3)) == pytest.approx((ball, ball, ball), rel=1e-15)
    assert alone(Box((0.1, 0.2, 0.3))) == pytest.approx(box_moments(0.2, 0.4, 0.6), rel=1e-15)
    assert alone(Capsule(0.1, 0.5)) == pytest.approx(box_moments(0.2, 0.2, 0.7), rel=1e-7)
    across = MASS * (0.1**2 / 4 + 0.5**2 / 12)
    exact = (across, across, MASS * 0.1**2 / 2)
    assert alone(Cylinder(0.1, 0.5), implicit=True) == pytest.approx(exact, rel=1e-15)
    assert alone(Cylinder(0.1, 0.5)) == pytest.approx(box_moments(0.206, 0.206, 0.506), rel=1e-7)
    assert alone(Plane()) == (0.0, 0.0, 0.0)


def test_nothing_counts_as_a_box_of_margins() -> None:
    edge = 2 * MARGIN
    assert moments() == pytest.approx(box_moments(edge, edge, edge), rel=1e-12)


def test_shapes_elsewhere_count_as_their_bounding_box() -> None:
    shapes = (Collision(Sphere(0.1), Pose((1.0, 0.0, 0.0))), Collision(Box((0.2, 0.3, 0.4))))
    edges = [edge + 2 * MARGIN for edge in (1.3, 0.6, 0.8)]
    assert moments(*shapes) == pytest.approx(box_moments(*edges), rel=1e-12)


def test_a_turned_shape_counts_as_the_box_around_it() -> None:
    quarter = Pose(orientation=quaternion_from_rpy(0.0, 0.0, np.pi / 2))
    edges = [edge + 2 * MARGIN for edge in (0.4, 0.2, 0.6)]
    assert moments(Collision(Box((0.1, 0.2, 0.3)), quarter)) == pytest.approx(box_moments(*edges), rel=1e-12)


def test_hulls_of_meshes_count_with_three_margins(tmp_path: Path) -> None:
    file = tmp_path / "m.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 4\nf 1 2 3\nf 1 2 4\n")
    expected = box_moments(0.5 + 6 * MARGIN, 1.0 + 6 * MARGIN, 2.0 + 6 * MARGIN)
    assert moments(Collision(Mesh(file, (0.5, -0.5, 0.5)))) == pytest.approx(expected, rel=1e-12)
    assert moments(Collision(Mesh(file, concave=True))) == (0.0, 0.0, 0.0)


finite = st.floats(-3.0, 3.0)


@given(st.tuples(*[finite] * 3), st.tuples(*[finite] * 3), st.tuples(*[st.floats(0.01, 2.0)] * 3))
def test_placed_bounds_touch_the_corners_of_a_box(
    rpy: tuple[float, float, float], position: tuple[float, float, float], half: tuple[float, float, float]
) -> None:
    rotation = rotation_matrix(quaternion_from_rpy(*rpy))
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = (signs * half) @ np.array(rotation).T + position
    bounds = placed_bounds(Box(half), rotation, position, implicit_cylinder=False)
    low, high = np.subtract(bounds.center, bounds.half), np.add(bounds.center, bounds.half)
    assert low == pytest.approx(corners.min(axis=0), abs=1e-12)
    assert high == pytest.approx(corners.max(axis=0), abs=1e-12)


def test_joined_bounds_hold_both() -> None:
    joined = Bounds((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)).joined(Bounds((2.0, 0.0, 0.0), (0.5, 2.0, 0.5)))
    assert (joined.center, joined.half) == ((0.75, 0.0, 0.0), (1.75, 2.0, 1.0))


@given(hnp.arrays(np.float64, (3, 3), elements=st.floats(-10.0, 10.0)))
def test_diagonalize_finds_eigenvalues_and_a_rotation(entries: np.ndarray) -> None:
    tensor = entries + entries.T
    rows = tuple(tuple(row) for row in tensor.tolist())
    values, vectors = diagonalize(rows, 1e-14, 60)  # type: ignore[arg-type]
    q = np.array(vectors)
    assert q @ q.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(q) == pytest.approx(1.0, abs=1e-9)
    assert q @ np.diag(values) @ q.T == pytest.approx(tensor, abs=1e-9)
    assert sorted(values) == pytest.approx(np.linalg.eigvalsh(tensor), abs=1e-9)


def test_a_tensor_is_turned_into_its_principal_axes() -> None:
    turn = np.array(rotation_matrix(quaternion_from_rpy(0.3, -0.7, 1.1)))
    tensor = turn @ np.diag([1.0, 2.0, 2.5]) @ turn.T
    frame = Pose((1.0, 2.0, 3.0), quaternion_from_rpy(0.5, 0.6, 0.7))
    entries = tensor[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]].tolist()
    values, principal = inertia_from_file(Inertial(1.0, frame, tuple(entries)), "link")
    assert sorted(values) == pytest.approx([1.0, 2.0, 2.5], rel=1e-9)
    assert principal.position == frame.position
    axes = np.array(rotation_matrix(principal.orientation))
    outer = np.array(rotation_matrix(frame.orientation))
    assert axes @ np.diag(values) @ axes.T == pytest.approx(outer @ tensor @ outer.T, abs=1e-9)


@pytest.mark.parametrize("tensor", [(1, 0, 0, 1, 0, 3), (-1, 0, 0, 1, 0, 1), (1, 2, 0, 1, 0, 1)])
def test_a_tensor_no_body_can_have_counts_as_zero(
    tensor: tuple[float, ...], caplog: pytest.LogCaptureFixture
) -> None:
    frame = Pose((1.0, 2.0, 3.0))
    values = inertia_from_file(Inertial(1.0, frame, tensor), "odd link")  # type: ignore[arg-type]
    assert values == ((0.0, 0.0, 0.0), frame)
    assert "odd link" in caplog.text
