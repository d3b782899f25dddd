"""What the drive of a joint is told, written into the motor rows of a world.

The functions work on `dofs`, a slice of the world's velocity coordinates: those of one joint or of
a whole body. Forces are in N m for revolute joints and in N for prismatic ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import finite, not_negative
from carom.model.codes import (
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

if TYPE_CHECKING:
    from carom.world import World


def aim_at_position(
    world: World,
    dofs: slice,
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
        MOTOR_MAX_IMPULSE: _impulse(world, max_force),
        MOTOR_VELOCITY_CLAMP: not_negative(max_velocity, "max_velocity"),
    }
    _write(world.motor[dofs], columns)


def aim_at_velocity(
    world: World, dofs: slice, velocity: ArrayLike, gain: ArrayLike, max_force: ArrayLike
) -> None:
    """Keep a velocity: take away the share `gain` of the velocity error in every substep."""
    aim_at_position(world, dofs, 0.0, velocity, 0.0, gain, max_force, np.inf)


def aim_at_orientation(
    world: World,
    dofs: slice,
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
        MOTOR_MAX_IMPULSE: _impulse(world, max_force),
        MOTOR_DAMPING: finite(damping, "damping"),
    }
    _write(world.motor[dofs], columns)
    world.motor[dofs.start, MOTOR_TARGET_W] = w


def pull_like_a_spring(
    world: World,
    dofs: slice,
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
    _write(world.pd[dofs], columns)


def switch_off(world: World, dofs: slice) -> None:
    """Let go: neither the motor nor a spring acts."""
    world.motor[dofs, MOTOR_MAX_IMPULSE] = 0.0
    world.pd[dofs, PD_MAX_FORCE] = 0.0


def _impulse(world: World, max_force: ArrayLike) -> np.ndarray:
    return not_negative(max_force, "max_force") * world.parameters.substep_time


def _write(rows: np.ndarray, columns: dict[int, np.ndarray]) -> None:
    """Write columns only after all of them fit the rows, so that an error changes nothing."""
    fitting = {column: np.broadcast_to(values, len(rows)) for column, values in columns.items()}
    for column, values in fitting.items():
        rows[:, column] = values
