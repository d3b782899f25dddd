"""Rigid transforms on plain tuples, for readers and `assemble`: faster than small NumPy arrays."""

from __future__ import annotations

from math import pi, sqrt

from carom.description.pose import IDENTITY, Pose, Quaternion, Vector3
from carom.native.trigonometry import asin, atan2, cos, sin

Matrix3 = tuple[Vector3, Vector3, Vector3]
"""Row-major rotation matrix."""

_GIMBAL_LOCK = 0.99999

NO_ROTATION: Matrix3 = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def rotation_matrix(quaternion: Quaternion) -> Matrix3:
    """Rotation matrix of a quaternion (x, y, z, w), which need not be of unit length."""
    x, y, z, w = quaternion
    s = 2.0 / (x * x + y * y + z * z + w * w)
    xs, ys, zs = x * s, y * s, z * s
    wx, wy, wz = w * xs, w * ys, w * zs
    xx, xy, xz = x * xs, x * ys, x * zs
    yy, yz, zz = y * ys, y * zs, z * zs
    return (
        (1.0 - (yy + zz), xy - wz, xz + wy),
        (xy + wz, 1.0 - (xx + zz), yz - wx),
        (xz - wy, yz + wx, 1.0 - (xx + yy)),
    )


def quaternion_from_matrix(m: Matrix3) -> Quaternion:
    """Unit quaternion of a rotation matrix, with a defined sign.

    w is positive if the trace is; otherwise that of x, y and z with the largest magnitude is positive.
    """
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0.0:
        s = sqrt(trace + 1.0)
        h = 0.5 / s
        return ((m[2][1] - m[1][2]) * h, (m[0][2] - m[2][0]) * h, (m[1][0] - m[0][1]) * h, 0.5 * s)
    i = 2 if m[2][2] > max(m[0][0], m[1][1]) else 1 if m[1][1] > m[0][0] else 0
    j, k = (i + 1) % 3, (i + 2) % 3
    s = sqrt(max(m[i][i] - m[j][j] - m[k][k] + 1.0, 0.0))
    h = 0.5 / s
    vector = [0.0, 0.0, 0.0]
    vector[i] = 0.5 * s
    vector[j] = (m[j][i] + m[i][j]) * h
    vector[k] = (m[k][i] + m[i][k]) * h
    return (vector[0], vector[1], vector[2], (m[k][j] - m[j][k]) * h)


def turns_about_axes(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Product of rotations [rad] about the fixed axes x, y, z in this order; of unit length."""
    sr, cr = sin(roll / 2.0), cos(roll / 2.0)
    sp, cp = sin(pitch / 2.0), cos(pitch / 2.0)
    sy, cy = sin(yaw / 2.0), cos(yaw / 2.0)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def quaternion_from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Unit quaternion of roll, pitch and yaw [rad] about the fixed axes x, y and z, with a defined sign.

    The sign rule is that of `quaternion_from_matrix`.
    """
    x, y, z, w = turns_about_axes(roll, pitch, yaw)
    # Only the sign may change here: conversion to a matrix and back would change the last digits, and two
    # equal frames of a file would no longer compare as equal.
    unit = 1.0 / sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x * unit, y * unit, z * unit, w * unit
    has_positive_trace = w * w > 0.25  # the trace of the matrix is 4 w² - 1
    is_flipped = (w if has_positive_trace else max((x, y, z), key=abs)) < 0.0
    return (-x, -y, -z, -w) if is_flipped else (x, y, z, w)


def rpy_from_quaternion(quaternion: Quaternion) -> Vector3:
    """Roll, pitch and yaw [rad] about the fixed axes x, y and z, as Bullet takes them.

    The quaternion has unit length. In gimbal lock (a sine of the pitch of ±0.99999 or beyond) roll is 0.
    """
    x, y, z, w = quaternion
    sine = -2.0 * (x * z - w * y)
    if sine <= -_GIMBAL_LOCK:
        return (0.0, -0.5 * pi, 2.0 * atan2(x, -y))
    if sine >= _GIMBAL_LOCK:
        return (0.0, 0.5 * pi, 2.0 * atan2(-x, y))
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    roll = atan2(2.0 * (y * z + w * x), ww - xx - yy + zz)
    return (roll, asin(sine), atan2(2.0 * (x * y + w * z), ww + xx - yy - zz))


def transposed(m: Matrix3) -> Matrix3:
    """The transpose, which is the inverse of a rotation matrix."""
    return (
        (m[0][0], m[1][0], m[2][0]),
        (m[0][1], m[1][1], m[2][1]),
        (m[0][2], m[1][2], m[2][2]),
    )


def matrix_product(a: Matrix3, b: Matrix3) -> Matrix3:
    """Product of two 3x3 matrices."""
    # Written out: twelve calls take three times as long.
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = a
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = b
    return (
        (ax * xx + ay * yx + az * zx, ax * xy + ay * yy + az * zy, ax * xz + ay * yz + az * zz),
        (bx * xx + by * yx + bz * zx, bx * xy + by * yy + bz * zy, bx * xz + by * yz + bz * zz),
        (cx * xx + cy * yx + cz * zx, cx * xy + cy * yy + cz * zy, cx * xz + cy * yz + cz * zz),
    )


def matrix_vector(m: Matrix3, v: Vector3) -> Vector3:
    """Product of a 3x3 matrix and a vector."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = m
    x, y, z = v
    return (ax * x + ay * y + az * z, bx * x + by * y + bz * z, cx * x + cy * y + cz * z)


def dot(a: Vector3, b: Vector3) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def subtracted(a: Vector3, b: Vector3) -> Vector3:
    """Difference a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def rotate(quaternion: Quaternion, v: Vector3) -> Vector3:
    """Rotates a vector by a quaternion."""
    return matrix_vector(rotation_matrix(quaternion), v)


def multiplied(a: Quaternion, b: Quaternion) -> Quaternion:
    """Hamilton product: the rotation `b` followed by `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def conjugate(q: Quaternion) -> Quaternion:
    """Inverse of a unit quaternion."""
    return (-q[0], -q[1], -q[2], q[3])


def compose(a: Pose, b: Pose) -> Pose:
    """Product a · b: the pose of a frame in the parent of `a`, from its pose `b` in the frame `a`."""
    if a is IDENTITY:
        return b
    m = rotation_matrix(a.orientation)
    x, y, z = matrix_vector(m, b.position)
    px, py, pz = a.position
    turned = matrix_product(m, rotation_matrix(b.orientation))
    return Pose((x + px, y + py, z + pz), quaternion_from_matrix(turned))


def inverse(pose: Pose) -> Pose:
    """The inverse transform: the pose of the parent frame in the frame `pose`."""
    q = conjugate(pose.orientation)
    x, y, z = rotate(q, pose.position)
    return Pose((-x, -y, -z), q)


def turn_of_z(axis: Vector3) -> Quaternion:
    """The shortest rotation of the z axis to another unit vector."""
    x, y, z = axis
    if z < -1.0 + 1e-15:
        return (1.0, 0.0, 0.0, 0.0)
    s = sqrt(2.0 * (1.0 + z))
    return (-y / s, x / s, 0.0, 0.5 * s)
