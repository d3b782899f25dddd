"""Rotations by vectors, and their derivatives, beside SciPy's: at all angles, also next to zero."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from carom.linearization import turns

# On both sides of the angles below which there are series.
ANGLES = (0.0, 1e-12, 9e-7, 2e-6, 9.9e-5, 1.01e-4, 0.01, 1.0, 3.0, 3.14)
_RANDOM = np.random.default_rng(0)


def vectors(angle: float, count: int = 5) -> np.ndarray:
    axes = _RANDOM.normal(size=(count, 3))
    return angle * axes / np.linalg.norm(axes, axis=1, keepdims=True)


@pytest.mark.parametrize("angle", ANGLES)
def test_quaternions_and_matrices_are_those_of_the_vectors(angle: float) -> None:
    given = vectors(angle)
    rotations = Rotation.from_rotvec(given)
    quaternions = turns.quaternion_of(given)
    assert_allclose(quaternions, rotations.as_quat(), rtol=0, atol=1e-15)
    assert_allclose(turns.vector_of(quaternions), given, rtol=1e-9, atol=1e-15)
    assert_allclose(turns.vector_of(-quaternions), given, rtol=1e-9, atol=1e-15)
    assert_allclose(turns.matrix_of(quaternions), rotations.as_matrix(), rtol=0, atol=1e-15)
    assert_allclose(turns.rotation_of(quaternions[0]), rotations[0].as_matrix(), rtol=0, atol=1e-15)


@pytest.mark.parametrize("angle", ANGLES)
def test_the_derivative_of_a_turn_is_the_mean_of_the_turns_on_the_way(angle: float) -> None:
    """The matrix L with exp(v + d) = exp(L d) exp(v) is the integral of exp(s v) over s from 0 to 1."""
    places, weights = np.polynomial.legendre.leggauss(24)
    for vector in vectors(angle):
        on_the_way = Rotation.from_rotvec(0.5 * (1.0 + places)[:, None] * vector).as_matrix()
        mean = np.einsum("i,ijk->jk", 0.5 * weights, on_the_way)
        # Just above the series, 1 - cos of an angle of 1e-4 has lost half of its digits.
        assert_allclose(turns.left_derivative(vector), mean, rtol=0, atol=2e-12)


def test_products_are_those_of_rotations() -> None:
    first, second = (Rotation.random(50, np.random.default_rng(seed)) for seed in (1, 2))
    found = turns.multiplied(first.as_quat(), second.as_quat())
    expected = (first * second).as_quat()
    assert_allclose(np.abs((found * expected).sum(axis=1)), 1.0, rtol=0, atol=1e-14)
    assert_allclose(
        turns.multiplied(found, turns.inverse(found)), np.tile((0.0, 0, 0, 1), (50, 1)), rtol=0, atol=1e-14
    )
    a, b = _RANDOM.normal(size=(2, 20, 3))
    assert_allclose(turns.cross(a, b), np.cross(a, b), rtol=1e-14)
    assert_allclose(turns.cross_matrix(a) @ b[..., None], np.cross(a, b)[..., None], rtol=0, atol=1e-14)
