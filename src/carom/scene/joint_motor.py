"""What the drive of a joint is told, written into the motor rows of one world or of many.

The functions work on `motor` or `pd` of a world, shape (dofs, 8), or of many worlds at once,
(worlds, dofs, 8), and there on `dofs`: a slice of the velocity coordinates, or their numbers. What is given
is for all of these, or one number for each, or one for each world and each of these. Forces are in N m for
revolute joints and in N for prismatic ones; a motor's bound is an impulse, the maximum force times
`substep_time` [s].
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import finite, not_negative
from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_TARGET_W,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
    PD_KD,
    PD_KP,
    PD_MAX_FORCE,
    PD_POSITION,
    PD_VELOCITY,
)

Dofs = slice | np.ndarray


def aim_at_position(
    motor: np.ndarray,
    dofs: Dofs,
    substep_time: float,
    position: ArrayLike,
    velocity: ArrayLike,
    gain: ArrayLike,
    velocity_gain: ArrayLike,
    max_force: ArrayLike,
    max_velocity: ArrayLike,
) -> None:
    """Move towards a position: take away the share `gain` of the position error in every substep."""
    columns = {
        MOTOR_POSITION: finite(position, "target"),
        MOTOR_VELOCITY: finite(velocity, "velocity"),
        MOTOR_KP: finite(gain, "gain"),
        MOTOR_KD: finite(velocity_gain, "velocity_gain"),
        MOTOR_MAX_IMPULSE: _impulse(max_force, substep_time),
        MOTOR_VELOCITY_CLAMP: not_negative(max_velocity, "max_velocity"),
    }
    _write(motor, dofs, columns)


def aim_at_velocity(
    motor: np.ndarray,
    dofs: Dofs,
    substep_time: float,
    velocity: ArrayLike,
    gain: ArrayLike,
    max_force: ArrayLike,
) -> None:
    """Keep a velocity: take away the share `gain` of the velocity error in every substep."""
    aim_at_position(motor, dofs, substep_time, 0.0, velocity, 0.0, gain, max_force, np.inf)


def aim_at_orientation(
    motor: np.ndarray,
    dofs: slice,
    substep_time: float,
    orientation: ArrayLike,
    gain: ArrayLike,
    damping: ArrayLike,
    max_force: ArrayLike,
) -> None:
    """Turn a spherical joint towards an orientation, a unit quaternion (x, y, z, w)."""
    x, y, z, w = finite(orientation, "orientation")
    columns = {
        MOTOR_POSITION: np.array([x, y, z]),
        MOTOR_KP: finite(gain, "gain"),
        MOTOR_MAX_IMPULSE: _impulse(max_force, substep_time),
        MOTOR_DAMPING: finite(damping, "damping"),
    }
    _write(motor, dofs, columns)
    motor[dofs.start, MOTOR_TARGET_W] = w


def pull_like_a_spring(
    pd: np.ndarray,
    dofs: Dofs,
    position: ArrayLike,
    velocity: ArrayLike,
    stiffness: ArrayLike,
    damping: ArrayLike,
    max_force: ArrayLike,
) -> None:
    """Push with stiffness · (position error) + damping · (velocity error), at most `max_force`."""
    columns = {
        PD_POSITION: finite(position, "target"),
        PD_VELOCITY: finite(velocity, "velocity"),
        PD_KP: finite(stiffness, "stiffness"),
        PD_KD: finite(damping, "damping"),
        PD_MAX_FORCE: not_negative(max_force, "max_force"),
    }
    _write(pd, dofs, columns)


def switch_off(motor: np.ndarray, pd: np.ndarray, dofs: Dofs) -> None:
    """Let go: neither the motor nor a spring acts."""
    motor[..., dofs, MOTOR_MAX_IMPULSE] = 0.0
    pd[..., dofs, PD_MAX_FORCE] = 0.0


def _impulse(max_force: ArrayLike, substep_time: float) -> np.ndarray:
    return not_negative(max_force, "max_force") * substep_time


def _write(rows: np.ndarray, dofs: Dofs, columns: Mapping[int, np.ndarray]) -> None:
    """Write columns only after all of them fit the rows, so that an error changes nothing."""
    shape = rows[..., dofs, 0].shape
    fitting = {column: np.broadcast_to(values, shape) for column, values in columns.items()}
    for column, values in fitting.items():
        rows[..., dofs, column] = values
