"""Randomizer of leg poses and of the desired pitch."""

from __future__ import annotations

from typing import Any

from pybullet_envs.bullet.minitaur_env_randomizer import BATTERY_VOLTAGE_RANGE, MOTOR_VISCOUS_DAMPING_RANGE
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase

NUM_LEGS = 4


class MinitaurAlternatingLegsEnvRandomizer(EnvRandomizerBase):
    """Randomizer of a `MinitaurAlternatingLegsEnv` or `MinitaurFourLegStandEnv`, at each `reset`."""

    def __init__(
        self,
        perturb_swing_bound: float = 0.1,
        perturb_extension_bound: float = 0.1,
        perturb_desired_pitch_bound: float = 0.01,
    ) -> None:
        """Makes a randomizer.

        Args:
            perturb_swing_bound: Largest magnitude of the offset of a leg's swing [rad].
            perturb_extension_bound: Largest magnitude of the offset of a leg's extension [rad].
            perturb_desired_pitch_bound: Largest magnitude of the desired pitch [rad].
        """
        self.perturb_swing_bound = perturb_swing_bound
        self.perturb_extension_bound = perturb_extension_bound
        self.perturb_desired_pitch_bound = perturb_desired_pitch_bound

    def randomize_env(self, env: Any) -> None:
        """Randomises offsets of the legs, desired pitch, battery voltage and damping."""
        draw = env.np_random.uniform
        env.set_swing_offset(draw(-self.perturb_swing_bound, self.perturb_swing_bound, NUM_LEGS))
        env.set_extension_offset(draw(-self.perturb_extension_bound, self.perturb_extension_bound, NUM_LEGS))
        env.set_desired_pitch(draw(-self.perturb_desired_pitch_bound, self.perturb_desired_pitch_bound))
        env.minitaur.SetBatteryVoltage(draw(*BATTERY_VOLTAGE_RANGE))
        env.minitaur.SetMotorViscousDamping(draw(*MOTOR_VISCOUS_DAMPING_RANGE))
