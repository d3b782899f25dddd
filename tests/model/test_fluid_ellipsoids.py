"""The fluid that ellipsoids carry along, and the elliptic integral of it."""

from __future__ import annotations

from math import acos, sqrt

import pytest

from carom.description.fluid import FluidEllipsoid, carlson_rd

# What MuJoCo 4.0 has in `geom_fluid` for ellipsoids in a fluid of density 1, by their semi-axes.
OF_MUJOCO = {
    (0.025, 0.01, 0.0001): (
        2.3996321885925935e-10, 9.622899575168191e-10, 9.091545403456883e-06,
        1.0106370098792317e-10, 9.464073154455101e-10, 7.56947108277566e-14,
    ),
    (0.3, 0.2, 0.01): (
        5.711753962554131e-05, 0.0001059487587875339, 0.037589197147962446,
        0.00018238295801319005, 0.000499083724398547, 4.809423187532461e-07,
    ),
    (0.3, 0.2, 0.1): (
        0.004656001295402553, 0.009161969686093343, 0.03421892335102304,
        9.632561918504682e-05, 0.00035599837625950354, 3.914190145187042e-05,
    ),
}  # fmt: skip


@pytest.mark.parametrize("axes", OF_MUJOCO)
def test_it_is_that_of_mujoco_also_for_plates(axes):
    mass, inertia = FluidEllipsoid(axes).added()
    # The weights of MuJoCo's integral have eight digits.
    assert (*mass, *inertia) == pytest.approx(OF_MUJOCO[axes], rel=1e-6)


def test_the_elliptic_integral_has_known_values():
    # B. C. Carlson, Numerical computation of real or complex elliptic integrals (1995).
    assert carlson_rd(2.0, 3.0, 4.0) == pytest.approx(0.16510527294261053, rel=1e-14)
    assert carlson_rd(0.3, 0.3, 0.3) == pytest.approx(0.3**-1.5, rel=1e-14)
    for x, y in ((0.1, 2.0), (1.0, 1.5), (3.0, 40.0)):
        closed = 1.5 / (y - x) * (acos(sqrt(x / y)) / sqrt(y - x) - sqrt(x) / y)
        assert carlson_rd(x, y, y) == pytest.approx(closed, rel=1e-13)


def test_a_sphere_carries_half_its_volume_and_does_not_turn_it():
    mass, inertia = FluidEllipsoid((0.2, 0.2, 0.2)).added()
    assert mass == pytest.approx(3 * (0.5 * FluidEllipsoid((0.2, 0.2, 0.2)).volume,), rel=1e-6)
    assert inertia == (0.0, 0.0, 0.0)


def test_what_has_no_volume_carries_nothing():
    assert FluidEllipsoid((0.1, 0.0, 0.3)).added() == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def test_of_foils_it_is_exact_and_not_that_of_mujoco():
    mass, inertia = FluidEllipsoid((1.0, 1.0, 1e-4)).added()
    assert mass[2] == pytest.approx(8.0 / 3.0, rel=1e-3)
    assert inertia[:2] == pytest.approx((16.0 / 45.0,) * 2, rel=1e-3)
