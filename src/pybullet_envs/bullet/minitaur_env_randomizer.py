"""Randomizer of masses, battery voltage, damping and foot friction."""

from __future__ import annotations

from typing import Any

from pybullet_envs.bullet.env_randomizer_base import EnvRandomizerBase

Range = tuple[float, float]

# Relative errors of the masses in the file.
MINITAUR_BASE_MASS_ERROR_RANGE = (-0.2, 0.2)
MINITAUR_LEG_MASS_ERROR_RANGE = (-0.2, 0.2)
# Units: V, V s/rad; a friction coefficient.
BATTERY_VOLTAGE_RANGE = (14.8, 16.8)
MOTOR_VISCOUS_DAMPING_RANGE = (0, 0.01)
MINITAUR_LEG_FRICTION = (0.8, 1.5)


class MinitaurEnvRandomizer(EnvRandomizerBase):
    """Randomizer of a `MinitaurBulletEnv`."""

    def __init__(
        self,
        minitaur_base_mass_err_range: Range = MINITAUR_BASE_MASS_ERROR_RANGE,
        minitaur_leg_mass_err_range: Range = MINITAUR_LEG_MASS_ERROR_RANGE,
        battery_voltage_range: Range = BATTERY_VOLTAGE_RANGE,
        motor_viscous_damping_range: Range = MOTOR_VISCOUS_DAMPING_RANGE,
    ) -> None:
        """Makes a randomizer.

        Args:
            minitaur_base_mass_err_range: Range of the relative error of the base's mass.
            minitaur_leg_mass_err_range: Range of the relative errors of the legs' masses.
            battery_voltage_range: Range of the battery voltage [V].
            motor_viscous_damping_range: Range of the motors' viscous damping [V s/rad].
        """
        self._base_error = minitaur_base_mass_err_range
        self._leg_error = minitaur_leg_mass_err_range
        self._voltage = battery_voltage_range
        self._damping = motor_viscous_damping_range

    def randomize_env(self, env: Any) -> None:
        """Randomises masses, battery voltage, damping and the friction of the feet."""
        draw, robot = env.np_random.uniform, env.minitaur
        self._draw_base_mass(robot, 1.0 + draw(*self._base_error))
        robot.SetLegMasses([mass * (1.0 + draw(*self._leg_error)) for mass in robot.GetLegMassesFromURDF()])
        robot.SetBatteryVoltage(draw(*self._voltage))
        robot.SetMotorViscousDamping(draw(*self._damping))
        robot.SetFootFriction(draw(*MINITAUR_LEG_FRICTION))

    def _draw_base_mass(self, robot: Any, share: float) -> None:
        robot.SetBaseMass(share * robot.GetBaseMassFromURDF())
