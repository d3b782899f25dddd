"""Quaternions: normalisation, and rotation of vectors."""

from __future__ import annotations

from math import sqrt

from carom.description.pose import Quaternion, Vector3


def unit(quaternion: Quaternion) -> Quaternion:
    """A quaternion normalised to length 1."""
    x, y, z, w = quaternion
    length = sqrt(x * x + y * y + z * z + w * w)
    return (x / length, y / length, z / length, w / length)


def turned(quaternion: Quaternion, v: Vector3) -> Vector3:
    """A vector rotated by a quaternion of unit length."""
    qx, qy, qz, qw = quaternion
    x, y, z = v
    tx = 2.0 * (qy * z - qz * y)
    ty = 2.0 * (qz * x - qx * z)
    tz = 2.0 * (qx * y - qy * x)
    return (
        x + qw * tx + qy * tz - qz * ty,
        y + qw * ty + qz * tx - qx * tz,
        z + qw * tz + qx * ty - qy * tx,
    )
