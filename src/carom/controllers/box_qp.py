"""Quadratic programs with bounds of the variables, by projected Newton steps (Tassa et al. 2014)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.checks import Array

_ITERATIONS = 100
_GRADIENT = 1e-10
# Armijo's condition of the line search.
_SHARE, _BACK, _SHORTEST = 0.1, 0.6, 1e-20


class BoxQP(NamedTuple):
    """The solution.

    Attributes:
        x: The minimiser, (n,).
        free: Which variables are not at a bound, (n,).
    """

    x: Array
    free: np.ndarray


def solve_box_qp(h: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> BoxQP:
    """Minimise xᵀ H x / 2 + gᵀ x with lower ≤ x ≤ upper.

    Args:
        h: H, symmetric, with positive eigenvalues, (n, n).
        g: (n,).
        lower: (n,); may be -infinity.
        upper: (n,); may be infinity.

    Raises:
        numpy.linalg.LinAlgError: H has an eigenvalue that is not positive.
    """
    np.linalg.cholesky(h)
    x = np.clip(np.zeros_like(g), lower, upper)
    free = np.ones(len(g), dtype=bool)
    for _ in range(_ITERATIONS):
        gradient = g + h @ x
        free = ~(((x <= lower) & (gradient > 0.0)) | ((x >= upper) & (gradient < 0.0)))
        if not free.any() or np.abs(gradient[free]).max() <= _GRADIENT * (1.0 + np.abs(g).max()):
            break
        direction = np.zeros_like(x)
        direction[free] = -np.linalg.solve(h[np.ix_(free, free)], gradient[free])
        slope, before = float(gradient @ direction), _value(h, g, x)
        length, trial = 1.0, x
        while length > _SHORTEST:
            trial = np.clip(x + length * direction, lower, upper)
            if _value(h, g, trial) <= before + _SHARE * length * slope or (trial == x).all():
                break
            length *= _BACK
        if (trial == x).all():
            break
        x = trial
    return BoxQP(x, free)


def _value(h: np.ndarray, g: np.ndarray, x: np.ndarray) -> float:
    return float(0.5 * x @ h @ x + g @ x)
