"""Motors and PD drives of joints, in one world or in many.

Targets, gains, maximum forces and maximum velocities become columns of `motor` and `pd`, shape (dofs, 8);
`kernels/dynamics/motors.py` converts these to constraint rows and torques. Forces are in N m for revolute
joints and in N for prismatic ones; the bound of a motor is an impulse, the maximum force times the time step.

`Drives` writes many rows. Arguments of its methods are one number for all of these, one for each dof, or one
for each world and dof. The drop-in's functions write the rows of single joints (`native/source/motors.cpp`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import OnDevice, finite, not_negative
from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_SERVO,
    MOTOR_TARGET_W,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
    PD_KD,
    PD_KP,
    PD_MAX_FORCE,
    PD_POSITION,
    PD_VELOCITY,
)
from carom.native.change import Change

_AXES_OF_ONE_WORLD = 2


class Drives(NamedTuple):
    """Motors and PD drives of some velocity coordinates, in one world or in many.

    Attributes:
        motor: `motor` of all coordinates, (dofs, 8) or (worlds, dofs, 8).
        pd: `pd` of all coordinates, likewise.
        dofs: Which coordinates: a slice, or an array of indices.
        substep_time: Duration of a substep [s].
        change: The change that writes them, if it was begun before these were looked up.
    """

    motor: np.ndarray
    pd: np.ndarray
    dofs: slice | np.ndarray
    substep_time: float
    change: Change | None = None

    @property
    def change_at_once(self) -> bool:
        """Whether a change writes the rows: those of one world, or contiguous memory of the processor."""
        return type(self.motor) is np.ndarray and (self._is_of_one_world or isinstance(self.dofs, slice))

    @property
    def _is_of_one_world(self) -> bool:
        return self.motor.ndim == _AXES_OF_ONE_WORLD

    def _noted(
        self, change: Change, rows: np.ndarray, columns: Mapping[int, np.ndarray], *, lasting: bool
    ) -> None:
        """Note columns of the rows with a change: it writes to what lies together."""
        if isinstance(self.dofs, slice):
            target = rows[..., self.dofs, :]
            told = chosen = target.copy()
        else:
            target, told = rows, rows.copy()
            chosen = told[self.dofs]
        for column, values in columns.items():
            chosen[..., column] = values
        if chosen is not told:
            told[self.dofs] = chosen
        change.write(target, told, lasting=lasting)

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
            MOTOR_SERVO: np.zeros(()),
        }
        self._write(self.motor, columns)

    def serve(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike,
        max_force: ArrayLike,
    ) -> None:
        """A servo: stiffness · (position error) + damping · (velocity error), both at the end of a substep.

        Where both gains are 0 it is off.
        """
        kp, kd = (
            not_negative(finite(value, name), name) for value, name in ((stiffness, "kp"), (damping, "kd"))
        )
        impulse = not_negative(max_force, "max_force") * self.substep_time
        if (
            not isinstance(kp, OnDevice)
            and not isinstance(kd, OnDevice)
            and not isinstance(impulse, OnDevice)
        ):
            impulse = np.where(kp + kd > 0.0, impulse, 0.0)
        columns = {
            MOTOR_POSITION: finite(position, "target"),
            MOTOR_VELOCITY: finite(velocity, "velocity"),
            MOTOR_KP: kp,
            MOTOR_KD: kd,
            MOTOR_MAX_IMPULSE: impulse,
            MOTOR_VELOCITY_CLAMP: np.full((), np.inf),
            MOTOR_SERVO: np.ones(()),
        }
        self._write(self.motor, columns)

    def servo_gains(self) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness and damping of the servos.

        Raises:
            ValueError: Somewhere there is none.
        """
        rows = self.motor[..., self.dofs, :]
        if not (np.asarray(rows[..., MOTOR_SERVO]) != 0.0).all():
            raise ValueError(
                "a servo needs its gains the first time: kp= [N m/rad or N/m] and kd= [N m s/rad or N s/m]"
            )
        return rows[..., MOTOR_KP].copy(), rows[..., MOTOR_KD].copy()

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
        # Only the row of the first dof has it.
        columns[MOTOR_TARGET_W] = self.motor[self.dofs, MOTOR_TARGET_W].copy()
        columns[MOTOR_TARGET_W][0] = w
        self._write(self.motor, columns)

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

    def motors(self) -> dict[str, np.ndarray]:
        """What the motors are told, copies; see `JointBatch.motors`."""
        rows = self.motor[..., self.dofs, :]
        return {
            "targets": rows[..., MOTOR_POSITION].copy(),
            "velocities": rows[..., MOTOR_VELOCITY].copy(),
            "gains": rows[..., MOTOR_KP].copy(),
            "velocity_gains": rows[..., MOTOR_KD].copy(),
            "max_forces": rows[..., MOTOR_MAX_IMPULSE] / self.substep_time,
            "max_velocities": rows[..., MOTOR_VELOCITY_CLAMP].copy(),
        }

    def springs(self) -> dict[str, np.ndarray]:
        """What the PD drives are told, copies; see `JointBatch.springs`."""
        rows = self.pd[..., self.dofs, :]
        return {
            "targets": rows[..., PD_POSITION].copy(),
            "velocities": rows[..., PD_VELOCITY].copy(),
            "stiffness": rows[..., PD_KP].copy(),
            "damping": rows[..., PD_KD].copy(),
            "max_forces": rows[..., PD_MAX_FORCE].copy(),
        }

    def switch_off(self) -> None:
        """Switch off the motors and the PD drives."""
        if self.change_at_once:
            change = Change() if self.change is None else self.change
            none = np.zeros(())
            self._noted(change, self.motor, {MOTOR_MAX_IMPULSE: none}, lasting=False)
            self._noted(change, self.pd, {PD_MAX_FORCE: none}, lasting=False)
            change.commit()
            return
        self.motor[..., self.dofs, MOTOR_MAX_IMPULSE] = 0.0
        self.pd[..., self.dofs, PD_MAX_FORCE] = 0.0

    def _write(self, rows: np.ndarray, columns: Mapping[int, np.ndarray]) -> None:
        """Write columns at once if all of them fit the rows, so that an error changes nothing."""
        if self.change_at_once:
            change = Change() if self.change is None else self.change
            self._noted(change, rows, columns, lasting=True)
            change.commit()
            return
        shape = rows[..., self.dofs, 0].shape
        fitting = {column: np.broadcast_to(values, shape) for column, values in columns.items()}
        if type(rows) is np.ndarray:
            told = rows[..., self.dofs, :]
            for column, values in fitting.items():
                told[..., column] = values
            # One statement: indices pick a copy.
            rows[..., self.dofs, :] = told
            return
        for column, values in fitting.items():
            rows[..., self.dofs, column] = values
