"""Residuals of several logs at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.identification.least_squares import Normal
from carom.identification.measurements import Measurements
from carom.identification.prediction_residuals import PredictionResiduals
from carom.identification.torque_residuals import TorqueResiduals


class SeveralLogs:
    """The residuals of several logs, each weighted by its own noise.

    Attributes:
        problems: Those of each log.
        channels: Names of the channels, which all have.

    Raises:
        ValueError: Logs have different channels.
    """

    def __init__(self, problems: Sequence[TorqueResiduals | PredictionResiduals]) -> None:
        self.problems: list[TorqueResiduals | PredictionResiduals] = list(problems)
        self.channels: tuple[str, ...] = self.problems[0].channels
        for number, it in enumerate(self.problems):
            if it.channels != self.channels:
                raise ValueError(
                    f"log {number} has other channels than log 0: {it.channels}, not {self.channels}; "
                    "velocities have to be in all logs or in none"
                )

    @property
    def deviations(self) -> Array:
        """Standard deviations of the residuals of all channels of all logs, one log after the other."""
        return np.concatenate([it.deviations for it in self.problems])

    @property
    def noise(self) -> Array:
        """Noise of the channels: the root mean square over the logs."""
        return np.sqrt(np.mean([it.noise**2 for it in self.problems], axis=0))

    @property
    def cutoff(self) -> float | None:
        """The least cut-off of a filter [Hz]; None if there was none."""
        chosen = [it.cutoff for it in self.problems if it.cutoff is not None]
        return min(chosen, default=None)

    def model(self, p: Array) -> Normal:
        """The cost at some values, and its derivatives."""
        parts = [it.model(p) for it in self.problems]

        def follow(change: Array) -> None:
            for part in parts:
                part.follow(change)

        return Normal(
            float(sum(part.cost for part in parts)),
            np.sum([part.gradient for part in parts], axis=0),
            np.sum([part.matrix for part in parts], axis=0),
            follow,
        )

    def reweight(self, p: Array) -> None:
        """Set the deviations by the residuals at some values."""
        for it in self.problems:
            it.reweight(p)

    def spread(self, p: Array) -> Array | None:
        """Covariance of the gradient of the cost, where noise of rows depends on each other."""
        parts = [found for it in self.problems if (found := it.spread(p)) is not None]
        return np.sum(parts, axis=0) if parts else None

    def fit(self, p: Array) -> tuple[NDArray[np.intp], Array, Array]:
        """Rows of all logs, one after the other, measured and fitted values."""
        rows, measured, fitted, first = [], [], [], 0
        for it in self.problems:
            own, seen, found = it.fit(p)
            rows.append(first + np.arange(it.row_count)[own])
            measured.append(seen)
            fitted.append(found)
            first += it.row_count
        return np.concatenate(rows), np.concatenate(measured), np.concatenate(fitted)


def times_of(logs: Sequence[Measurements]) -> Array:
    """Times of the rows of logs, one after the other [s]."""
    parts, begin = [], 0.0
    for log in logs:
        parts.append(begin + log.time_step * np.arange(len(log), dtype=float))
        begin += log.time_step * len(log)
    return np.concatenate(parts)
