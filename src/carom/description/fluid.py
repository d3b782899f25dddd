"""How a link feels the fluid around it, beside the box of its inertia."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Vector3

_ROUNDING = 1e-15
_SERIES_BEGINS = 1e-3
"""How far apart the arguments of `carlson_rd` are where its series is exact to double precision."""
_PLACES = (
    *(0.0, 0.207784955007898468, 0.405845151377397167, 0.586087235467691130),
    *(0.741531185599394440, 0.864864423359769073, 0.949107912342758525, 0.991455371120812640),
)
_SHARES = (
    *(0.209482141084727828, 0.204432940075298892, 0.190350578064785410, 0.169004726639267903),
    *(0.140653259715525919, 0.104790010322250184, 0.063092092629978553, 0.022935322010529225),
)
"""Kronrod's 15 places from -1 to 1 and their weights, those from 0 on."""
_THINNEST = 1.0 / 500.0
"""Share of the greatest axis from which on so few points are enough: they are 1 % off there, then more."""
Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FluidEllipsoid:
    """An ellipsoid in the inertial frame of a link, on which the fluid of the world acts.

    MuJoCo's documentation has the model (computation, fluid forces, ellipsoid model). One without size feels
    nothing.

    Attributes:
        semi_axes: Half its lengths along the axes [m].
        blunt_drag: Coefficient of drag by the projected area.
        slender_drag: Coefficient of drag by what is left of the greatest projected area.
        angular_drag: Coefficient of drag of rotation.
        kutta_lift: Coefficient of lift across the flow.
        magnus_lift: Coefficient of lift by rotation.
    """

    semi_axes: Vector3
    blunt_drag: float = 0.5
    slender_drag: float = 0.25
    angular_drag: float = 1.5
    kutta_lift: float = 1.0
    magnus_lift: float = 1.0

    @property
    def volume(self) -> float:
        """[m³]."""
        a, b, c = self.semi_axes
        return 4.0 / 3.0 * pi * a * b * c

    def added(self) -> tuple[Vector3, Vector3]:
        """Added mass along each axis and added inertia about it, per density [m³, m⁵].

        H. Lamb, Hydrodynamics (1932), sections 114 and 115. The integrals are found with as few points as in
        MuJoCo, which matters for plates: where one axis is 1/250 of another, accelerations differ by 4e-4.
        Those of still thinner ones, of which MuJoCo makes up to 1e12 times too much, are exact.
        """
        if self.volume <= 0.0:
            return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        a, b, c = (axis * axis for axis in self.semi_axes)
        found = _coefficient if min(self.semi_axes) >= _THINNEST * max(self.semi_axes) else _exact
        ka, kb, kc = found(a, b, c), found(b, c, a), found(c, a, b)
        mass = (self._mass(ka), self._mass(kb), self._mass(kc))
        return mass, (self._inertia(b, c, kb, kc), self._inertia(c, a, kc, ka), self._inertia(a, b, ka, kb))

    def _mass(self, k: float) -> float:
        return self.volume * k / max(2.0 - k, _ROUNDING)

    def _inertia(self, first: float, second: float, k_first: float, k_second: float) -> float:
        """About the third axis, by the squares of the other two and their coefficients."""
        difference = first - second
        if abs(difference) <= _ROUNDING * (first + second):
            return 0.0
        change = k_second - k_first
        return self.volume / 5.0 * difference**2 * change / (2.0 * difference - (first + second) * change)


SHELTERED = FluidEllipsoid((0.0, 0.0, 0.0))
"""Of a link on which no fluid acts, as others act for it."""


def _coefficient(a: float, b: float, c: float) -> float:
    """Of the fluid that moves along the first axis, by the squares of all: abc ∫ dλ / ((a² + λ) Δ)."""
    places, weights = _quadrature()
    scale = (a * sqrt(a * b * c)) ** 0.4
    x, y, z = (1.0 + scale * places / axis for axis in (a, b, c))
    return float(scale / a * (weights / (x * np.sqrt(x * y * z))).sum())


def _exact(a: float, b: float, c: float) -> float:
    """The same without an error."""
    return 2.0 / 3.0 * sqrt(a * b * c) * carlson_rd(b, c, a)


@cache
def _quadrature() -> tuple[Matrix, Matrix]:
    """Places from 0 to infinity, and weights of an integral over them: each (15,).

    They are those of Gauss and Kronrod, 15 points from 0 to 1, put in place of λ = x³ / (1 - x)².
    """
    places = np.array([-x for x in reversed(_PLACES[1:])] + list(_PLACES))
    shares = np.array([*reversed(_SHARES[1:]), *_SHARES])
    x = 0.5 * (1.0 + places)
    slope = x * x * (3.0 - x) / (1.0 - x) ** 3
    return x**3 / (1.0 - x) ** 2, 0.5 * shares * slope


def carlson_rd(x: float, y: float, z: float) -> float:
    """Carlson's symmetric elliptic integral of the second kind R_D(x, y, z), of positive numbers.

    B. C. Carlson, Numerical computation of real or complex elliptic integrals (1995), by duplication.
    """
    total, share = 0.0, 1.0
    while True:
        mean = (x + y + 3.0 * z) / 5.0
        dx, dy = (mean - x) / mean, (mean - y) / mean
        if max(abs(dx), abs(dy)) < _SERIES_BEGINS:
            break
        step = sqrt(x * y) + sqrt(y * z) + sqrt(z * x)
        total += share / (sqrt(z) * (z + step))
        share *= 0.25
        x, y, z = 0.25 * (x + step), 0.25 * (y + step), 0.25 * (z + step)
    dz = -(dx + dy) / 3.0
    e2, e3 = dx * dy - 6.0 * dz * dz, (3.0 * dx * dy - 8.0 * dz * dz) * dz
    e4, e5 = 3.0 * (dx * dy - dz * dz) * dz * dz, dx * dy * dz * dz * dz
    series = 1.0 - 3.0 / 14.0 * e2 + e3 / 6.0 + 9.0 / 88.0 * e2 * e2 - 3.0 / 22.0 * e4
    series += -9.0 / 52.0 * e2 * e3 + 3.0 / 26.0 * e5
    return 3.0 * total + share * series / (mean * sqrt(mean))
