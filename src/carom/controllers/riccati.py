"""The discrete algebraic Riccati equation."""

from __future__ import annotations

import numpy as np

from carom.checks import Array

_ITERATIONS = 100
_CONVERGED = 1e-13


def solve_discrete_are(a: np.ndarray, b: np.ndarray, q: np.ndarray, r: np.ndarray) -> Array:
    """The stabilising solution P of P = Aᵀ P A - Aᵀ P B (R + Bᵀ P B)⁻¹ Bᵀ P A + Q.

    Found by doubling: n iterations are as many as 2ⁿ steps of the Riccati recursion from P = 0.

    Args:
        a: A, (nx, nx).
        b: B, (nx, nu).
        q: Q, symmetric, without negative eigenvalues, (nx, nx).
        r: R, symmetric, with positive eigenvalues, (nu, nu).

    Returns:
        Symmetric matrix (nx, nx).

    Raises:
        ValueError: There is no such solution: a motion that costs something and does not decay cannot be
            controlled.
    """
    identity = np.eye(len(a))
    transition, reach, cost = a, b @ np.linalg.solve(r, b.T), q
    for _ in range(_ITERATIONS):
        with np.errstate(all="ignore"):
            try:
                solved = np.linalg.solve(identity + reach @ cost, np.hstack([transition, reach]))
            except np.linalg.LinAlgError:
                break
            moved, reached = solved[:, : len(a)], solved[:, len(a) :]
            change = transition.T @ cost @ moved
            reach = reach + transition @ reached @ transition.T
            transition = transition @ moved
            cost = cost + 0.5 * (change + change.T)
        if not (np.isfinite(cost).all() and np.isfinite(reach).all()):
            break
        if np.abs(change).max(initial=0.0) <= _CONVERGED * np.abs(cost).max(initial=0.0):
            return cost
    raise ValueError(
        "the Riccati equation has no stabilising solution: something in the state that the cost is on can "
        "neither be controlled nor decays; leave it out of the cost, or use a discount below 1"
    )


def lqr_gains(a: np.ndarray, b: np.ndarray, q: np.ndarray, r: np.ndarray) -> tuple[Array, Array]:
    """Gains K of the least sum of xᵀ Q x + uᵀ R u with u = -K x, (nu, nx), and P, (nx, nx).

    Arguments and errors are those of `solve_discrete_are`.
    """
    value = solve_discrete_are(a, b, q, r)
    return np.linalg.solve(r + b.T @ value @ b, b.T @ value @ a), value
