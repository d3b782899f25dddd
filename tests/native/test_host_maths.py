"""Host maths that is the same bits on every machine."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.native import products, trigonometry

ANGLES = st.floats(-1e6, 1e6)
SEED = 11


@given(ANGLES)
def test_sines_are_those_of_any_library_but_for_the_last_bits(angle: float):
    assert math.isclose(trigonometry.sin(angle), math.sin(angle), rel_tol=1e-15, abs_tol=1e-16)
    assert math.isclose(trigonometry.cos(angle), math.cos(angle), rel_tol=1e-15, abs_tol=1e-16)
    assert math.isclose(trigonometry.tan(angle), math.tan(angle), rel_tol=2e-15, abs_tol=1e-16)


@given(st.floats(-1.0, 1.0))
def test_angles_of_sines_are_those_of_any_library_but_for_the_last_bits(value: float):
    assert math.isclose(trigonometry.asin(value), math.asin(value), rel_tol=1e-15, abs_tol=1e-300)
    assert math.isclose(trigonometry.acos(value), math.acos(value), rel_tol=1e-15, abs_tol=1e-16)


@given(st.floats(allow_nan=False), st.floats(allow_nan=False))
def test_the_angle_of_a_point_is_that_of_any_library_but_for_the_last_bits(y: float, x: float):
    ours, theirs = trigonometry.atan2(y, x), math.atan2(y, x)
    assert math.isclose(ours, theirs, rel_tol=1e-15, abs_tol=1e-300)
    assert math.copysign(1.0, ours) == math.copysign(1.0, theirs)


@pytest.mark.parametrize(
    "value", [trigonometry.asin(2.0), trigonometry.acos(-2.0), trigonometry.sin(math.inf)], ids=repr
)
def test_what_has_no_value_is_not_a_number(value: float):
    assert math.isnan(value)


def test_tangent_has_the_bits_it_has_always_had():
    assert trigonometry.tan(0.5).hex() == "0x1.17b4f5bf3474ap-1"


def test_products_add_terms_in_the_order_in_which_they_stand():
    # The large terms cancel only if nothing is added in between, and no product is kept unrounded.
    a = np.array([[1e16, -1e16, 1.0]])
    assert products.product(a, np.ones((3, 1))).item() == 1.0
    assert products.product(a[:, ::-1], np.ones((3, 1))).item() == 0.0


def test_products_are_those_of_numpy_for_all_shapes():
    random = np.random.default_rng(SEED)
    for first, second in (((4, 4), (4, 4)), ((4, 4), (7, 4, 4)), ((5, 3), (3, 3)), ((6, 3, 3), (6, 3, 1))):
        a, b = random.normal(size=first), random.normal(size=second)
        np.testing.assert_allclose(products.product(a, b), a @ b, rtol=1e-13, atol=1e-13)


def test_scalar_products():
    a, b = np.arange(12.0).reshape(4, 3), np.array([1.0, -2.0, 0.5])
    np.testing.assert_array_equal(products.dots(a, b), a @ b)
    np.testing.assert_array_equal(products.dots(np.array([[1e16, 1.0, -1e16]]), np.ones(3)), [0.0])


def test_inverses_and_determinants_are_those_of_numpy():
    matrices = np.random.default_rng(SEED).normal(size=(20, 3, 3))
    np.testing.assert_allclose(products.determinants(matrices), np.linalg.det(matrices), rtol=1e-10)
    np.testing.assert_allclose(products.inverses(matrices), np.linalg.inv(matrices), rtol=1e-9, atol=1e-12)


def test_length():
    assert products.length(np.array([2.0, -3.0, 6.0])) == 7.0
