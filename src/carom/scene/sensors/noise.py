"""Gaussian noise that is a function of seeds and of the number of the step, so that it needs no state."""

from __future__ import annotations

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
    uniform = (_mixed(mixed + places * _STEP) >> np.uint64(11)).astype(np.float64) * _PART
    # The transform of Box and Muller; 1 - u is never 0.
    distance = np.sqrt(-2.0 * np.log1p(-uniform[:, :dim]))
    return distance * _cosines(uniform[:, dim:])


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
