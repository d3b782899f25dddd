"""Rotations by rotation vectors: exponential map, logarithm, and their derivatives, for arrays of them."""

from __future__ import annotations

import numpy as np

_SMALL = 1e-6
# Angles below this have their derivatives by series.
_SERIES = 1e-4
_UNIT = np.eye(3)


def cross_matrix(vectors: np.ndarray) -> np.ndarray:
    """Matrices [v]x with [v]x w = v x w, (..., 3, 3), of vectors (..., 3)."""
    matrices = np.zeros((*vectors.shape[:-1], 3, 3))
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    matrices[..., 0, 1], matrices[..., 0, 2], matrices[..., 1, 2] = -z, y, -x
    matrices[..., 1, 0], matrices[..., 2, 0], matrices[..., 2, 1] = z, -y, x
    return matrices


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products of vectors (..., 3), as `numpy.cross`, in less time."""
    found = np.empty(np.broadcast_shapes(a.shape, b.shape))
    found[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    found[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    found[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return found


def quaternion_of(vectors: np.ndarray) -> np.ndarray:
    """Quaternions (x, y, z, w), (..., 4), of rotation vectors (..., 3) [rad]."""
    angles = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True))
    return np.concatenate([0.5 * np.sinc(0.5 * angles / np.pi) * vectors, np.cos(0.5 * angles)], axis=-1)


def vector_of(quaternions: np.ndarray) -> np.ndarray:
    """Rotation vectors (..., 3) [rad] of unit quaternions (..., 4); their angles are at most π."""
    sign = np.where(quaternions[..., 3:] < 0.0, -1.0, 1.0)
    axes, cosines = sign * quaternions[..., :3], sign * quaternions[..., 3:]
    sines = np.sqrt((axes * axes).sum(axis=-1, keepdims=True))
    small = sines < _SMALL
    return axes * np.where(small, 2.0, 2.0 * np.arctan2(sines, cosines) / np.where(small, 1.0, sines))


def multiplied(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products of quaternions (..., 4): first b, then a."""
    vector = a[..., 3:] * b[..., :3] + b[..., 3:] * a[..., :3] + cross(a[..., :3], b[..., :3])
    scalar = a[..., 3:] * b[..., 3:] - (a[..., :3] * b[..., :3]).sum(axis=-1, keepdims=True)
    return np.concatenate([vector, scalar], axis=-1)


def inverse(quaternions: np.ndarray) -> np.ndarray:
    """Inverses of unit quaternions (..., 4)."""
    return quaternions * np.array([-1.0, -1.0, -1.0, 1.0])


def matrix_of(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    skew = cross_matrix(quaternions[..., :3])
    return np.eye(3) + 2.0 * quaternions[..., 3, None, None] * skew + 2.0 * skew @ skew


def rotation_of(quaternion: np.ndarray) -> np.ndarray:
    """As `matrix_of`, of one quaternion (4,), in less time."""
    x, y, z, w = quaternion.tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def left_derivative(vector: np.ndarray) -> np.ndarray:
    """The matrix L with exp(v + d) = exp(L d) exp(v) to first order, (3, 3), of a rotation vector (3,)."""
    skew = cross_matrix(vector)
    angle = float(np.sqrt(vector @ vector))
    if angle < 1e-4:
        return np.eye(3) + 0.5 * skew + skew @ skew / 6.0
    first = (1.0 - np.cos(angle)) / angle**2
    return np.eye(3) + first * skew + (angle - np.sin(angle)) / angle**3 * (skew @ skew)
