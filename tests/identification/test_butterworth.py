"""The filter of logs, beside SciPy's, and the cut-off that is chosen."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom.identification.butterworth import ORDER, coefficients, zero_phase
from carom.identification.smoothing import chosen_cutoff, filtered

STEP = 1 / 240


@pytest.mark.parametrize("cutoff", [1.5, 5.0, 20.0, 100.0])
def test_the_filter_is_that_of_scipy(cutoff: float):
    signal = pytest.importorskip("scipy.signal", reason="the filter is compared with SciPy's")
    numerator, denominator = signal.butter(ORDER, cutoff, fs=1.0 / STEP)
    for found, wanted in zip(coefficients(cutoff, STEP), (numerator, denominator), strict=True):
        assert_allclose(found, wanted, rtol=0, atol=1e-14)
    rows = np.cumsum(np.random.default_rng(1).normal(size=(400, 2, 3)), axis=0)
    wanted = signal.filtfilt(numerator, denominator, rows, axis=0)
    # Coefficients of low cut-offs are known to rounding only.
    assert_allclose(zero_phase(rows, cutoff, STEP), wanted, rtol=0, atol=1e-6 if cutoff < 5.0 else 1e-8)


def test_filters_that_there_are_not_are_refused():
    for cutoff in (0.0, 120.0, np.nan):
        with pytest.raises(ValueError, match="between 0 and 120 Hz"):
            zero_phase(np.zeros((100, 1)), cutoff, STEP)
    with pytest.raises(ValueError, match="15 rows are too few"):
        zero_phase(np.zeros((15, 1)), 5.0, STEP)


def test_differences_of_a_filtered_motion_are_those_of_steps():
    time = STEP * np.arange(1200)
    positions = np.stack([np.sin(2.0 * time), np.cos(3.0 * time)], axis=1)
    place, velocity, acceleration = filtered(positions, STEP, 10.0)
    inner = slice(100, -100)
    assert_allclose(place[inner], positions[inner], atol=1e-4)
    rates = np.diff(positions, axis=0) / STEP
    assert_allclose(velocity[1:][inner], rates[inner], atol=1e-3)
    assert_allclose(acceleration[1:-1][inner], (np.diff(rates, axis=0) / STEP)[inner], atol=1e-2)


@pytest.mark.parametrize("noise", [1e-5, 1e-3])
def test_a_cutoff_is_above_the_motion_and_below_the_noise(noise: float):
    rng = np.random.default_rng(3)
    time = STEP * np.arange(2400)
    positions = np.stack([np.sin(5.0 * time), 0.5 * np.cos(2.0 * time), np.full(len(time), 0.2)], axis=1)
    positions += rng.normal(0.0, noise, positions.shape)
    cutoff = chosen_cutoff(positions, STEP)
    assert 3.0 < cutoff < 20.0
    _, velocity, _ = filtered(positions, STEP, cutoff)
    error = velocity[300:-300, 0] - 5.0 * np.cos(5.0 * (time[300:-300] - 0.5 * STEP))
    # Differences as they are have an error of 1.4 noise / step.
    assert np.sqrt((error**2).mean()) < 0.04 * noise / STEP + 1e-3


def test_a_log_that_stands_still_has_a_cutoff():
    assert 0.0 < chosen_cutoff(np.zeros((100, 2)), STEP) < 120.0
