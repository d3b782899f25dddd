"""How a constraint yields."""

from __future__ import annotations

from carom.record import record

Four = tuple[float, float, float, float]


@record
class Compliance:
    """Spring, damper and impedance of a constraint, as `solref` and `solimp` of MJCF files give them.

    Without other forces an error r obeys r'' = -b r' - k d r. A force f along the constraint moves it by the
    acceleration (1 - d) / d A f, where A is the inverse mass along it.

    Attributes:
        time_constant: Of the spring and damper [s], at least two time steps; if not positive, minus the
            stiffness k of an impedance of 1 [1/s²].
        damping_ratio: 1 is critical; if `time_constant` is not positive, minus the damping b [1/s].
        least: Impedance d without an error.
        greatest: Impedance from an error of `width` on.
        width: That error [m or rad].
        midpoint: Where between 0 and 1 the curve from one to the other turns.
        power: Its exponent on both sides, at least 1.
    """

    time_constant: float = 0.02
    damping_ratio: float = 1.0
    least: float = 0.9
    greatest: float = 0.95
    width: float = 0.001
    midpoint: float = 0.5
    power: float = 2.0

    @property
    def reference(self) -> Four:
        """Time constant, damping ratio, midpoint and power."""
        return (self.time_constant, self.damping_ratio, self.midpoint, self.power)

    @property
    def impedance(self) -> Four:
        """Bounds of the impedance, width, and 0."""
        return (self.least, self.greatest, self.width, 0.0)
