"""The motors of `pybullet_envs.bullet.minitaur`."""

from __future__ import annotations

from typing import Any

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
    "OBSERVED_TORQUE_LIMIT",
    "VOLTAGE_CLIPPING",
    "MotorModel",
]


class MotorModel(DcMotor):
    """Motors without delay between what is measured and what is."""

    def convert_to_torque(
        self, motor_commands: Any, current_motor_angle: Any, current_motor_velocity: Any
    ) -> Torques:
        """What the motors do for commands.

        Args:
            motor_commands: Angles [rad], or duty cycles under torque control.
            current_motor_angle: Angles now [rad].
            current_motor_velocity: Velocities now [rad/s].

        Returns:
            Torques [N m] that act, and those that the sensor tells.
        """
        duty = self._duty(motor_commands, current_motor_angle, current_motor_velocity, self._kp, self._kd)
        return self._torques(duty, current_motor_velocity)
