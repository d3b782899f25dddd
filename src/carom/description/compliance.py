"""How a constraint yields."""

from __future__ import annotations

from dataclasses import dataclass

Four = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Compliance:
    """Spring, damper and impedance of a constraint, as `solref` and `solimp` of MJCF files give them.

    Without other forces an error r obeys r'' = -b r' - k d r. A force f along the constraint moves it by the
    acceleration (1 - d) / d A f, where A is an inverse mass.

    Attributes:
        time_constant: Of the spring and damper [s], at least two time steps; if not positive, minus the
            stiffness k of an impedance of 1 [1/s²].
        damping_ratio: 1 is critical; if `time_constant` is not positive, minus the damping b [1/s].
        least: Impedance d without an error.
        greatest: Impedance from an error of `width` on.
        width: That error [m or rad].
        midpoint: Where between 0 and 1 the curve from one to the other turns.
        power: Its exponent on both sides, at least 1.
        inverse_mass: Inverse mass for which it yields [1/kg, or 1/(kg m²) of an angle]; 0 for that along the
            constraint at the time.
        inverse_inertia: Likewise about axes, of welds [1/(kg m²)].
    """

    time_constant: float = 0.02
    damping_ratio: float = 1.0
    least: float = 0.9
    greatest: float = 0.95
    width: float = 0.001
    midpoint: float = 0.5
    power: float = 2.0
    inverse_mass: float = 0.0
    inverse_inertia: float = 0.0

    @property
    def reference(self) -> Four:
        """Time constant, damping ratio, midpoint and power."""
        return (self.time_constant, self.damping_ratio, self.midpoint, self.power)

    @property
    def impedance(self) -> Four:
        """Bounds of the impedance, width, and inverse mass."""
        return (self.least, self.greatest, self.width, self.inverse_mass)


@dataclass(frozen=True, slots=True)
class ContactCompliance:
    """How the contacts of a link yield, as `<geom>` of MJCF files gives it.

    Attributes:
        compliance: Spring, damper and impedance; `inverse_mass` is the link's share of that of a contact.
        weight: Of two links of one rank, both count by their weights.
        margin: Distance at which contacts begin to push [m]; those of two links add up.
        pyramids: 0 for round friction cones; for pyramids 1, or less if friction is stiffer than the normal;
            for such cones minus that, which only a world with `contact="compliant"` heeds.
    """

    compliance: Compliance = Compliance()
    weight: float = 1.0
    margin: float = 0.0
    pyramids: float = 1.0

    @property
    def mixing(self) -> tuple[float, float, float]:
        """Weight, margin, pyramids."""
        return (self.weight, self.margin, self.pyramids)


@dataclass(frozen=True, slots=True)
class PairContact:
    """How the contacts of two links are, whatever each of them says, as `<pair>` of MJCF files gives it.

    Attributes:
        compliance: Spring, damper and impedance; of inverse masses those of the links count.
        friction: Coefficients of lateral, rolling [m] and spinning friction [m].
        margin: Distance at which contacts begin to push [m].
        lateral_reference: Time constant and damping ratio of lateral friction, as in `Compliance`; both 0 for
            those of the normal.
    """

    compliance: Compliance = Compliance()
    friction: tuple[float, float, float] = (1.0, 0.0, 0.0)
    margin: float = 0.0
    lateral_reference: tuple[float, float] = (0.0, 0.0)
