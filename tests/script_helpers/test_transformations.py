from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from pybullet_utils import transformations as transform

AXES = [f + a + b + c for f in "sr" for a in "xyz" for b in "xyz" for c in "xyz" if a != b != c]
angle = st.floats(-3.0, 3.0)
vectors = st.tuples(*[st.floats(-2.0, 2.0)] * 3)
quaternions = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


@given(axes=st.sampled_from(AXES), a=angle, b=angle, c=angle)
def test_angles_of_a_rotation_make_it_again(axes: str, a: float, b: float, c: float) -> None:
    matrix = transform.euler_matrix(a, b, c, axes)
    again = transform.euler_matrix(*transform.euler_from_matrix(matrix, axes), axes)
    assert again == pytest.approx(matrix, abs=1e-7)


@pytest.mark.parametrize("axes", ["", "xyz", "txyz", "sxxy", "sxyw", "sxyzx"])
def test_axes_that_make_no_sense_are_refused(axes: str) -> None:
    with pytest.raises(ValueError, match="axes must be"):
        transform.euler_matrix(0.1, 0.2, 0.3, axes)


@given(first=quaternions, second=quaternions)
def test_products_of_quaternions_are_products_of_matrices(
    first: tuple[float, ...], second: tuple[float, ...]
) -> None:
    product = transform.quaternion_matrix(transform.quaternion_multiply(first, second))
    matrices = transform.quaternion_matrix(first) @ transform.quaternion_matrix(second)
    assert product == pytest.approx(matrices, abs=1e-9)


@given(quaternion=quaternions)
def test_quaternions_of_matrices_and_inverses(quaternion: tuple[float, ...]) -> None:
    unit = transform.unit_vector(quaternion)
    again = transform.quaternion_from_matrix(transform.quaternion_matrix(quaternion))
    assert abs(float(again @ unit)) == pytest.approx(1.0)
    one = transform.quaternion_multiply(quaternion, transform.quaternion_inverse(quaternion))
    assert one == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-9)


@given(angles=vectors, translate=vectors, scale=st.tuples(*[st.floats(0.1, 3.0)] * 3), shear=vectors)
def test_composed_transforms_come_apart_again(
    angles: tuple[float, ...],
    translate: tuple[float, ...],
    scale: tuple[float, ...],
    shear: tuple[float, ...],
) -> None:
    matrix = transform.compose_matrix(scale, shear, angles, translate)
    parts = transform.decompose_matrix(matrix)
    assert transform.compose_matrix(*parts) == pytest.approx(matrix, abs=1e-6)
    assert parts[0] == pytest.approx(scale, rel=1e-6)


def test_rotations_about_a_line_keep_its_points() -> None:
    matrix = transform.rotation_matrix(0.5, (0, 0, 2), (1, 0, 0))
    assert matrix @ (1, 0, 7, 1) == pytest.approx((1, 0, 7, 1))
    angle, direction, point = transform.rotation_from_matrix(matrix)
    assert angle == pytest.approx(0.5)
    assert direction == pytest.approx((0, 0, 1))
    assert matrix @ point == pytest.approx(point)


def test_reflections_scales_and_moves() -> None:
    mirror = transform.reflection_matrix((1, 2, 3), (1, 0, 0))
    assert mirror @ (0, 5, 6, 1) == pytest.approx((2, 5, 6, 1))
    assert transform.scale_matrix(2.0, (1, 0, 0)) @ (2, 1, 0, 1) == pytest.approx((3, 2, 0, 1))
    move = transform.translation_matrix((1, 2, 3))
    assert transform.translation_from_matrix(transform.inverse_matrix(move)) == pytest.approx((-1, -2, -3))
    assert transform.is_same_transform(transform.concatenate_matrices(move, move), move @ move)


def test_parts_of_singular_transforms_are_refused() -> None:
    with pytest.raises(ValueError, match="singular"):
        transform.decompose_matrix(np.diag([1.0, 1.0, 0.0, 1.0]))
    with pytest.raises(ValueError, match="not a rotation"):
        transform.rotation_from_matrix(np.diag([1.0, 2.0, 1.0, 1.0]))


def test_random_rotations_are_rotations() -> None:
    matrix = transform.random_rotation_matrix((0.1, 0.2, 0.3))
    assert matrix @ matrix.T == pytest.approx(np.identity(4))
    assert transform.random_quaternion((0.1, 0.2, 0.3)) == pytest.approx(
        (0.902251, 0.293159, 0.30075, -0.09772), abs=1e-6
    )


@given(first=quaternions, second=quaternions, fraction=st.floats(0.0, 1.0), spin=st.sampled_from([0, 2, -2]))
def test_interpolated_rotations_turn_at_a_constant_rate(
    first: tuple[float, ...], second: tuple[float, ...], fraction: float, spin: int
) -> None:
    start, end = transform.unit_vector(first), transform.unit_vector(second)
    for shortest in (True, False):
        found = transform.quaternion_slerp(first, second, fraction, spin, shortest)
        aim = -end if shortest and start @ end < 0.0 else end
        angle = np.arccos(np.clip(start @ aim, -1.0, 1.0))
        if np.sin(angle) < 1e-3:
            continue
        # In the plane of both, by this part of the angle and of the half turns.
        across = (aim - start * np.cos(angle)) / np.sin(angle)
        part = fraction * (angle + spin * np.pi)
        if fraction == 1.0:
            # Not the nearer of the two quaternions, and without the half turns.
            assert found == pytest.approx(end)
        else:
            assert found == pytest.approx(np.cos(part) * start + np.sin(part) * across, abs=1e-7)


def test_between_equal_rotations_there_is_one() -> None:
    turn = transform.unit_vector((0.1, 0.2, 0.3, 0.4))
    for other in (turn, -turn, 3.0 * turn):
        assert transform.quaternion_slerp(2.0 * turn, other, 0.3) == pytest.approx(turn)


@given(angle=angle, axis=vectors.filter(lambda v: np.linalg.norm(v) > 0.1), point=vectors)
def test_rotations_are_those_of_scipy(
    angle: float, axis: tuple[float, ...], point: tuple[float, ...]
) -> None:
    turn = Rotation.from_rotvec(angle * np.array(axis) / np.linalg.norm(axis))
    quaternion = transform.quaternion_about_axis(angle, axis)
    assert Rotation.from_quat(quaternion).approx_equal(turn, 1e-7)
    assert transform.quaternion_matrix(quaternion)[:3, :3] == pytest.approx(turn.as_matrix(), abs=1e-9)
    matrix = transform.rotation_matrix(angle, axis, point)
    assert matrix[:3, :3] == pytest.approx(turn.as_matrix(), abs=1e-9)
    assert matrix @ (*point, 1.0) == pytest.approx((*point, 1.0), abs=1e-9)
    found, direction, _ = transform.rotation_from_matrix(matrix)
    assert found * direction == pytest.approx(turn.as_rotvec(), abs=1e-6)
    angles = turn.as_euler("xyz")
    assert transform.quaternion_from_euler(*angles) == pytest.approx(
        turn.as_quat(canonical=True), abs=1e-7
    ) or transform.quaternion_from_euler(*angles) == pytest.approx(-turn.as_quat(canonical=True), abs=1e-7)


def test_random_rotations_are_as_likely_in_all_directions() -> None:
    """Each of the four numbers of a uniform random rotation has the mean square 1/4."""
    grid = (np.arange(8) + 0.5) / 8
    rotations = np.array([transform.random_quaternion((a, b, c)) for a in grid for b in grid for c in grid])
    assert np.linalg.norm(rotations, axis=1) == pytest.approx(np.ones(512))
    assert rotations.T @ rotations / 512 == pytest.approx(0.25 * np.identity(4), abs=1e-9)
