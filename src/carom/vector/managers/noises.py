"""Models of noise for observations, for `Observation.noise`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.vector.random import RandomSources


@runtime_checkable
class Noise(Protocol):
    """What changes the values of a term; random numbers have to come from `random`, for its worlds only."""

    def episode(self, random: RandomSources, worlds: np.ndarray, width: int) -> Array:
        """Numbers (n, width) that worlds whose episodes begin keep for their episodes."""
        ...

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """The values (num_envs, width) with noise; `kept` are the numbers of their episodes."""
        ...


class _WithoutMemory:
    """Noise that keeps nothing for an episode."""

    def episode(self, random: RandomSources, worlds: np.ndarray, width: int) -> Array:
        """Nothing."""
        return np.zeros((len(worlds), width))


@dataclass(frozen=True)
class Uniform(_WithoutMemory):
    """Adds uniform numbers from `lower` to `upper`, in the unit of the value."""

    lower: ArrayLike
    upper: ArrayLike

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """See `Noise`."""
        low, high = (np.broadcast_to(each, values.shape[1:]) for each in (self.lower, self.upper))
        return values + random.uniform(_all(values), low, high, values.shape[1])


@dataclass(frozen=True)
class Gaussian(_WithoutMemory):
    """Adds normally distributed numbers with these deviations, in the unit of the value."""

    deviation: ArrayLike

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """See `Noise`."""
        width = values.shape[1]
        drawn = random.draw(_all(values), lambda generator: generator.standard_normal(width))
        return values + drawn * np.asarray(self.deviation, np.float64)


@dataclass(frozen=True)
class Bias:
    """Adds an offset that each episode draws once, normally distributed: what a sensor is off by."""

    deviation: ArrayLike

    def episode(self, random: RandomSources, worlds: np.ndarray, width: int) -> Array:
        """The offsets."""
        drawn = random.draw(worlds, lambda generator: generator.standard_normal(width))
        return drawn * np.asarray(self.deviation, np.float64)

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """See `Noise`."""
        return values + kept


@dataclass(frozen=True)
class Gain:
    """Multiplies with a factor that each episode draws once, about 1: an error of calibration."""

    deviation: ArrayLike

    def episode(self, random: RandomSources, worlds: np.ndarray, width: int) -> Array:
        """The factors."""
        drawn = random.draw(worlds, lambda generator: generator.standard_normal(width))
        return 1.0 + drawn * np.asarray(self.deviation, np.float64)

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """See `Noise`."""
        return values * kept


@dataclass(frozen=True)
class Dropout(_WithoutMemory):
    """Replaces values by 0, each with this probability: a measurement that is missing."""

    probability: float

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """See `Noise`."""
        there = random.uniform(_all(values), 0.0, 1.0, values.shape[1]) >= self.probability
        return values * there


@dataclass(frozen=True)
class Chain:
    """Several, one after the other."""

    parts: tuple[Noise, ...]

    def episode(self, random: RandomSources, worlds: np.ndarray, width: int) -> Array:
        """Those of all parts, side by side."""
        found = [part.episode(random, worlds, width) for part in self.parts]
        return np.concatenate(found, axis=1) if found else np.zeros((len(worlds), 0))

    def __call__(self, values: Array, kept: Array, random: RandomSources) -> Array:
        """See `Noise`."""
        for part, own in zip(self.parts, np.split(kept, len(self.parts) or 1, axis=1), strict=False):
            values = part(values, own, random)
        return values


def _all(values: Array) -> np.ndarray:
    return np.arange(len(values))
