"""When something that happens again and again is due in each world."""

from __future__ import annotations

import numpy as np

from carom.vector.checkpoints import Attributes
from carom.vector.random import RandomSources


class Clock(Attributes):
    """Times at random intervals, in each world its own.

    Args:
        count: Number of worlds.
        seconds: Least and greatest simulated time between two times [s].
        name: What messages call the term.

    Raises:
        ValueError: The least time is not greater than 0, or is greater than the greatest.
    """

    def __init__(self, count: int, seconds: tuple[float, float], name: str) -> None:
        self._least, self._most = seconds
        if not 0.0 < self._least <= self._most:
            raise ValueError(f"{name}: seconds must be two times greater than 0 in order, not {seconds}")
        self.left: np.ndarray = np.full(count, np.inf)
        """Time until it is due in each world [s]."""

    def start(self, worlds: np.ndarray, random: RandomSources) -> None:
        """Choose the next times in some worlds."""
        if self._least < self._most < np.inf:
            self.left[worlds] = random.uniform(worlds, self._least, self._most)
        else:
            self.left[worlds] = self._least

    def due(self, duration: float, random: RandomSources) -> np.ndarray:
        """Let time [s] pass; returns the worlds in which it was due, whose next times are chosen."""
        self.left -= duration
        worlds = np.flatnonzero(self.left < 0.5 * duration)
        self.start(worlds, random)
        return worlds
