"""Motor commands: POSITION_CONTROL, VELOCITY_CONTROL, TORQUE_CONTROL and PD_CONTROL.

Targets, gains, maximum forces and maximum velocities become columns of `motor` and `pd`, shape (dofs, 8);
`kernels/dynamics/motors.py` converts these to constraint rows and torques. Forces are in N m for revolute
joints and in N for prismatic ones; the bound of a motor is an impulse, the maximum force times the time step.

`Drives` writes many rows. Arguments of its methods are one number for all of these, one for each dof, or one
for each world and dof. The other classes write the row of one joint, for loops that set motors one by one.
The kernel in `kernels/dynamics/motor_commands.py` does the same as `AxisMotor` for a list of joints.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from struct import Struct
from typing import TYPE_CHECKING, NamedTuple, Protocol

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
from carom.layouts.magnitudes import MIN_PD_FORCE
from carom.layouts.motor_commands import MODES, PD, POSITION, TORQUE, VELOCITY

if TYPE_CHECKING:
    from carom.world.world import World

_DOUBLE = 8
_COLUMNS = 8

# The first columns of a motor's row are written at once. A PD drive has the same ones; its bound is a force.
assert (MOTOR_POSITION, MOTOR_VELOCITY, MOTOR_KP, MOTOR_KD) == (0, 1, 2, 3)
assert (PD_POSITION, PD_VELOCITY, PD_KP, PD_KD) == (0, 1, 2, 3)
assert (MOTOR_MAX_IMPULSE, PD_MAX_FORCE, MOTOR_VELOCITY_CLAMP) == (4, 4, 5)
_write_target = Struct("5d").pack_into
_write_target_and_clamp = Struct("6d").pack_into


class Drives(NamedTuple):
    """Motors and PD drives of some velocity coordinates, in one world or in many.

    Attributes:
        motor: `motor` of all coordinates, (dofs, 8) or (worlds, dofs, 8).
        pd: `pd` of all coordinates, likewise.
        dofs: Which coordinates: a slice, or an array of indices.
        substep_time: Duration of a substep [s].
    """

    motor: np.ndarray
    pd: np.ndarray
    dofs: slice | np.ndarray
    substep_time: float

    def aim_at_position(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        gain: ArrayLike,
        velocity_gain: ArrayLike,
        max_force: ArrayLike,
        max_velocity: ArrayLike,
    ) -> None:
        """Position control: correct the share `gain` of the position error in every substep."""
        columns = {
            MOTOR_POSITION: finite(position, "target"),
            MOTOR_VELOCITY: finite(velocity, "velocity"),
            MOTOR_KP: finite(gain, "gain"),
            MOTOR_KD: finite(velocity_gain, "velocity_gain"),
            MOTOR_MAX_IMPULSE: not_negative(max_force, "max_force") * self.substep_time,
            MOTOR_VELOCITY_CLAMP: not_negative(max_velocity, "max_velocity"),
        }
        self._write(self.motor, columns)

    def aim_at_velocity(self, velocity: ArrayLike, gain: ArrayLike, max_force: ArrayLike) -> None:
        """Velocity control: correct the share `gain` of the velocity error in every substep."""
        self.aim_at_position(0.0, velocity, 0.0, gain, max_force, np.inf)

    def aim_at_orientation(
        self, orientation: ArrayLike, gain: ArrayLike, damping: ArrayLike, max_force: ArrayLike
    ) -> None:
        """Position control of a spherical joint: the target is a unit quaternion (x, y, z, w)."""
        x, y, z, w = finite(orientation, "orientation")
        columns = {
            MOTOR_POSITION: np.array([x, y, z]),
            MOTOR_KP: finite(gain, "gain"),
            MOTOR_MAX_IMPULSE: not_negative(max_force, "max_force") * self.substep_time,
            MOTOR_DAMPING: finite(damping, "damping"),
        }
        self._write(self.motor, columns)
        assert isinstance(self.dofs, slice)
        self.motor[self.dofs.start, MOTOR_TARGET_W] = w

    def pull_like_a_spring(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike,
        max_force: ArrayLike,
    ) -> None:
        """PD control: stiffness · (position error) + damping · (velocity error), at most `max_force`."""
        columns = {
            PD_POSITION: finite(position, "target"),
            PD_VELOCITY: finite(velocity, "velocity"),
            PD_KP: finite(stiffness, "stiffness"),
            PD_KD: finite(damping, "damping"),
            PD_MAX_FORCE: not_negative(max_force, "max_force"),
        }
        self._write(self.pd, columns)

    def switch_off(self) -> None:
        """Switch off the motors and the PD drives."""
        self.motor[..., self.dofs, MOTOR_MAX_IMPULSE] = 0.0
        self.pd[..., self.dofs, PD_MAX_FORCE] = 0.0

    def _write(self, rows: np.ndarray, columns: Mapping[int, np.ndarray]) -> None:
        """Write columns after checking that all of them fit the rows, so that an error changes nothing."""
        shape = rows[..., self.dofs, 0].shape
        fitting = {column: np.broadcast_to(values, shape) for column, values in columns.items()}
        for column, values in fitting.items():
            rows[..., self.dofs, column] = values


class Clock(Protocol):
    """An object with the time step [s]."""

    time_step: float


class JointMotor:
    """The motor of one joint of a world: the base class, for joints without a motor.

    It is valid until bodies are added or removed. The time step of the clock converts forces to impulses.

    Attributes:
        lower: Minimum target position [rad or m]; minus infinity without limits.
        upper: Maximum target position [rad or m]; infinity without limits.
    """

    __slots__ = ("_clock", "_dof", "_motors", "_pd", "_row_at", "_torques", "lower", "upper")

    def __init__(self, world: World, clock: Clock, dof: int) -> None:
        self.lower, self.upper = -inf, inf
        self._clock = clock
        self._dof = dof
        self._row_at = dof * _COLUMNS * _DOUBLE
        self._motors = world.motor_memory
        self._pd = world.pd_memory
        self._torques = world.joint_torque_memory

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        """Set the motor, the PD drive or the torque of the next step.

        Args:
            mode: A mode of `carom.layouts.motor_commands`. `POSITION` and `VELOCITY` set the motor, `PD`
                the additional PD drive; `TORQUE` adds `force` to the torques of the next step.
            position: Target [rad or m].
            velocity: Target [rad/s or m/s].
            force: Maximum force, or the torque [N m or N].
            kp: Share of the position error that a motor corrects per substep; stiffness of a PD drive.
            kd: Share of the velocity error likewise; damping of a PD drive.
            clamp: Maximum velocity of a motor in mode `POSITION` [rad/s or m/s]; 0 or less keeps the present
                one. Mode `VELOCITY` removes it.

        Raises:
            ValueError: There is no such mode.
            struct.error: An argument is not a number.
        """
        if mode not in MODES:
            raise ValueError("there is no such mode")

    def clamp(self, velocity: float) -> None:
        """Set the maximum velocity of the motor [rad/s or m/s]."""
        self._motors[self._dof * _COLUMNS + MOTOR_VELOCITY_CLAMP] = velocity

    def add_torques(self, torques: Sequence[float]) -> None:
        """Add to the torques of the next step [N m or N], one number for each dof."""
        for axis, torque in enumerate(torques):
            self._torques[self._dof + axis] += torque


class AxisMotor(JointMotor):
    """The motor of a revolute or prismatic joint; `lower` > `upper` means that there are no limits."""

    __slots__ = ()

    def __init__(self, world: World, clock: Clock, dof: int, lower: float, upper: float) -> None:
        super().__init__(world, clock, dof)
        if lower <= upper:
            self.lower, self.upper = lower, upper

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        """Set the motor, the PD drive or the torque; target positions are clipped to the limits."""
        if mode == POSITION:
            if not self.lower <= position <= self.upper:
                position = self._within_limits(position)
            impulse = float(force) * self._clock.time_step
            _write_target(self._motors, self._row_at, position, velocity, kp, kd, impulse)
            if clamp > 0.0:
                self._motors[self._dof * _COLUMNS + MOTOR_VELOCITY_CLAMP] = clamp
        elif mode == VELOCITY:
            impulse = float(force) * self._clock.time_step
            _write_target_and_clamp(self._motors, self._row_at, 0.0, velocity, 0.0, kd, impulse, inf)
        elif mode == TORQUE:
            self._torques[self._dof] += force
        elif mode == PD:
            bound = force if force >= MIN_PD_FORCE else 0.0
            _write_target(self._pd, self._row_at, self._within_limits(position), velocity, kp, kd, bound)
        else:
            super().command(mode, position, velocity, force, kp, kd, clamp)

    def _within_limits(self, position: float) -> float:
        return self.lower if position < self.lower else self.upper if position > self.upper else position


class PlanarMotor(JointMotor):
    """Torques of a joint with several dofs; a single number applies to the first dof."""

    __slots__ = ()

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        """Add to the torque of the first dof; there is no motor."""
        super().command(mode, position, velocity, force, kp, kd, clamp)
        if mode == TORQUE:
            self._torques[self._dof] += force


class SphericalMotor(PlanarMotor):
    """The motor of a spherical joint."""

    __slots__ = ()

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        """Set the motor, or add to the torque; the numbers apply to the first axis."""
        super().command(mode, position, velocity, force, kp, kd, clamp)
        if mode == POSITION:
            # A single number is not an orientation; as in PyBullet, it is used as x of the quaternion.
            target = (position, 0.0, 0.0, 0.0) if position else (0.0, 0.0, 0.0, 1.0)
            every = (force,) * 3, (kp,) * 3, (kd,) * 3, (1.0,) * 3
            self.aim_at_orientation(target, (velocity, 0.0, 0.0), *every, clamp)

    def aim_at_orientation(
        self,
        target: Sequence[float],
        velocity: Sequence[float],
        forces: Sequence[float],
        kps: Sequence[float],
        kds: Sequence[float],
        dampings: Sequence[float],
        clamp: float,
    ) -> None:
        """Rotate the joint towards a quaternion (x, y, z, w); other arguments: as for `command`, per axis."""
        motors, time_step = self._motors, self._clock.time_step
        for axis in range(3):
            row = self._dof + axis
            _write_target(
                motors,
                row * _COLUMNS * _DOUBLE,
                target[axis],
                velocity[axis],
                kps[axis],
                kds[axis],
                forces[axis] * time_step,
            )
            motors[row * _COLUMNS + MOTOR_DAMPING] = dampings[axis]
            if clamp > 0.0:
                motors[row * _COLUMNS + MOTOR_VELOCITY_CLAMP] = clamp
        motors[self._dof * _COLUMNS + MOTOR_TARGET_W] = target[3]
