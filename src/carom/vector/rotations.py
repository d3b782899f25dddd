"""Rotations of many links at once."""

from __future__ import annotations

import numpy as np

from carom.checks import Array

# Gimbal lock, where roll and yaw cannot be distinguished, as in `carom.description.transform`.
_GIMBAL_LOCK = 0.99999


def euler_from_quaternions(quaternions: Array) -> Array:
    """Roll, pitch and yaw [rad], as by `pybullet.getEulerFromQuaternion`.

    Args:
        quaternions: (n, 4), x, y, z, w, of unit length.

    Returns:
        (n, 3) roll, pitch and yaw.
    """
    x, y, z, w = quaternions.T
    sine = -2.0 * (x * z - w * y)
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    angles = np.empty((len(quaternions), 3))
    angles[:, 0] = np.arctan2(2.0 * (y * z + w * x), ww - xx - yy + zz)
    angles[:, 1] = np.arcsin(np.clip(sine, -1.0, 1.0))
    angles[:, 2] = np.arctan2(2.0 * (x * y + w * z), ww + xx - yy - zz)
    locked = np.flatnonzero(np.abs(sine) >= _GIMBAL_LOCK)
    if len(locked):
        side = np.sign(sine[locked])
        angles[locked, 0] = 0.0
        angles[locked, 1] = 0.5 * np.pi * side
        angles[locked, 2] = 2.0 * np.arctan2(-side * x[locked], side * y[locked])
    return angles


def turned(quaternions: Array, vectors: Array) -> Array:
    """Vectors (n, 3) rotated by quaternions (n, 4) of unit length."""
    axis, w = quaternions[:, :3], quaternions[:, 3:]
    twice = 2.0 * np.cross(axis, vectors)
    return vectors + w * twice + np.cross(axis, twice)
