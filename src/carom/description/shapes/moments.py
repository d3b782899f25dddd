"""Mass that is spread in a shape, and moments of inertia as PyBullet computes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

TWELFTH = 0.08333333
"""1/12 as PyBullet writes it for capsules and hulls, so that results agree to the last digit."""


@dataclass(frozen=True, slots=True)
class MassShape:
    """How mass is distributed in a shape.

    Attributes:
        measure: Volume [m³]; of a shell its area [m²].
        centre: Centre of mass in the frame of the shape [m].
        tensor: (3, 3) inertia about that centre for each kilogram [m²].
    """

    measure: float
    centre: NDArray[np.float64]
    tensor: NDArray[np.float64]

    @classmethod
    def central(cls, measure: float, moments: Vector3) -> MassShape:
        """That of a shape whose centre is its origin, by its moments about its axes [m²]."""
        import numpy as np

        return cls(measure, np.zeros(3), np.diag(moments))


class MassTerm(NamedTuple):
    """A moment of inertia as a function of mass: mass / divisor, times each factor in this order.

    The order of divisions and multiplications affects the last digit.

    Attributes:
        divisor: Divisor of the mass.
        factors: Factors of mass / divisor; the unit of their product is m².
    """

    divisor: float
    factors: Vector3

    def at(self, mass: float) -> float:
        """The moment [kg m²] at a mass [kg]."""
        first, second, third = self.factors
        return mass / self.divisor * first * second * third


MassTerms = tuple[tuple[MassTerm, MassTerm], tuple[MassTerm, MassTerm], tuple[MassTerm, MassTerm]]
"""For each axis two terms, whose sum is the moment about it."""

NO_TERM = MassTerm(1.0, (0.0, 0.0, 0.0))
NO_MOMENTS: MassTerms = ((NO_TERM, NO_TERM), (NO_TERM, NO_TERM), (NO_TERM, NO_TERM))


def box_terms(divisor: float, factor: float, bounds: Bounds) -> MassTerms:
    """The terms of a box: mass / divisor times a factor and the squared diagonal of a face."""
    x, y, z = ((MassTerm(divisor, (factor, square, 1.0)), NO_TERM) for square in squares(bounds))
    return (x, y, z)


def squares(bounds: Bounds) -> Vector3:
    """The squared diagonals [m²] of a box's faces across x, y and z."""
    x, y, z = (2.0 * half for half in bounds.half)
    xx, yy, zz = x * x, y * y, z * z
    return (yy + zz, xx + zz, xx + yy)
