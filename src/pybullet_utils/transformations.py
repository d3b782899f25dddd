"""Rotations and homogeneous transforms as NumPy arrays.

Quaternions are (x, y, z, w), matrices 4 by 4, vectors columns. Four letters name the axes of Euler angles:
`s` for fixed (static) axes or `r` for axes that rotate with the body, then the three axes in order. The
default `sxyz` is roll, pitch and yaw.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, atan2, cos, pi, sin, sqrt

import numpy as np

from pybullet._absent import absent_names

Numbers = Sequence[float] | np.ndarray

_AXES = "xyz"
# Tolerance for gimbal lock, zero lengths and singular matrices.
_SMALL = 4.0 * float(np.finfo(float).eps)


def identity_matrix() -> np.ndarray:
    """The identity transform."""
    return np.identity(4)


def translation_matrix(direction: Numbers) -> np.ndarray:
    """The translation by a vector of three components."""
    matrix = np.identity(4)
    matrix[:3, 3] = np.asarray(direction, dtype=float)[:3]
    return matrix


def translation_from_matrix(matrix: Numbers) -> np.ndarray:
    """The translation part of a transform."""
    return np.array(matrix, dtype=float)[:3, 3].copy()


def scale_matrix(
    factor: float, origin: Numbers | None = None, direction: Numbers | None = None
) -> np.ndarray:
    """The scaling by `factor` about an origin, along one direction or along all."""
    matrix = np.identity(4)
    if direction is None:
        matrix[:3, :3] *= factor
    else:
        along = unit_vector(np.asarray(direction, dtype=float)[:3])
        matrix[:3, :3] -= (1.0 - factor) * np.outer(along, along)
    if origin is not None:
        centre = np.asarray(origin, dtype=float)[:3]
        matrix[:3, 3] = centre - matrix[:3, :3] @ centre
    return matrix


def reflection_matrix(point: Numbers, normal: Numbers) -> np.ndarray:
    """The reflection in the plane through a point with a normal."""
    return scale_matrix(-1.0, point, normal)


def rotation_matrix(angle: float, direction: Numbers, point: Numbers | None = None) -> np.ndarray:
    """The rotation by an angle [rad] about the axis through a point in a direction."""
    matrix = quaternion_matrix(quaternion_about_axis(angle, np.asarray(direction, dtype=float)[:3]))
    if point is not None:
        fixed = np.asarray(point, dtype=float)[:3]
        matrix[:3, 3] = fixed - matrix[:3, :3] @ fixed
    return matrix


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> np.ndarray:
    """The rotation matrix of Euler angles [rad] about the given axes."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: Numbers, axes: str = "sxyz") -> tuple[float, float, float]:
    """The Euler angles [rad] of a rotation matrix about the given axes.

    In gimbal lock, where the first and the third axis coincide, the third angle is 0 for fixed axes, and the
    first for rotating ones.
    """
    static, (i, j, k) = _parsed(axes)
    turned = np.asarray(matrix, dtype=float)[:3, :3]
    if not static:
        # Rotations about the body's axes equal rotations about fixed axes in the opposite order.
        i, k = k, i
    # The frame with axes i, j and the third; `sign` is -1 where this frame is left-handed.
    third = 3 - i - j
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    if i == k:
        tilt = sqrt(turned[i, j] ** 2 + turned[i, third] ** 2)
        second = atan2(tilt, turned[i, i])
        if tilt > _SMALL:
            first = atan2(turned[i, j], sign * turned[i, third])
            last = atan2(turned[j, i], -sign * turned[third, i])
        else:
            first, last = atan2(-sign * turned[j, third], turned[j, j]), 0.0
    else:
        tilt = sqrt(turned[i, i] ** 2 + turned[j, i] ** 2)
        second = atan2(-sign * turned[third, i], tilt)
        if tilt > _SMALL:
            first = atan2(sign * turned[third, j], turned[third, third])
            last = atan2(sign * turned[j, i], turned[i, i])
        else:
            first, last = atan2(-sign * turned[j, third], turned[j, j]), 0.0
    return (first, second, last) if static else (last, second, first)


def euler_from_quaternion(quaternion: Numbers, axes: str = "sxyz") -> tuple[float, float, float]:
    """The Euler angles [rad] of a quaternion about the given axes."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> np.ndarray:
    """The quaternion of Euler angles [rad] about the given axes."""
    static, order = _parsed(axes)
    result = np.array([0.0, 0.0, 0.0, 1.0])
    for angle, axis in zip((ai, aj, ak), order, strict=True):
        turn = np.zeros(4)
        turn[axis], turn[3] = sin(angle / 2.0), cos(angle / 2.0)
        result = quaternion_multiply(turn, result) if static else quaternion_multiply(result, turn)
    return result


def quaternion_about_axis(angle: float, axis: Numbers) -> np.ndarray:
    """The quaternion of a rotation by an angle [rad] about an axis of any length.

    The vector part of the result is zero for an axis of zero length.
    """
    direction = np.asarray(axis, dtype=float)[:3]
    length = float(np.linalg.norm(direction))
    scale = sin(angle / 2.0) / length if length > _SMALL else 0.0
    return np.array([*(scale * direction), cos(angle / 2.0)])


def quaternion_matrix(quaternion: Numbers) -> np.ndarray:
    """The rotation matrix of a quaternion; the identity for a quaternion of zero length."""
    q = np.array(quaternion[:4], dtype=float)
    square = float(q @ q)
    matrix = np.identity(4)
    if square < _SMALL:
        return matrix
    vector, w = q[:3], q[3]
    cross = np.cross(vector, np.identity(3), axisb=0, axisc=0)
    matrix[:3, :3] += (2.0 / square) * (w * cross + cross @ cross)
    return matrix


def quaternion_from_matrix(matrix: Numbers) -> np.ndarray:
    """The quaternion of the rotation in a transform."""
    m = np.asarray(matrix, dtype=float)[:3, :3]
    trace = float(np.trace(m))
    # Dividing by the largest of the four components is the most accurate.
    largest = int(np.argmax([m[0, 0], m[1, 1], m[2, 2], trace]))
    q = np.empty(4)
    if largest == 3:
        q[:] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1.0 + trace
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        q[i] = 1.0 + 2.0 * m[i, i] - trace
        q[j] = m[i, j] + m[j, i]
        q[k] = m[i, k] + m[k, i]
        q[3] = m[k, j] - m[j, k]
    return q / np.linalg.norm(q)


def quaternion_multiply(quaternion1: Numbers, quaternion0: Numbers) -> np.ndarray:
    """The product of two quaternions: the rotation `quaternion0` followed by `quaternion1`."""
    x0, y0, z0, w0 = quaternion0
    x1, y1, z1, w1 = quaternion1
    return np.array(
        [
            w1 * x0 + x1 * w0 + y1 * z0 - z1 * y0,
            w1 * y0 + y1 * w0 + z1 * x0 - x1 * z0,
            w1 * z0 + z1 * w0 + x1 * y0 - y1 * x0,
            w1 * w0 - x1 * x0 - y1 * y0 - z1 * z0,
        ]
    )


def quaternion_conjugate(quaternion: Numbers) -> np.ndarray:
    """The conjugate of a quaternion."""
    x, y, z, w = quaternion
    return np.array([-x, -y, -z, w], dtype=float)


def quaternion_inverse(quaternion: Numbers) -> np.ndarray:
    """The inverse of a quaternion of any length but zero."""
    return quaternion_conjugate(quaternion) / float(np.dot(quaternion, quaternion))


def quaternion_slerp(
    quat0: Numbers, quat1: Numbers, fraction: float, spin: int = 0, shortestpath: bool = True
) -> np.ndarray:
    """Spherical linear interpolation (slerp) between two quaternions.

    Args:
        quat0: Rotation for fraction 0.
        quat1: Rotation for fraction 1.
        fraction: Fraction of the way from `quat0` to `quat1`.
        spin: Number of additional half turns.
        shortestpath: Whether to rotate in the opposite direction where that is shorter.
    """
    start, end = unit_vector(quat0[:4]), unit_vector(quat1[:4])
    if fraction == 0.0:
        return start
    if fraction == 1.0:
        return end
    along = float(start @ end)
    if abs(abs(along) - 1.0) < _SMALL:
        return start
    if shortestpath and along < 0.0:
        along, end = -along, -end
    angle = acos(along) + spin * pi
    if abs(angle) < _SMALL:
        return start
    return (sin((1.0 - fraction) * angle) * start + sin(fraction * angle) * end) / sin(angle)


def random_quaternion(rand: Numbers | None = None) -> np.ndarray:
    """A random rotation with uniform distribution.

    Args:
        rand: Three numbers from 0 to 1 that are used instead of random numbers.
    """
    share, first, second = np.random.random(3) if rand is None else rand
    low, high = sqrt(1.0 - share), sqrt(share)
    return np.array(
        [
            low * sin(2.0 * pi * first),
            low * cos(2.0 * pi * first),
            high * sin(2.0 * pi * second),
            high * cos(2.0 * pi * second),
        ]
    )


def random_rotation_matrix(rand: Numbers | None = None) -> np.ndarray:
    """The rotation matrix of a `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))


def vector_norm(data: Numbers, axis: int | None = None) -> np.ndarray:
    """Length of a vector, or of the vectors along an axis of an array."""
    return np.sqrt(np.sum(np.square(np.asarray(data, dtype=float)), axis=axis))


def unit_vector(data: Numbers, axis: int | None = None) -> np.ndarray:
    """A vector, or the vectors along an axis of an array, scaled to length 1."""
    values = np.array(data, dtype=float)
    return values / np.sqrt(np.sum(np.square(values), axis=axis, keepdims=axis is not None))


def random_vector(size: int) -> np.ndarray:
    """`size` random numbers from 0 to 1."""
    return np.random.random(size)


def inverse_matrix(matrix: Numbers) -> np.ndarray:
    """The inverse of a transform."""
    return np.linalg.inv(np.asarray(matrix, dtype=float))


def concatenate_matrices(*matrices: Numbers) -> np.ndarray:
    """The product of transforms; the last one is applied first."""
    result = np.identity(4)
    for matrix in matrices:
        result = result @ np.asarray(matrix, dtype=float)
    return result


def is_same_transform(matrix0: Numbers, matrix1: Numbers) -> bool:
    """Whether two transforms are equal up to their scale in homogeneous coordinates."""
    first, second = (np.array(matrix, dtype=float) for matrix in (matrix0, matrix1))
    return bool(np.allclose(first / first[3, 3], second / second[3, 3]))


def rotation_from_matrix(matrix: Numbers) -> tuple[float, np.ndarray, np.ndarray]:
    """Angle [rad], direction and a point (homogeneous, 4 components) of the axis of a rotation.

    Raises:
        ValueError: The 3 by 3 part of the transform is not a rotation matrix.
    """
    full = np.asarray(matrix, dtype=float)
    turned = full[:3, :3]
    if not np.allclose(turned @ turned.T, np.identity(3)) or np.linalg.det(turned) < 0.0:
        raise ValueError("the transform is not a rotation")
    q = quaternion_from_matrix(full)
    length = float(np.linalg.norm(q[:3]))
    direction = q[:3] / length if length > _SMALL else np.array([0.0, 0.0, 1.0])
    angle = 2.0 * atan2(length, q[3])
    if angle > pi:
        angle -= 2.0 * pi
    point = np.linalg.pinv(np.identity(3) - turned) @ full[:3, 3]
    return angle, direction, np.array([*point, 1.0])


def compose_matrix(
    scale: Numbers | None = None,
    shear: Numbers | None = None,
    angles: Numbers | None = None,
    translate: Numbers | None = None,
    perspective: Numbers | None = None,
) -> np.ndarray:
    """Scaling, shear (xy, xz, yz), rotation (`sxyz`), translation and perspective, applied in this order."""
    matrix = np.identity(4)
    if perspective is not None:
        matrix[3, :] = np.asarray(perspective, dtype=float)[:4]
    if translate is not None:
        matrix = matrix @ translation_matrix(translate)
    if angles is not None:
        matrix = matrix @ euler_matrix(angles[0], angles[1], angles[2])
    if shear is not None:
        slant = np.identity(4)
        slant[0, 1], slant[0, 2], slant[1, 2] = shear[0], shear[1], shear[2]
        matrix = matrix @ slant
    if scale is not None:
        matrix = matrix @ np.diag([scale[0], scale[1], scale[2], 1.0])
    return matrix / matrix[3, 3]


def decompose_matrix(
    matrix: Numbers,
) -> tuple[np.ndarray, list[float], list[float], np.ndarray, np.ndarray]:
    """Scale, shear, angles, translation and perspective of a transform: the inverse of `compose_matrix`.

    Raises:
        ValueError: The transform is singular.
    """
    full = np.array(matrix, dtype=float)
    if abs(full[3, 3]) < _SMALL:
        raise ValueError("the transform maps the origin to infinity")
    full /= full[3, 3]
    bottom = full[3].copy()
    affine = full.copy()
    affine[3] = 0.0, 0.0, 0.0, 1.0
    if abs(float(np.linalg.det(affine))) < _SMALL:
        raise ValueError("the transform is singular")
    # QR decomposition, with a positive diagonal of the upper triangular matrix.
    turned, triangle = np.linalg.qr(affine[:3, :3])
    signs = np.sign(np.diag(triangle))
    turned, triangle = turned * signs, triangle * signs[:, None]
    scale = np.diag(triangle).copy()
    if np.linalg.det(turned) < 0.0:
        turned, scale, triangle = -turned, -scale, -triangle
    shear = [triangle[0, 1] / scale[1], triangle[0, 2] / scale[2], triangle[1, 2] / scale[2]]
    perspective = bottom @ np.linalg.inv(affine)
    return scale, shear, list(euler_from_matrix(turned)), affine[:3, 3].copy(), perspective


def _parsed(axes: str) -> tuple[bool, tuple[int, int, int]]:
    """Whether Euler angles are about fixed axes, and the indices of the three axes."""
    if len(axes) == 4 and axes[0] in "sr" and all(axis in _AXES for axis in axes[1:]):
        first, second, third = (_AXES.index(axis) for axis in axes[1:])
        if first != second != third:
            return axes[0] == "s", (first, second, third)
    raise ValueError(f"axes must be like 'sxyz' or 'rzyx', not {axes!r}")


__getattr__ = absent_names(
    __name__,
    """reflection_from_matrix scale_from_matrix projection_matrix projection_from_matrix clip_matrix
    shear_matrix shear_from_matrix orthogonalization_matrix superimposition_matrix Arcball
    arcball_map_to_sphere arcball_constrain_to_axis arcball_nearest_axis""",
    "scripts for PyBullet do not use it; C. Gohlke's package `transformations` has it",
)
