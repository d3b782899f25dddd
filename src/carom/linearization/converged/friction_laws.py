"""Friction without slip, linearised: each law as equations of changes of impulses and of residuals.

With z, changes of impulses beyond those of the first problem, and dx of residuals: B dx + C z = r.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.layouts.linearization import ROW_HOLDS, ROW_SLIDES

# Friction sticks where no residual is greater [m/s or rad/s].
_STICKS = 1e-6
# Impulses of friction that slides, relative to their bounds, are off these by no more: of pyramids, of cones.
_AT_BOUND = 1e-6
_ALIGNED = 1e-4


@dataclass(frozen=True, eq=False, slots=True)
class Linear:
    """Equations of some rows of friction.

    Attributes:
        by_residual: B, (k, k).
        by_impulse: C, (k, k).
        right: r, (k, columns).
        status: `ROW_HOLDS` or `ROW_SLIDES`.
        distance: Which share of the bound is left, NaN for rows at it.
        reason: Why the rows are at no solution, or nothing.
    """

    by_residual: np.ndarray
    by_impulse: np.ndarray
    right: np.ndarray
    status: int = ROW_HOLDS
    distance: float = 1.0
    reason: str = ""


class Law(Protocol):
    """A law of friction."""

    @property
    def rows(self) -> np.ndarray:
        """Numbers of its rows, (k,)."""
        ...

    def impulses(self, residuals: np.ndarray) -> np.ndarray:
        """What follows for the impulses from residuals x, (k,); NaN where it is none, as friction sticks."""
        ...

    def linear(self, residuals: np.ndarray, changes: np.ndarray, impulses: np.ndarray) -> Linear:
        """Its equations.

        Args:
            residuals: x, (k,).
            changes: Derivatives of the impulses of the first problem, (k, columns).
            impulses: Those after the passes, (k,); NaN where they are not known.
        """
        ...


def _sticking(changes: np.ndarray, distance: float) -> Linear:
    size = len(changes)
    return Linear(np.eye(size), np.zeros((size, size)), np.zeros_like(changes), ROW_HOLDS, distance)


def _at_bound(changes: np.ndarray, bounds: np.ndarray) -> Linear:
    size = len(changes)
    return Linear(np.zeros((size, size)), np.eye(size), bounds - changes, ROW_SLIDES, np.nan)


@dataclass(frozen=True, eq=False, slots=True)
class DryFriction:
    """Dry friction of a joint, whose bounds are constant."""

    rows: np.ndarray

    def impulses(self, residuals: np.ndarray) -> np.ndarray:
        """As `Law.impulses`."""
        return np.full(len(residuals), np.nan)

    def linear(self, residuals: np.ndarray, changes: np.ndarray, impulses: np.ndarray) -> Linear:
        """As `Law.linear`."""
        if np.abs(residuals).max() <= _STICKS:
            return _sticking(changes, np.nan)
        return _at_bound(changes, np.zeros_like(changes))


@dataclass(frozen=True, eq=False, slots=True)
class Cone:
    """All friction of a contact: impulses, in units of their coefficients, are within a ball.

    Attributes:
        rows: Its rows, (k,).
        coefficients: μ, (k,).
        push: The normal impulse b.
        push_changes: Its derivatives, (columns,).
    """

    rows: np.ndarray
    coefficients: np.ndarray
    push: float
    push_changes: np.ndarray

    def impulses(self, residuals: np.ndarray) -> np.ndarray:
        """As `Law.impulses`."""
        if np.abs(residuals).max() <= _STICKS:
            return np.full(len(residuals), np.nan)
        y = self.coefficients * residuals
        return -self.push * self.coefficients * y / np.linalg.norm(y)

    def linear(self, residuals: np.ndarray, changes: np.ndarray, impulses: np.ndarray) -> Linear:
        """As `Law.linear`."""
        if np.abs(residuals).max() <= _STICKS:
            left = 1.0 - float(np.linalg.norm(impulses / self.coefficients)) / self.push
            return _sticking(changes, max(left, 0.0))
        y = self.coefficients * residuals
        speed = float(np.linalg.norm(y))
        along = y / speed
        off = np.abs(impulses - self.impulses(residuals)) / (self.push * self.coefficients)
        wrong = off.max() > _ALIGNED
        across = np.eye(len(y)) - np.outer(along, along)
        turning = self.push / speed * self.coefficients[:, None] * across * self.coefficients
        right = -changes - np.outer(self.coefficients * along, self.push_changes)
        reason = f"friction slips by {np.abs(residuals).max():.2g} within its cone" if wrong else ""
        return Linear(turning, np.eye(len(y)), right, ROW_SLIDES, np.nan, reason)


@dataclass(frozen=True, eq=False, slots=True)
class Pyramid:
    """One row of friction of a contact whose cone is a pyramid.

    Attributes:
        rows: The row, (1,).
        bound: Its greatest impulse.
        bound_changes: Derivatives of that, (columns,).
    """

    rows: np.ndarray
    bound: float
    bound_changes: np.ndarray

    def impulses(self, residuals: np.ndarray) -> np.ndarray:
        """As `Law.impulses`."""
        if abs(residuals[0]) <= _STICKS and self.bound > 0.0:
            return np.full(1, np.nan)
        return -np.sign(residuals) * self.bound

    def linear(self, residuals: np.ndarray, changes: np.ndarray, impulses: np.ndarray) -> Linear:
        """As `Law.linear`."""
        rate = float(residuals[0])
        if abs(rate) <= _STICKS and self.bound > 0.0:
            return _sticking(changes, max(1.0 - abs(float(impulses[0])) / self.bound, 0.0))
        sign = -1.0 if rate > 0.0 else 1.0
        found = _at_bound(changes, sign * self.bound_changes[None])
        if abs(float(impulses[0]) - sign * self.bound) > _AT_BOUND * self.bound:
            reason = f"friction slips by {abs(rate):.2g} within its bounds"
            return Linear(found.by_residual, found.by_impulse, found.right, ROW_SLIDES, np.nan, reason)
        return found

    @classmethod
    def rows_of(
        cls,
        rows: np.ndarray,
        coefficients: np.ndarray,
        residuals: np.ndarray,
        residual_changes: np.ndarray,
        first: np.ndarray,
        first_changes: np.ndarray,
        softens: np.ndarray,
    ) -> list[Pyramid]:
        """The rows of a contact.

        Bounds are sums of what both edges of a row push in the first problem, f = max(0, −(x₀ ± μ x)) / R.

        Args:
            rows: Numbers of the rows, (k,).
            coefficients: μ, (k,).
            residuals: x of the normal and of the rows in the first problem, (1 + k,).
            residual_changes: Derivatives of these, (1 + k, columns).
            first: Impulses in the first problem, likewise.
            first_changes: Their derivatives.
            softens: Derivatives of R, relative to it, (columns,).
        """
        sides = coefficients * residuals[1:]
        edges = np.maximum(-residuals[0] - sides, 0.0) + np.maximum(-residuals[0] + sides, 0.0)
        # The normal impulse is the sum of all edges.
        stiffness = first[0] / edges.sum()
        found: list[Pyramid] = []
        for place, row in enumerate(rows.tolist()):
            bound = float(coefficients[place] * edges[place] * stiffness)
            if abs(sides[place]) < -residuals[0]:
                changes = bound * (residual_changes[0] / residuals[0] - softens)
            elif bound > 0.0:
                changes = np.sign(first[1 + place]) * first_changes[1 + place]
            else:
                changes = np.zeros_like(softens)
            found.append(cls(np.array([row]), bound, changes))
        return found
