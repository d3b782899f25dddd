"""Quaternions, in the order (x, y, z, w), and rotation matrices."""

import math

import warp as wp

from carom.kernels.maths.min_max import maximum
from carom.kernels.types import Int32, Matrix3, Quaternion, Vector3, func, real

# Bound on the rotation in one step [rad], as in Bullet.
MAX_ANGLE_PER_STEP = real(0.25 * math.pi)
_SMALL_RATE = real(0.001)


@func
def column(matrix: Matrix3, i: Int32) -> Vector3:
    """Column `i` of a matrix."""
    return Vector3(matrix[0, i], matrix[1, i], matrix[2, i])


@func
def axis_rotation(axis: Vector3, angle: real) -> Quaternion:
    """Rotation by `angle` about the unit vector `axis`."""
    half = angle * 0.5
    s = wp.sin(half)
    return Quaternion(axis[0] * s, axis[1] * s, axis[2] * s, wp.cos(half))


@func
def rotation_matrix(q: Quaternion) -> Matrix3:
    """Rotation matrix of the unit quaternion `q`."""
    xs, ys, zs = q[0] + q[0], q[1] + q[1], q[2] + q[2]
    wx, wy, wz = q[3] * xs, q[3] * ys, q[3] * zs
    xx, xy, xz = q[0] * xs, q[0] * ys, q[0] * zs
    yy, yz, zz = q[1] * ys, q[1] * zs, q[2] * zs
    return Matrix3(
        1.0 - (yy + zz), xy - wz, xz + wy,
        xy + wz, 1.0 - (xx + zz), yz - wx,
        xz - wy, yz + wx, 1.0 - (xx + yy),
    )  # fmt: skip


@func
def canonical(q: Quaternion) -> Quaternion:
    """Return `q` or `-q`, the same rotation: the one that conversion from the rotation matrix gives."""
    lead = q[3]
    if q[3] * q[3] <= 0.25:
        lead = q[0]
        if wp.abs(q[1]) > wp.abs(lead):
            lead = q[1]
        if wp.abs(q[2]) > wp.abs(lead):
            lead = q[2]
    return Quaternion(-q[0], -q[1], -q[2], -q[3]) if lead < 0.0 else q


@func
def rotation_step(rate: Vector3, dt: real) -> Quaternion:
    """Rotation during the time `dt` at the angular velocity `rate`, by the exponential map.

    If the angle exceeds Bullet's bound per step, the rotation is smaller than the angle, and the quaternion
    is not of unit length.
    """
    speed = wp.length(rate)
    if speed * dt > MAX_ANGLE_PER_STEP:
        speed = MAX_ANGLE_PER_STEP / dt
    scale = wp.sin(0.5 * speed * dt) / maximum(speed, _SMALL_RATE)
    if speed < _SMALL_RATE:
        # Taylor series of sin(speed dt / 2) / speed.
        scale = 0.5 * dt - dt * dt * dt * 0.020833333333 * speed * speed
    return Quaternion(rate[0] * scale, rate[1] * scale, rate[2] * scale, wp.cos(0.5 * speed * dt))


@func
def rotation_vector(turn: Quaternion) -> Vector3:
    """The axis of a rotation times its angle, which is at most π."""
    axis = Vector3(turn[0], turn[1], turn[2])
    cosine = turn[3]
    if cosine < 0.0:
        axis = -axis
        cosine = -cosine
    sine = wp.length(axis)
    return 2.0 * axis if sine < 1.0e-12 else axis * (2.0 * wp.atan2(sine, cosine) / sine)


@func
def quaternion_of(m: Matrix3) -> Quaternion:
    """Unit quaternion of a rotation matrix, with the sign that `canonical` gives."""
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > 0.0:
        s = wp.sqrt(trace + 1.0)
        h = 0.5 / s
        return Quaternion((m[2, 1] - m[1, 2]) * h, (m[0, 2] - m[2, 0]) * h, (m[1, 0] - m[0, 1]) * h, 0.5 * s)
    i = Int32(0)
    if m[1, 1] > m[0, 0]:
        i = 1
    if m[2, 2] > maximum(m[0, 0], m[1, 1]):
        i = 2
    j, k = (i + 1) % 3, (i + 2) % 3
    s = wp.sqrt(maximum(m[i, i] - m[j, j] - m[k, k] + 1.0, real(0.0)))
    h = 0.5 / s
    v = Vector3(0.0, 0.0, 0.0)
    v[i] = 0.5 * s
    v[j] = (m[j, i] + m[i, j]) * h
    v[k] = (m[k, i] + m[i, k]) * h
    return Quaternion(v[0], v[1], v[2], (m[k, j] - m[j, k]) * h)
