"""Values of the latest steps, and values that arrive late, in many environments."""

from __future__ import annotations

import numpy as np

from carom.checks import Array
from carom.vector.checkpoints import Attributes
from carom.vector.random import RandomSources

Delay = int | tuple[int, int]
"""A number of steps; or the least and the greatest, between which each episode draws its own."""


class DelayLine(Attributes):
    """Remembers values of the latest steps, and returns them after a number of steps.

    Call `start` for environments whose episodes begin, then `push` once in each step. It is part of the
    checkpoints of an environment that has it as an attribute.

    Attributes:
        delays: Number of steps after which each environment gets a value, (count,).

    Args:
        count: Number of environments.
        shape: Shape of a value.
        delay: The delay [steps], or its least and greatest number.
        history: Number of values that are returned at a time.
        name: What messages call it.

    Raises:
        ValueError: A delay is negative, the least one is greater than the greatest, or history is less than
            1.
    """

    def __init__(
        self,
        count: int,
        shape: tuple[int, ...],
        delay: Delay = 0,
        *,
        history: int = 1,
        name: str = "the delay line",
    ) -> None:
        least, most = (delay, delay) if isinstance(delay, int) else delay
        if not 0 <= least <= most:
            raise ValueError(f"{name}: delay must be a number of steps, or two in order, not {delay}")
        if history < 1:
            raise ValueError(f"{name}: history must be at least 1, not {history}")
        self._least, self._most = int(least), int(most)
        # The latest value is the last one.
        self._past: Array = np.zeros((count, history + self._most, *shape))
        self._history = np.arange(history - 1, -1, -1)
        self.delays: np.ndarray = np.full(count, self._least, dtype=np.int64)

    def start(self, worlds: np.ndarray, random: RandomSources) -> None:
        """Choose the delays of episodes that begin.

        Args:
            worlds: Their environments, by index.
            random: Random numbers are drawn from these, if the delay is random.
        """
        if self._least < self._most:
            drawn = random.draw(worlds, lambda own: own.integers(self._least, self._most + 1))
            self.delays[worlds] = drawn.astype(np.int64)

    def fill(self, worlds: np.ndarray, values: Array | float) -> None:
        """Set all values of some environments, as if they had always been like this.

        Args:
            worlds: The environments: a mask (count,) or n indices.
            values: Values (n, ...) for these, or one number.
        """
        self._past[worlds] = values if np.ndim(values) == 0 else np.asarray(values)[:, None]

    def push(self, values: Array, worlds: np.ndarray | slice = slice(None)) -> None:
        """Add the values of a step.

        Args:
            values: Values (n, ...) for n environments.
            worlds: Which: a mask (count,) or indices; all by default.
        """
        self._past[worlds] = np.concatenate([self._past[worlds][:, 1:], np.asarray(values)[:, None]], axis=1)

    @property
    def value(self) -> Array:
        """The values that arrive now, a copy (count, ...)."""
        return self._past[np.arange(len(self.delays)), self._past.shape[1] - 1 - self.delays]

    @property
    def history(self) -> Array:
        """These and those before them, the oldest first: a copy (count, history, ...)."""
        places = self._past.shape[1] - 1 - self.delays[:, None] - self._history
        return self._past[np.arange(len(self.delays))[:, None], places]
