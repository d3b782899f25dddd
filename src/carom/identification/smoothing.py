"""Positions, velocities and accelerations from noisy positions, by polynomials fitted to windows."""

from __future__ import annotations

import numpy as np

from carom.checks import Array


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
