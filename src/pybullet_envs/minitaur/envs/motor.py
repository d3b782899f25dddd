"""Motor model of `pybullet_envs.minitaur.envs.minitaur`."""

from __future__ import annotations

from typing import Any

import numpy as np

from pybullet_envs.dc_motor import (
    MOTOR_RESISTANCE,
    MOTOR_SPEED_LIMIT,
    MOTOR_TORQUE_CONSTANT,
    MOTOR_VISCOUS_DAMPING,
    MOTOR_VOLTAGE,
    OBSERVED_TORQUE_LIMIT,
    VOLTAGE_CLIPPING,
    DcMotor,
    Torques,
)

__all__ = [
    "MOTOR_RESISTANCE",
    "MOTOR_SPEED_LIMIT",
    "MOTOR_TORQUE_CONSTANT",
    "MOTOR_VISCOUS_DAMPING",
    "MOTOR_VOLTAGE",
    "NUM_MOTORS",
    "OBSERVED_TORQUE_LIMIT",
    "VOLTAGE_CLIPPING",
    "MotorModel",
]

NUM_MOTORS = 8


class MotorModel(DcMotor):
    """Motors whose controllers use delayed readings, each with its own torque factor."""

    def __init__(self, torque_control_enabled: bool = False, kp: float = 1.2, kd: float = 0) -> None:
        """Makes motors; see `DcMotor`."""
        super().__init__(torque_control_enabled, kp, kd)
        self._strength_ratios = np.ones(NUM_MOTORS)

    def set_strength_ratios(self, ratios: Any) -> None:
        """Sets the torque factor of each motor, (8,)."""
        self._strength_ratios = np.array(ratios, dtype=float)

    def set_motor_gains(self, kp: float, kd: float) -> None:
        """Sets the gains of all motors; see `DcMotor`."""
        self._kp = kp
        self._kd = kd

    def convert_to_torque(
        self,
        motor_commands: Any,
        motor_angle: Any,
        motor_velocity: Any,
        true_motor_velocity: Any,
        kp: Any = None,
        kd: Any = None,
    ) -> Torques:
        """The torques of the motors for commands.

        Args:
            motor_commands: Angles [rad], or duty cycles with torque control.
            motor_angle: Angles that the controllers use [rad].
            motor_velocity: Velocities that the controllers use [rad/s].
            true_motor_velocity: Present velocities, for the back-EMF [rad/s].
            kp: Position gains, one for all motors or one for each; by default those that have been set.
            kd: Velocity gains, likewise.

        Returns:
            Actual torques [N m], and those that the sensor reports.
        """
        gains = (self._kp if kp is None else kp, self._kd if kd is None else kd)
        acting, seen = self._torques(
            self._duty(motor_commands, motor_angle, motor_velocity, *gains), true_motor_velocity
        )
        return self._strength_ratios * acting, seen
