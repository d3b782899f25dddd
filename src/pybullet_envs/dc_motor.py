"""Model of a Minitaur's DC motors: torque from duty cycle, with back-EMF and saturation."""

from __future__ import annotations

from typing import Any

import numpy as np

VOLTAGE_CLIPPING = 50
OBSERVED_TORQUE_LIMIT = 5.7
MOTOR_VOLTAGE = 16.0
MOTOR_RESISTANCE = 0.186
MOTOR_TORQUE_CONSTANT = 0.0954
MOTOR_VISCOUS_DAMPING = 0
MOTOR_SPEED_LIMIT = MOTOR_VOLTAGE / (MOTOR_VISCOUS_DAMPING + MOTOR_TORQUE_CONSTANT)

# Measured torque [N m] for a current [A]: it grows ever slower, because the iron saturates.
_CURRENTS = (0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
_TORQUES = (0.0, 1.0, 1.9, 2.45, 3.0, 3.25, 3.5)

Torques = tuple[np.ndarray, np.ndarray]


class DcMotor:
    """Several equal motors on one battery; commands are angles, or duty cycles with torque control."""

    def __init__(self, torque_control_enabled: bool = False, kp: float = 1.2, kd: float = 0) -> None:
        """Makes motors.

        Args:
            torque_control_enabled: Whether commands are duty cycles from -1 to 1.
            kp: Position gain: duty cycle per angle error [1/rad].
            kd: Velocity gain: opposing duty cycle per angular velocity [s/rad].
        """
        self._duty_commanded = torque_control_enabled
        self._kp = kp
        self._kd = kd
        self._voltage = MOTOR_VOLTAGE
        self._viscous_damping: float = MOTOR_VISCOUS_DAMPING

    def set_voltage(self, voltage: float) -> None:
        """Sets the voltage of the battery [V]."""
        self._voltage = voltage

    def get_voltage(self) -> float:
        """The voltage of the battery [V]."""
        return self._voltage

    def set_viscous_damping(self, viscous_damping: float) -> None:
        """Sets the viscous damping, which adds to the back-EMF constant [V s/rad]."""
        self._viscous_damping = viscous_damping

    def get_viscous_dampling(self) -> float:
        """The viscous damping [V s/rad]; the misspelt name is PyBullet's."""
        return self._viscous_damping

    def _duty(self, commands: Any, angles: Any, velocities: Any, kp: Any, kd: Any) -> np.ndarray:
        """Duty cycles, clipped to -1 and 1."""
        if not self._duty_commanded:
            commands = kp * np.subtract(commands, angles) - np.multiply(kd, velocities)
        return np.clip(commands, -1.0, 1.0)

    def _torques(self, duty: np.ndarray, velocities: Any) -> Torques:
        """Actual torques [N m], and those that the sensor reports, which ignores back-EMF."""
        supplied = duty * self._voltage
        seen = MOTOR_TORQUE_CONSTANT / MOTOR_RESISTANCE * supplied
        back_emf = (MOTOR_TORQUE_CONSTANT + self._viscous_damping) * np.asarray(velocities)
        # Diodes of the controller limit the voltage.
        current = np.clip(supplied - back_emf, -VOLTAGE_CLIPPING, VOLTAGE_CLIPPING) / MOTOR_RESISTANCE
        acting = np.copysign(np.interp(np.abs(current), _CURRENTS, _TORQUES), current)
        return acting, np.clip(seen, -OBSERVED_TORQUE_LIMIT, OBSERVED_TORQUE_LIMIT)
