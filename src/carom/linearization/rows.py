"""Rows of the solver, linearised.

Together they are α d(J v⁺) + β dλ = the right side, with matrices α and β over the rows. A row that holds
within its bounds has an entry of α on the diagonal, one at a bound of its impulse only entries of β.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace

HOLDS, LOWER, UPPER, SATURATED, SLIDES = (
    "holds",
    "at its lower bound",
    "at its upper bound",
    "at its greatest velocity",
    "slides",
)
# Impulses this near to a bound, relative to it, are at it: clamping rounds.
NEAR = 1e-9


class Rows:
    """Linearised rows, in the order they are added.

    Attributes:
        names: Name and status of each, such as ("motor of arm.elbow", "holds").
        impulses: Their impulses.
        alpha, beta: Entries of the matrices α and β, (row, column, value).
        hessians: Derivatives of Jacobians by positions, by row: of entry i by dof j, (n, n).
    """

    def __init__(self, space: TangentSpace, inputs: Sequence[Input], most: int) -> None:
        """Make room for at most so many rows."""
        dofs, active = len(space), len(space.activations)
        self._dofs, self._states = dofs, 2 * dofs + active
        self.all_inputs: Sequence[Input] = inputs
        self._columns: dict[tuple[str, tuple[int, ...]], list[int]] | None = None
        self.names: list[tuple[str, str]] = []
        self.impulses: list[float] = []
        self.alpha: list[tuple[int, int, float]] = []
        self.beta: list[tuple[int, int, float]] = []
        self.hessians: dict[int, np.ndarray] = {}
        self._jacobian = np.zeros((most, dofs))
        self._by_free_velocity = np.zeros((most, dofs))
        self._sides = np.zeros((most, self._states + len(inputs)))

    def __len__(self) -> int:
        return len(self.names)

    @property
    def jacobian(self) -> np.ndarray:
        """J, (rows, n)."""
        return self._jacobian[: len(self.names)]

    @property
    def sides(self) -> np.ndarray:
        """Derivatives of right sides by the state before the step and by inputs, (rows, nx + inputs)."""
        return self._sides[: len(self.names)]

    @property
    def by_free_velocity(self) -> np.ndarray:
        """Derivatives of right sides by velocities after free motion, (rows, n)."""
        return self._by_free_velocity[: len(self.names)]

    @property
    def by_position(self) -> np.ndarray:
        """Derivatives of right sides by positions, (rows, n): part of `sides`."""
        return self.sides[:, : self._dofs]

    @property
    def by_activation(self) -> np.ndarray:
        """Derivatives of right sides by activations, (rows, a): part of `sides`."""
        return self.sides[:, 2 * self._dofs : self._states]

    @property
    def by_input(self) -> np.ndarray:
        """Derivatives of right sides by inputs, (rows, inputs): part of `sides`."""
        return self.sides[:, self._states :]

    def add(
        self, name: str, status: str, jacobian: np.ndarray, impulse: float, alpha: float, beta: float
    ) -> int:
        """Add a row without right side; returns its number."""
        row = self._add(name, status, impulse, alpha, beta)
        self._jacobian[row] = jacobian
        return row

    def add_of_dof(self, name: str, status: str, dof: int, impulse: float, alpha: float, beta: float) -> int:
        """As `add`, for a row on one dof."""
        row = self._add(name, status, impulse, alpha, beta)
        self._jacobian[row, dof] = 1.0
        return row

    def _add(self, name: str, status: str, impulse: float, alpha: float, beta: float) -> int:
        row = len(self.names)
        self.names.append((name, status))
        self.impulses.append(impulse)
        if alpha:
            self.alpha.append((row, row, alpha))
        if beta:
            self.beta.append((row, row, beta))
        return row

    def set_hessian(self, row: int, hessian: np.ndarray) -> None:
        """Set the derivatives of a row's Jacobian by positions: of entry i by dof j, (n, n)."""
        self.hessians[row] = hessian

    def matrix(self, entries: list[tuple[int, int, float]]) -> np.ndarray:
        """`alpha` or `beta` as a matrix."""
        found = np.zeros((len(self), len(self)))
        for row, column, value in entries:
            found[row, column] += value
        return found

    def generalized_impulses(self) -> np.ndarray:
        """Jᵀ λ of all rows, (n,)."""
        return np.array(self.impulses) @ self.jacobian if self.impulses else np.zeros(self._dofs)

    def set_input(self, row: int, field: str, place: tuple[int, ...], derivative: float) -> None:
        """Set the derivative of a row's right side by the number stored at a place."""
        columns = self._columns
        if columns is None:
            # Inputs by where they are stored.
            columns = self._columns = {}
            for column, given in enumerate(self.all_inputs):
                columns.setdefault((given.field, given.place), []).append(column)
        for column in columns.get((field, place), ()):
            self._sides[row, self._states + column] += derivative * self.all_inputs[column].scale


def status_of(impulse: float, lower: float, upper: float) -> str:
    """Whether a row holds, or at which bound its impulse is."""
    if impulse <= lower + NEAR * abs(lower):
        return LOWER
    return UPPER if impulse >= upper - NEAR * abs(upper) else HOLDS
