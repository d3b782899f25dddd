"""Butterworth low-pass filters that run forwards and backwards, so that nothing is delayed."""

from __future__ import annotations

import numpy as np

from carom.checks import Array

ORDER = 4
# So many rows at each end does the filter continue the signal by, as its point reflection.
PADDING = 3 * (ORDER + 1)


def coefficients(cutoff: float, time_step: float) -> tuple[Array, Array]:
    """Numerator and denominator, (`ORDER` + 1,) each, of a digital low pass by the bilinear transform.

    Args:
        cutoff: Frequency at which a pass halves the power [Hz], below half the rate.
        time_step: [s].

    Raises:
        ValueError: There is no such filter.
    """
    share = 2.0 * cutoff * time_step
    if not 0.0 < share < 1.0:
        raise ValueError(
            f"the cut-off must be between 0 and {0.5 / time_step:g} Hz, half the log's rate, not {cutoff:g}"
        )
    warped = np.tan(0.5 * np.pi * share)
    angles = np.pi * (2.0 * np.arange(ORDER) + ORDER + 1.0) / (2.0 * ORDER)
    analog = warped * np.exp(1j * angles)
    poles = (1.0 + analog) / (1.0 - analog)
    denominator = np.real(np.poly(poles))
    numerator = np.real(np.poly(-np.ones(ORDER)))
    return numerator * (denominator.sum() / numerator.sum()), denominator


def zero_phase(signals: Array, cutoff: float, time_step: float) -> Array:
    """Signals (N, ...) after the filter has run forwards, and then backwards, along the first axis.

    At both ends they are continued by their point reflections, and each pass begins as if its first value had
    been there for ever.

    Raises:
        ValueError: There is no such filter, or there are too few rows.
    """
    if len(signals) <= PADDING:
        raise ValueError(f"{len(signals)} rows are too few for a filter, which needs more than {PADDING}")
    numerator, denominator = coefficients(cutoff, time_step)
    rows = signals.reshape(len(signals), -1)
    before = 2.0 * rows[0] - rows[PADDING:0:-1]
    after = 2.0 * rows[-1] - rows[-2 : -PADDING - 2 : -1]
    padded = np.concatenate([before, rows, after])
    once = _passed(padded, numerator, denominator)
    twice = _passed(once[::-1], numerator, denominator)[::-1]
    return twice[PADDING:-PADDING].reshape(signals.shape)


def _passed(rows: Array, numerator: Array, denominator: Array) -> Array:
    """Rows (N, m) filtered once, from the memory of a filter that has always seen the first of them."""
    feed, back = numerator[1:, None], denominator[1:, None]
    # What the memory becomes for a constant input of 1: each entry is the sum of what is after it.
    rest = numerator[1:] - denominator[1:]
    memory = np.cumsum(rest[::-1])[::-1][:, None] * rows[0]
    found, ahead = np.empty_like(rows), np.zeros((ORDER, rows.shape[1]))
    for index, row in enumerate(rows):
        out = numerator[0] * row + memory[0]
        found[index] = out
        ahead[:-1] = memory[1:]
        memory = ahead + feed * row - back * out
    return found
