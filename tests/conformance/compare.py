"""How closely the engines must agree, and where they do not.

The norm for motion: a series is one quantity over time (all components of a vector together);
its scale is the greatest magnitude PyBullet's series reaches, and the error is the greatest
difference divided by that scale. A zero of one component is therefore judged against the others,
but never against other quantities. Information is judged row by row (one row is one link or
joint), because links of very different size share a table. Scales have a floor, so that a
quantity that is nothing but rounding is compared absolutely.

Whole numbers and text must be equal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .scenario import Kind, Scenario, Series

MOTION_TOLERANCE = 1e-6
INFO_TOLERANCE = 1e-9
SINGLE_PRECISION_TOLERANCE = 1e-6
SCALE_FLOOR = 1e-6


@dataclass(frozen=True)
class Agreement:
    """How one series of two engines compares.

    Attributes:
        series: Its name.
        error: Greatest relative error (infinite if shape, text or whole numbers differ).
        tolerance: Greatest error allowed.
        sample: First sample or row beyond the tolerance, else that of the greatest error.
        detail: What the engines said there.
    """

    series: str
    error: float
    tolerance: float
    sample: int
    detail: str

    @property
    def holds(self) -> bool:
        """Whether the error is within the tolerance; false for NaN."""
        return self.error <= self.tolerance

    def __str__(self) -> str:
        verdict = "ok" if self.holds else "DIFFERS"
        return (
            f"{self.series}: {verdict}, error {self.error:.3g} "
            f"(allowed {self.tolerance:g}), sample {self.sample}: {self.detail}"
        )


def tolerance_of(scenario: Scenario, series: str) -> float:
    """The greatest relative error promised for a series."""
    if isinstance(scenario.tolerance, (int, float)):
        return scenario.tolerance
    for ending, tolerance in (scenario.tolerance or {}).items():
        if series.endswith(ending):
            return tolerance
    if scenario.is_single_precision(series):
        return SINGLE_PRECISION_TOLERANCE
    return INFO_TOLERANCE if scenario.kind is Kind.INFO else MOTION_TOLERANCE


def compare(scenario: Scenario, golden: Series, measured: Series) -> list[Agreement]:
    """Compare all series of a scenario; a series only one side has is an infinite error."""
    agreements = []
    for name in sorted(golden.keys() | measured.keys()):
        tolerance = tolerance_of(scenario, name)
        if name not in golden or name not in measured:
            missing = "PyBullet" if name not in golden else "Carom"
            agreements.append(Agreement(name, np.inf, tolerance, 0, f"{missing} has no such series"))
        else:
            agreements.append(
                _compare_one(name, golden[name], measured[name], tolerance, scenario.kind is Kind.INFO)
            )
    return agreements


def _compare_one(
    name: str, golden: np.ndarray, measured: np.ndarray, tolerance: float, by_row: bool
) -> Agreement:
    if golden.shape != measured.shape:
        detail = f"shape {golden.shape} in PyBullet, {measured.shape} in Carom"
        return Agreement(name, np.inf, tolerance, 0, detail)
    if golden.size == 0:
        return Agreement(name, 0.0, tolerance, 0, "empty")
    if golden.dtype.kind != "f":
        errors = np.where(golden == measured, 0.0, np.inf)
    else:
        errors = relative_errors(golden, measured.astype(np.float64), by_row)
    per_sample = np.atleast_1d(errors.reshape(len(errors), -1).max(axis=1) if errors.ndim else errors)
    beyond = np.flatnonzero(~(per_sample <= tolerance))
    sample = int(beyond[0]) if beyond.size else int(per_sample.argmax())
    detail = f"{np.atleast_1d(golden)[sample]} in PyBullet, {np.atleast_1d(measured)[sample]} in Carom"
    return Agreement(name, float(per_sample.max()), tolerance, sample, detail)


def relative_errors(golden: np.ndarray, measured: np.ndarray, by_row: bool) -> np.ndarray:
    """Differences over the scale of the series, or of each row; NaN where either is NaN."""
    if by_row and golden.ndim > 1:
        scale = np.abs(golden).reshape(len(golden), -1).max(axis=1)
        scale = scale.reshape((-1,) + (1,) * (golden.ndim - 1))
    elif by_row:
        scale = np.abs(golden)
    else:
        scale = np.abs(golden).max()
    return np.abs(golden - measured) / np.maximum(scale, SCALE_FLOOR)
