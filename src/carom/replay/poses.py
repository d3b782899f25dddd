"""Poses in rows: position and quaternion (x, y, z, w), of any number of frames at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.description import Pose

Floats = NDArray[np.float64]


def composed(poses: Floats, inner: Pose) -> Floats:
    """(n, 7) the pose `inner` in each of the frames at (n, 7) poses."""
    position, orientation = poses[:, :3], poses[:, 3:]
    vector, w = orientation[:, :3], orientation[:, 3:]
    offset = np.array(inner.position)
    across = 2.0 * np.cross(vector, offset)
    moved = position + offset + w * across + np.cross(vector, across)
    turn, scalar = np.array(inner.orientation[:3]), inner.orientation[3]
    turned = w * turn + scalar * vector + np.cross(vector, turn)
    rest = w * scalar - (vector @ turn)[:, None]
    return np.hstack((moved, turned, rest))


def continuous(quaternions: Floats) -> Floats:
    """(n, 4) the same orientations, each with the sign that is nearer to the one before it."""
    flips = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0.0
    signs = np.concatenate(([1.0], np.where(np.cumsum(flips) % 2, -1.0, 1.0)))[: len(quaternions)]
    return quaternions * signs[:, None]
