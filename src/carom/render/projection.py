"""Matrices from the world to pixels. All are 4 x 4 and act on columns (x, y, z, 1)."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Vector3
from carom.native.products import length, product

Matrix = NDArray[np.float64]

_MIN_DETERMINANT = 1e-300


def to_pixels(width: int, height: int) -> Matrix:
    """Matrix from clip coordinates, as in OpenGL, to homogeneous pixel coordinates.

    As in PyBullet the centre of the view is at column width / 2, and height / 2 above the lowest row. This is
    half a pixel from the centre of the image in each direction.
    """
    return np.array(
        [
            [0.5 * width, 0.0, 0.0, 0.5 * width],
            [0.0, -0.5 * height, 0.0, 0.5 * height - 1.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def facing_sign(world_to_pixel: Matrix) -> float:
    """Sign of the volume that the corners of a front-facing triangle span in (column w, row w, w).

    Returns:
        1 or -1; 0 if the matrix is so singular that no triangle is visible.
    """
    column, row, depth, w = world_to_pixel[:, :3].tolist()
    # The direction in which neither column nor row changes: the viewing direction of a parallel projection.
    along = (
        column[1] * row[2] - column[2] * row[1],
        column[2] * row[0] - column[0] * row[2],
        column[0] * row[1] - column[1] * row[0],
    )
    perspective = _dot(along, w)
    if abs(perspective) <= 1e-12 * sqrt(_dot(column, column) * _dot(row, row) * _dot(w, w)):
        perspective = _dot(along, depth)
    return float((perspective < 0.0) - (perspective > 0.0))


def is_singular(matrix: Matrix) -> bool:
    """Whether a matrix is singular."""
    return not abs(np.linalg.det(matrix)) > _MIN_DETERMINANT


def look_at(eye: Vector3 | Matrix, target: Vector3 | Matrix, up: Vector3 = (0.0, 0.0, 1.0)) -> Matrix:
    """World to eye coordinates: x right, y up, z backwards; `up` may be parallel to the viewing direction."""
    start = np.asarray(eye, dtype=np.float64)
    return look_along(start, np.asarray(target, dtype=np.float64) - start, up)


def look_along(eye: Matrix, forward: Matrix, up: Vector3 = (0.0, 0.0, 1.0)) -> Matrix:
    """World to eye coordinates as `look_at`, for a viewing direction of any length."""
    forward = unit_vector(forward)
    right = np.cross(forward, up)
    if length(right) < 1e-9:
        right = np.cross(forward, (0.0, 1.0, 0.0))
    right = unit_vector(right)
    rotation = np.stack([right, np.cross(right, forward), -forward])
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = product(-rotation, eye[:, None])[:, 0]
    return matrix


def unit_vector(vector: Matrix) -> Matrix:
    """A vector of shape (3,), normalised to length 1."""
    return vector / length(vector)


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def parallel_projection(half_size: float, near: float, far: float) -> Matrix:
    """Eye to clip coordinates of an orthographic projection of a square, from `near` to `far` [m]."""
    matrix = np.diag([1.0 / half_size, 1.0 / half_size, -2.0 / (far - near), 1.0])
    matrix[2, 3] = -(far + near) / (far - near)
    return matrix


def pinhole_projection(
    width: int, height: int, fx: float, fy: float, cx: float, cy: float, near: float, far: float
) -> Matrix:
    """Eye to clip coordinates of a pinhole camera; the top left pixel has its centre at (0, 0)."""
    return np.array(
        [
            [2.0 * fx / width, 0.0, 1.0 - 2.0 * cx / width, 0.0],
            [0.0, 2.0 * fy / height, 2.0 * (cy + 1.0) / height - 1.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )


def orthographic_projection(
    width: int, height: int, fx: float, fy: float, cx: float, cy: float, near: float, far: float
) -> Matrix:
    """As `pinhole_projection`, of a camera whose rays are parallel; `fx` and `fy` are pixels per metre."""
    return np.array(
        [
            [2.0 * fx / width, 0.0, 0.0, 2.0 * cx / width - 1.0],
            [0.0, 2.0 * fy / height, 0.0, 1.0 - 2.0 * (cy + 1.0) / height],
            [0.0, 0.0, -2.0 / (far - near), -(far + near) / (far - near)],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def poses_to_matrices(poses: Matrix) -> Matrix:
    """(n, 4, 4) matrices of poses (n, 7): position, unit quaternion (x, y, z, w)."""
    matrices = np.zeros((len(poses), 4, 4))
    x, y, z, w = poses[:, 3:].T
    matrices[:, 0, 0] = 1.0 - 2.0 * (y * y + z * z)
    matrices[:, 0, 1] = 2.0 * (x * y - w * z)
    matrices[:, 0, 2] = 2.0 * (x * z + w * y)
    matrices[:, 1, 0] = 2.0 * (x * y + w * z)
    matrices[:, 1, 1] = 1.0 - 2.0 * (x * x + z * z)
    matrices[:, 1, 2] = 2.0 * (y * z - w * x)
    matrices[:, 2, 0] = 2.0 * (x * z - w * y)
    matrices[:, 2, 1] = 2.0 * (y * z + w * x)
    matrices[:, 2, 2] = 1.0 - 2.0 * (x * x + y * y)
    matrices[:, :3, 3] = poses[:, :3]
    matrices[:, 3, 3] = 1.0
    return matrices
