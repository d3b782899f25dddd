"""How a free base moves, from poses of its link frame that were measured."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.checks import Array
from carom.description.pose import Pose
from carom.identification.butterworth import zero_phase
from carom.linearization.turns import inverse, matrix_of, multiplied, vector_of


class BaseMotion(NamedTuple):
    """Motion of the inertial frame of a free base as steps relate it.

    Attributes:
        poses: Position [m] and quaternion (x, y, z, w) in world axes, (N, 7).
        velocities: Angular and linear velocity before the step, in the frame's own axes, (N, 6).
        accelerations: Mean derivatives of both as vectors in the step, likewise.
    """

    poses: Array
    velocities: Array
    accelerations: Array


def without_jumps(orientations: Array) -> Array:
    """Unit quaternions (N, 4) of which none has the opposite sign of the one before."""
    unit = orientations / np.linalg.norm(orientations, axis=1, keepdims=True)
    flips = np.sign((unit[1:] * unit[:-1]).sum(axis=1))
    signs = np.concatenate([[1.0], np.cumprod(np.where(flips == 0.0, 1.0, flips))])
    return np.asarray(unit * signs[:, None], dtype=float)


def parabolas(positions: Array) -> Array:
    """The parabolas that fit positions (N, 3) best, (N, 3)."""
    powers = np.vander(np.linspace(-1.0, 1.0, len(positions)), 3)
    return np.asarray(powers @ np.linalg.lstsq(powers, positions, rcond=None)[0], dtype=float)


def inertial_poses(positions: Array, orientations: Array, frame: Pose) -> Array:
    """Poses (N, 7) of a frame that is fixed to the link frames at positions (N, 3), quaternions (N, 4)."""
    turns = matrix_of(orientations)
    turned = multiplied(orientations, np.broadcast_to(np.array(frame.orientation), orientations.shape))
    return np.concatenate([positions + turns @ np.array(frame.position), turned], axis=1)


def base_motion(
    positions: Array, orientations: Array, frame: Pose, time_step: float, cutoff: float
) -> BaseMotion:
    """The motion of the inertial frame of a base, by a filter and differences.

    As of joints, the velocity at a row is the difference from the row before, the acceleration the second
    difference; the first and the last row have those of their neighbours.

    Args:
        positions: Of the link frame [m], world axes, (N, 3).
        orientations: Its quaternions (x, y, z, w), `without_jumps`, (N, 4).
        frame: The inertial frame in the link frame.
        time_step: [s].
        cutoff: That of the filter [Hz], which quaternions pass as well.

    Raises:
        ValueError: There is no such filter, or there are too few rows.
    """
    # A filter passes parabolas, but not their ends: without this, fall would begin and end abruptly.
    fall = parabolas(positions)
    place = zero_phase(positions - fall, cutoff, time_step) + fall
    turn = zero_phase(orientations, cutoff, time_step)
    poses = inertial_poses(place, turn / np.linalg.norm(turn, axis=1, keepdims=True), frame)
    quaternions = poses[:, 3:]
    rates = np.empty((len(poses), 6))
    rates[1:, :3] = vector_of(multiplied(quaternions[1:], inverse(quaternions[:-1]))) / time_step
    rates[1:, 3:] = np.diff(poses[:, :3], axis=0) / time_step
    rates[0] = rates[1]
    changes = np.empty_like(rates)
    changes[1:-1] = np.diff(rates[1:], axis=0) / time_step
    changes[0], changes[-1] = changes[1], changes[-2]
    back = np.swapaxes(matrix_of(quaternions), 1, 2)
    return BaseMotion(poses, *(_turned(back, it) for it in (rates, changes)))


def _turned(turns: Array, pairs: Array) -> Array:
    """Pairs of vectors (N, 6), both turned by matrices (N, 3, 3)."""
    return np.einsum("nij,nkj->nki", turns, pairs.reshape(-1, 2, 3)).reshape(-1, 6)
