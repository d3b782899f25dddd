"""How a link feels the fluid around it, beside the box of its inertia."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

from carom.description.pose import Vector3

_ROUNDING = 1e-15
_SERIES_BEGINS = 1e-3
"""How far apart the arguments of `carlson_rd` are where its series is exact to double precision."""


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

        H. Lamb, Hydrodynamics (1932), sections 114 and 115.
        """
        if self.volume <= 0.0:
            return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        a, b, c = (axis * axis for axis in self.semi_axes)
        scale = 2.0 / 3.0 * self.semi_axes[0] * self.semi_axes[1] * self.semi_axes[2]
        ka, kb, kc = (scale * carlson_rd(*three) for three in ((b, c, a), (c, a, b), (a, b, c)))
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
