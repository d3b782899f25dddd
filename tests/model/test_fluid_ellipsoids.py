"""The fluid that ellipsoids carry along, and the elliptic integral of it."""

from __future__ import annotations

from math import acos, sqrt

import pytest

from carom.description.fluid import FluidEllipsoid, carlson_rd


def test_the_elliptic_integral_has_known_values():
    # B. C. Carlson, Numerical computation of real or complex elliptic integrals (1995).
    assert carlson_rd(2.0, 3.0, 4.0) == pytest.approx(0.16510527294261053, rel=1e-14)
    assert carlson_rd(0.3, 0.3, 0.3) == pytest.approx(0.3**-1.5, rel=1e-14)
    for x, y in ((0.1, 2.0), (1.0, 1.5), (3.0, 40.0)):
        closed = 1.5 / (y - x) * (acos(sqrt(x / y)) / sqrt(y - x) - sqrt(x) / y)
        assert carlson_rd(x, y, y) == pytest.approx(closed, rel=1e-13)


def test_a_sphere_carries_half_its_volume_and_does_not_turn_it():
    mass, inertia = FluidEllipsoid((0.2, 0.2, 0.2)).added()
    assert mass == pytest.approx(3 * (0.5 * FluidEllipsoid((0.2, 0.2, 0.2)).volume,), rel=1e-13)
    assert inertia == (0.0, 0.0, 0.0)


def test_what_has_no_volume_carries_nothing():
    assert FluidEllipsoid((0.1, 0.0, 0.3)).added() == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
