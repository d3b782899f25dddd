"""Positions, velocities and accelerations from noisy positions: by a filter, or by polynomials."""

from __future__ import annotations

import numpy as np

from carom.checks import Array
from carom.identification.butterworth import zero_phase

# A signal ends where its power, in bands of this width [Hz], is no more than this multiple of the noise's.
_BAND, _CLEAR = 1.0, 10.0
# A cut-off leaves at least so many times the frequencies of the motion: what friction does is faster.
_ROOM = 5.0
# Joints whose spectrum nowhere exceeds the noise by this factor do not move.
_MOVES = 100.0
# Share of the power of velocities that is the motion.
_MOTION = 0.99


def smoothed(positions: Array, time_step: float, window: int, degree: int) -> tuple[Array, Array, Array]:
    """Positions, velocities and accelerations as the steps of a simulation relate them.

    A polynomial is fitted to the rows around each row (Savitzky and Golay). Steps are semi-implicit: the
    velocity at a row is the difference from the row before, the acceleration the second difference; both are
    taken of the polynomial. So there is no lag of half a step between them.

    Args:
        positions: (N, n).
        time_step: [s].
        window: Rows on each side of a row.
        degree: Of the polynomial.

    Returns:
        Three arrays (N - 2 window, n): the rows at both ends are left out.

    Raises:
        ValueError: The window is too small for the degree, or there are too few rows.
    """
    if not 2 <= degree <= 2 * window:
        raise ValueError(f"degree must be between 2 and twice the window {window}, not {degree}")
    if len(positions) <= 2 * window + 1:
        raise ValueError(f"{len(positions)} rows are too few for a window of {window} on each side")
    places = np.arange(-window, window + 1) / window
    fit = np.linalg.pinv(np.vander(places, degree + 1, increasing=True))
    near = np.vander(np.array([-1.0, 0.0, 1.0]) / window, degree + 1, increasing=True) @ fit
    weights = np.stack(
        [near[1], (near[1] - near[0]) / time_step, (near[2] - 2.0 * near[1] + near[0]) / time_step**2]
    )
    windows = np.lib.stride_tricks.sliding_window_view(positions, 2 * window + 1, axis=0)
    place, velocity, acceleration = np.moveaxis(windows @ weights.T, -1, 0)
    return place, velocity, acceleration


def filtered(positions: Array, time_step: float, cutoff: float) -> tuple[Array, Array, Array]:
    """As `smoothed`, of positions (N, n) after a Butterworth filter without delay, and for all rows.

    Differences are those of `smoothed`; the first and the last row have those of their neighbours.

    Raises:
        ValueError: There is no such filter, or there are too few rows.
    """
    place = zero_phase(positions, cutoff, time_step)
    velocity, acceleration = np.empty_like(place), np.empty_like(place)
    velocity[1:] = np.diff(place, axis=0) / time_step
    velocity[0] = velocity[1]
    acceleration[1:-1] = np.diff(place, 2, axis=0) / time_step**2
    acceleration[0], acceleration[-1] = acceleration[1], acceleration[-2]
    return place, velocity, acceleration


def chosen_cutoff(positions: Array, time_step: float) -> float:
    """A cut-off [Hz] for positions (N, n), from their spectra.

    The noise is taken to be white: the upper half of a spectrum. Each joint's signal ends where its spectrum
    comes down to ten times that; further up, noise of accelerations does more harm than lost details. The
    median of the joints that move counts, but no less than five times the frequencies of the motion, which
    have 99 % of the power of velocities.
    """
    count = len(positions)
    along = np.linspace(0.0, 1.0, count)[:, None]
    level = positions - (positions[0] + (positions[-1] - positions[0]) * along)
    power = np.abs(np.fft.rfft(level * np.hanning(count)[:, None], axis=0)) ** 2
    frequencies = np.fft.rfftfreq(count, time_step)
    # The median of white noise is lower than its mean.
    noise = np.median(power[len(power) // 2 :], axis=0) / np.log(2.0)
    width = 2 * int(0.5 * _BAND / frequencies[1]) + 1
    ends: list[float] = []
    motion = 0.0
    for own, level_of_noise in zip(power.T, noise.tolist(), strict=True):
        if not own.max() > _MOVES * level_of_noise:
            continue
        mean = np.convolve(own, np.ones(width), "same") / np.convolve(
            np.ones(len(own)), np.ones(width), "same"
        )
        below = np.flatnonzero(mean <= _CLEAR * level_of_noise)
        end = int(below[0]) if len(below) else len(own) - 1
        ends.append(float(frequencies[end]))
        rates = np.cumsum(frequencies[: end + 1] ** 2 * np.maximum(own[: end + 1] - level_of_noise, 0.0))
        motion = max(motion, float(frequencies[int(np.searchsorted(rates, _MOTION * rates[-1]))]))
    highest = 0.4 / time_step
    if not ends:
        return 0.5 * highest
    return float(min(max(float(np.median(ends)), _ROOM * motion, 3.0 * frequencies[1]), highest))
