"""What a sensor has in one world and in many."""

from __future__ import annotations

from carom.description.sensor import SensorSpec


class CommonSensor:
    """What a sensor was made from."""

    __slots__ = ()

    @property
    def spec(self) -> SensorSpec:
        """What it was made from."""
        raise NotImplementedError

    @property
    def dim(self) -> int:
        """How many numbers it shows in a world."""
        return self.spec.dim

    @property
    def noise(self) -> float:
        """Standard deviation of its noise."""
        return self.spec.noise

    @property
    def cutoff(self) -> float:
        """Greatest absolute number that it shows; 0 for no bound."""
        return self.spec.cutoff
