"""Scalar products, matrix products and the like, with the same bits on every machine.

NumPy computes matrix products by `@` with a library whose order of summation depends on the processor.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def product(a: Floats, b: Floats) -> Floats:
    """Product of matrices, or of stacks of them, with terms added in order of their index.

    Shapes are (..., n, k) and (..., k, m), that of the product is (..., n, m).
    """
    total = a[..., :, :1] * b[..., :1, :]
    for k in range(1, a.shape[-1]):
        total += a[..., :, k, None] * b[..., k, None, :]
    return total


def dots(a: Floats, b: Floats) -> Floats:
    """Scalar products of vectors of shape (..., n), with terms added in order of their index.

    The axes before the last are broadcast against each other.
    """
    total = a[..., 0] * b[..., 0]
    for k in range(1, a.shape[-1]):
        total = total + a[..., k] * b[..., k]
    return total


def crosses(a: Floats, b: Floats) -> Floats:
    """Vector products of vectors of shape (..., 3), the bits of `numpy.cross` in a fraction of its time."""
    first = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    second = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    return np.stack([first, second, a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], axis=-1)


def determinants(matrices: Floats) -> Floats:
    """Determinants of matrices of shape (..., 3, 3)."""
    return dots(matrices[..., 0, :], crosses(matrices[..., 1, :], matrices[..., 2, :]))


def inverses(matrices: Floats) -> Floats:
    """Inverses of matrices of shape (..., 3, 3), none of them singular, by their cofactors."""
    a, b, c = (matrices[..., row, :] for row in range(3))
    cofactors = np.stack([crosses(b, c), crosses(c, a), crosses(a, b)], axis=-1)
    return cofactors / determinants(matrices)[..., None, None]


def turned_tensor(turn: Floats, tensor: Floats) -> Floats:
    """A symmetric tensor (3, 3) in the axes that a rotation matrix (3, 3) turns its own to."""
    return product(product(turn, tensor), turn.T)


def length(vector: Floats) -> float:
    """Length of a vector of shape (n,)."""
    return sqrt(sum(x * x for x in vector.tolist()))
