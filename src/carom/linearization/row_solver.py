"""The equations of the rows of a step: how their impulses follow changes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.linearization.rows import Rows

# Singular values of the rows' equations below this share of the greatest one are those of redundant rows: no
# number of sweeps resolves them.
_REDUNDANT = 1e-7


@dataclass(frozen=True, eq=False, slots=True)
class RowSolver:
    """The equations (α J M⁻¹ Jᵀ + β) dλ = side + through dv* - α (J dv + after) of all rows.

    dv are changes of velocities at constant impulses, dv* those without impulses.

    Attributes:
        response: M⁻¹ Jᵀ, (n, rows).
        rates: α J, (rows, n).
        through: See above, (rows, n).
        side: Right sides by states and inputs, less α after, (rows, columns).
        system: The matrix of the equations, each divided by its `scale`, (rows, rows).
        scale: The greatest entry of each, (rows, 1).
        inverse: Inverse of `system`; None where rows are redundant.
    """

    response: np.ndarray
    rates: np.ndarray
    through: np.ndarray
    side: np.ndarray
    system: np.ndarray
    scale: np.ndarray
    inverse: np.ndarray | None

    def changes(self, free: np.ndarray, after: np.ndarray) -> np.ndarray:
        """Changes of velocities (n, columns) by those of impulses, for dv* and dv (n, columns)."""
        wanted = (self.side + self.through @ free - self.rates @ after) / self.scale
        if self.inverse is not None:
            return self.response @ (self.inverse @ wanted)
        return self.response @ np.linalg.lstsq(self.system, wanted, rcond=_REDUNDANT)[0]

    def pulled_back(self, given: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A cotangent of velocities (n,), as one of dv* (n,), of dv (n,), and of states and inputs."""
        pushed = given @ self.response
        if self.inverse is not None:
            found = pushed @ self.inverse
        else:
            # The pseudoinverse of a transposed matrix is the transposed pseudoinverse.
            found = np.linalg.lstsq(self.system.T, pushed, rcond=_REDUNDANT)[0]
        found = found / self.scale[:, 0]
        return found @ self.through, given - found @ self.rates, found @ self.side


def row_solver(rows: Rows, inverse: np.ndarray, after: np.ndarray, smoothing: float) -> RowSolver:
    """The equations of rows.

    Args:
        rows: The rows, at least one.
        inverse: M⁻¹, (n, n).
        after: Changes of the rates of rows by positions, as their Jacobians turn, (rows, n).
        smoothing: Softness of all rows, relative to their own.
    """
    jacobian = rows.jacobian
    alpha, beta = rows.matrix(rows.alpha), rows.matrix(rows.beta)
    response = inverse @ jacobian.T
    rates = alpha @ jacobian
    if smoothing:
        beta += smoothing * alpha * np.einsum("ij,ji->i", jacobian, response)
    side = rows.sides
    side[:, : jacobian.shape[1]] -= alpha @ after
    system = rates @ response + beta
    scale = np.maximum(np.abs(system).max(axis=1, keepdims=True), 1e-300)
    system /= scale
    return RowSolver(response, rates, rows.by_free_velocity, side, system, scale, _inverse(system))


def _inverse(system: np.ndarray) -> np.ndarray | None:
    """The inverse of a matrix that is far from singular, else None."""
    try:
        found = np.linalg.inv(system)
    except np.linalg.LinAlgError:
        return None
    # Of equations far from that the singular values need not be known.
    return found if np.abs(system).sum() * np.abs(found).sum() < 1.0 / _REDUNDANT else None
