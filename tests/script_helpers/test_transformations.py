from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

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
