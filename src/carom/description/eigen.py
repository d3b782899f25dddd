"""Eigenvalues and eigenvectors of symmetric matrices of three rows, with the same bits on every machine."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import Vector3
from carom.description.transform import Matrix3, dot

if TYPE_CHECKING:
    from numpy.typing import NDArray

_EPSILON = 2.220446049250313e-16
# With these, all digits are right.
_PRECISION, _MAX_ROTATIONS = 1e-16, 60


def diagonalize(tensor: Matrix3, threshold: float, most_steps: int) -> tuple[Vector3, Matrix3]:
    """Eigenvalues of a symmetric matrix, and a matrix with the eigenvectors as columns, by Jacobi rotations.

    Each rotation makes the largest off-diagonal entry zero. The eigenvalues are in the order in which they
    appear on the diagonal, and the matrix of eigenvectors is a rotation, not a reflection. Once the largest
    off-diagonal entry is at most `threshold` times the sum of magnitudes on the diagonal, one last rotation
    is made.
    """
    a = [list(row) for row in tensor]
    v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    step = most_steps
    while step > 0:
        p, q, r = max(((0, 1, 2), (0, 2, 1), (1, 2, 0)), key=lambda pqr: abs(a[pqr[0]][pqr[1]]))
        largest = abs(a[p][q])
        limit = threshold * (abs(a[0][0]) + abs(a[1][1]) + abs(a[2][2]))
        if largest <= limit:
            if largest <= _EPSILON * limit:
                break
            step = 1
        theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q])
        if theta**4 < 10.0 / _EPSILON:
            t = 1.0 / (
                theta + sqrt(1.0 + theta * theta) if theta >= 0.0 else theta - sqrt(1.0 + theta * theta)
            )
            cosine = 1.0 / sqrt(1.0 + t * t)
        else:
            t = 1.0 / (theta * (2.0 + 0.5 / (theta * theta)))
            cosine = 1.0 - 0.5 * t * t
        sine = cosine * t
        shift = t * a[p][q]
        a[p][q] = a[q][p] = 0.0
        a[p][p] -= shift
        a[q][q] += shift
        a[r][p], a[r][q] = cosine * a[r][p] - sine * a[r][q], cosine * a[r][q] + sine * a[r][p]
        a[p][r], a[q][r] = a[r][p], a[r][q]
        for row in v:
            row[p], row[q] = cosine * row[p] - sine * row[q], cosine * row[q] + sine * row[p]
        step -= 1
    eigenvectors = ((v[0][0], v[0][1], v[0][2]), (v[1][0], v[1][1], v[1][2]), (v[2][0], v[2][1], v[2][2]))
    return (a[0][0], a[1][1], a[2][2]), eigenvectors


def principal_axes(tensor: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Eigenvalues (3,) of a symmetric matrix (3, 3), the least first, and the eigenvectors.

    These are the columns of a rotation (3, 3).
    """
    moments, axes = diagonalize(tensor.tolist(), _PRECISION, _MAX_ROTATIONS)
    i, j, k = sorted((0, 1, 2), key=moments.__getitem__)
    a, b, c = ((row[i], row[j], row[k]) for row in axes)
    normal = (b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0])
    if dot(a, normal) < 0.0:
        a, b, c = ((row[0], row[1], -row[2]) for row in (a, b, c))
    return np.array([moments[i], moments[j], moments[k]]), np.array([a, b, c])
