"""Randomizer of masses, battery voltage, damping and foot friction."""

from __future__ import annotations

from typing import Any

import numpy as np

from pybullet_envs.bullet import minitaur_env_randomizer
from pybullet_envs.bullet.minitaur_env_randomizer import (
    BATTERY_VOLTAGE_RANGE,
    MINITAUR_BASE_MASS_ERROR_RANGE,
    MINITAUR_LEG_FRICTION,
    MINITAUR_LEG_MASS_ERROR_RANGE,
    MOTOR_VISCOUS_DAMPING_RANGE,
)
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase

__all__ = [
    "BATTERY_VOLTAGE_RANGE",
    "MINITAUR_BASE_MASS_ERROR_RANGE",
    "MINITAUR_LEG_FRICTION",
    "MINITAUR_LEG_MASS_ERROR_RANGE",
    "MOTOR_VISCOUS_DAMPING_RANGE",
    "MinitaurEnvRandomizer",
]


class MinitaurEnvRandomizer(minitaur_env_randomizer.MinitaurEnvRandomizer, EnvRandomizerBase):
    """Randomizer of a `MinitaurGymEnv`: one mass factor for the chassis, one for each link of the legs."""

    def _draw_base_mass(self, robot: Any, share: float) -> None:
        robot.SetBaseMasses(np.multiply(share, robot.GetBaseMassesFromURDF()))
