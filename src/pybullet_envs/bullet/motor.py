"""Motor model of `pybullet_envs.bullet.minitaur`."""

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
    """Motors whose measured angles and velocities have no latency."""

    def convert_to_torque(
        self, motor_commands: Any, current_motor_angle: Any, current_motor_velocity: Any
    ) -> Torques:
        """The torques of the motors for commands.

        Args:
            motor_commands: Angles [rad], or duty cycles with torque control.
            current_motor_angle: Present angles [rad].
            current_motor_velocity: Present velocities [rad/s].

        Returns:
            Actual torques [N m], and those that the sensor reports.
        """
        duty = self._duty(motor_commands, current_motor_angle, current_motor_velocity, self._kp, self._kd)
        return self._torques(duty, current_motor_velocity)
