"""Inertial parameters that are physical for all values of their coordinates."""

from __future__ import annotations

import numpy as np

from carom.checks import Array

# Rows and columns of the lower triangle, the diagonal first.
_ROWS, _COLUMNS = (0, 1, 2, 3, 1, 2, 2, 3, 3, 3), (0, 1, 2, 3, 0, 0, 1, 0, 1, 2)
COORDINATES = len(_ROWS)


class PseudoInertia:
    """The ten inertial parameters of a link as functions of ten coordinates without bounds.

    Parameters are physical, those of some density that is nowhere negative, if and only if the pseudo-inertia
    [[S, h], [hᵀ, m]] is positive definite (Wensing, Kim and Slotine, 2018), with the second moments
    S = tr(I)/2 - I, the first moment h and the mass m. Here it is L T Tᵀ Lᵀ, where L Lᵀ is that at the start
    and T a lower triangle with exponentials on its diagonal: the log-Cholesky coordinates of Rucker and
    Wensing (2022), relative to the start. Coordinates 0 are the start, and all of them are without unit.

    Args:
        parameters: At the start, in the order of `carom.algorithms.inertial_parameters`, (10,).

    Raises:
        ValueError: They are not physical.
    """

    def __init__(self, parameters: Array) -> None:
        try:
            self._start = np.linalg.cholesky(_matrix(parameters))
        except np.linalg.LinAlgError:
            raise ValueError("the inertia is not that of any body of positive density") from None
        self._radius = np.sqrt(np.trace(_matrix(parameters)[:3, :3]) / parameters[0])
        self._mass = float(parameters[0])

    @property
    def scale(self) -> Array:
        """Sizes of the parameters: mass, mass by radius of gyration about the origin, and by its square."""
        sizes = self._mass * self._radius ** np.array([0, 1, 1, 1, 2, 2, 2, 2, 2, 2])
        return np.asarray(sizes, dtype=float)

    def parameters(self, coordinates: Array) -> Array:
        """The inertial parameters at some coordinates, (10,)."""
        factor = self._start @ _triangle(coordinates)
        return _parameters(factor @ factor.T)

    def jacobian(self, coordinates: Array) -> Array:
        """Their derivatives by the coordinates, (10, 10)."""
        factor = self._start @ _triangle(coordinates)
        found = np.zeros((10, COORDINATES))
        for number, (row, column) in enumerate(zip(_ROWS, _COLUMNS, strict=True)):
            change = np.zeros((4, 4))
            change[row, column] = np.exp(coordinates[number]) if row == column else 1.0
            half = self._start @ change @ factor.T
            found[:, number] = _parameters(half + half.T)
        return found


def _triangle(coordinates: Array) -> Array:
    found = np.zeros((4, 4))
    found[_ROWS, _COLUMNS] = np.concatenate([np.exp(coordinates[:4]), coordinates[4:]])
    return found


def _matrix(parameters: Array) -> Array:
    mass, moment = parameters[0], parameters[1:4]
    xx, xy, yy, xz, yz, zz = parameters[4:]
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    found = np.empty((4, 4))
    found[:3, :3] = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    found[:3, 3] = found[3, :3] = moment
    found[3, 3] = mass
    return found


def _parameters(matrix: Array) -> Array:
    second = matrix[:3, :3]
    inertia = np.trace(second) * np.eye(3) - second
    six = inertia[(0, 0, 1, 0, 1, 2), (0, 1, 1, 2, 2, 2)]
    return np.concatenate([[matrix[3, 3]], matrix[:3, 3], six])


def centre_and_inertia(parameters: Array) -> tuple[float, Array, Array]:
    """Mass, centre of mass (3,), and inertia about it (3, 3), in the axes of the link frame."""
    mass, centre = float(parameters[0]), parameters[1:4] / parameters[0]
    xx, xy, yy, xz, yz, zz = parameters[4:]
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return mass, centre, inertia - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
