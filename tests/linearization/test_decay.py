"""Damping that grows with speed, and its derivatives."""

from __future__ import annotations

import numpy as np
import pytest

from carom.linearization.spatial import decay


def test_derivatives_of_decay_rates_are_central_differences_at_any_speed():
    velocities = np.array([(0.1, -0.2, 0.05), (0.6, 0.0, -0.6), (3.0, 4.0, -12.0)])
    rates, slopes = decay(0.3, velocities)
    assert rates == pytest.approx(0.3 * (1.0 + np.linalg.norm(velocities, axis=1)))
    for axis, step in enumerate(1e-6 * np.eye(3)):
        later, before = decay(0.3, velocities + step)[0], decay(0.3, velocities - step)[0]
        assert slopes[:, axis] == pytest.approx((later - before) / 2e-6, abs=1e-8)


def test_at_rest_the_rate_is_the_least_and_has_no_slope():
    rates, slopes = decay(0.3, np.zeros((2, 3)))
    assert rates.tolist() == [0.3, 0.3]
    assert not slopes.any()
