"""Gaussian noise that is a function of seeds and of the number of the step, so that it needs no state."""

from __future__ import annotations

from collections.abc import Sequence
from zlib import crc32

import numpy as np

from carom.checks import Array

_STEP = np.array([0x9E3779B97F4A7C15], dtype=np.uint64)
_FIRST = np.array([0xBF58476D1CE4E5B9], dtype=np.uint64)
_SECOND = np.array([0x94D049BB133111EB], dtype=np.uint64)
_PART = 2.0**-53


def gaussian(key: str, seed: int, seeds: np.ndarray, steps: np.ndarray, dim: int) -> Array:
    """Independent numbers of standard normal distribution, (worlds, dim).

    Args:
        key: Name of what has the noise.
        seed: Its seed.
        seeds: Seeds of the worlds, (worlds,).
        steps: Numbers of the steps, (worlds,).
        dim: How many numbers for each world.
    """
    own = np.array([crc32(key.encode()), seed & (2**64 - 1)], dtype=np.uint64)
    mixed = _mixed(_mixed(_mixed(own[:1]) ^ own[1:]) ^ seeds.astype(np.uint64))
    mixed = _mixed(mixed ^ steps.astype(np.int64).view(np.uint64))[:, None]
    places = np.arange(2 * dim, dtype=np.uint64)[None]
    uniform = _uniform(mixed + places * _STEP)
    return _normal(uniform[:, :dim], uniform[:, dim:])


class Gaussians:
    """The numbers of `gaussian` for several keys at once.

    Args:
        keys: Key, seed and count of numbers of each.
    """

    def __init__(self, keys: Sequence[tuple[str, int, int]]) -> None:
        own = np.array([[crc32(key.encode()), seed & (2**64 - 1)] for key, seed, _ in keys], dtype=np.uint64)
        self._keys = _mixed(_mixed(own[:, 0]) ^ own[:, 1])
        dims = [dim for _, _, dim in keys]
        self._key_of = np.repeat(np.arange(len(keys)), dims)
        first = np.concatenate([np.arange(dim) for dim in dims])
        self._first = first.astype(np.uint64) * _STEP
        self._second = (first + np.repeat(dims, dims)).astype(np.uint64) * _STEP

    def draw(self, seeds: np.ndarray, steps: np.ndarray) -> Array:
        """The numbers of all keys in each world, (worlds, numbers); arguments are those of `gaussian`."""
        mixed = _mixed(self._keys ^ seeds.astype(np.uint64)[:, None])
        mixed = _mixed(mixed ^ steps.astype(np.int64).view(np.uint64)[:, None])[:, self._key_of]
        return _normal(_uniform(mixed + self._first), _uniform(mixed + self._second))


def _uniform(numbers: np.ndarray) -> np.ndarray:
    """Numbers from 0 to 1."""
    return (_mixed(numbers) >> np.uint64(11)).astype(np.float64) * _PART


def _normal(first: np.ndarray, second: np.ndarray) -> Array:
    """The transform of Box and Muller; 1 - `first` is never 0."""
    return np.sqrt(-2.0 * np.log1p(-first)) * _cosines(second)


def _cosines(turns: np.ndarray) -> np.ndarray:
    """Cosines of angles from 0 to 1 turn, by their series: with the same bits on every machine."""
    # Of an angle and of a full turn less that, cosines are equal; of half a turn less that, opposite.
    within_half = np.minimum(turns, 1.0 - turns)
    is_far = within_half > 0.25
    angles = 2.0 * np.pi * np.where(is_far, 0.5 - within_half, within_half)
    squared, total = angles * angles, np.ones_like(angles)
    for k in range(22, 0, -2):
        total = 1.0 - squared / (k * (k - 1)) * total
    return np.where(is_far, -total, total)


def _mixed(numbers: np.ndarray) -> np.ndarray:
    """The output function of SplitMix64 (Steele, Lea, Flood 2014)."""
    x = numbers + _STEP
    x = (x ^ (x >> np.uint64(30))) * _FIRST
    x = (x ^ (x >> np.uint64(27))) * _SECOND
    return x ^ (x >> np.uint64(31))
