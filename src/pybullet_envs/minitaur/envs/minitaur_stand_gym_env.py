"""An environment with a Minitaur that stands up on its hind legs and balances."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, pi, sin
from typing import Any

import numpy as np

import pybullet
from pybullet_envs.minitaur.envs.minitaur import SENSOR_NOISE_STDDEV
from pybullet_envs.minitaur.envs.minitaur_gym_env import ACTION_EPS, MinitaurGymEnv
from pybullet_envs.minitaur_env_bases import Step

__all__ = [
    "ACTION_EPS",
    "LIMIT_FALLEN",
    "RANGE_OF_LEG_MOTION",
    "MinitaurStandGymEnv",
]

RANGE_OF_LEG_MOTION = 0.7
LIMIT_FALLEN = 0.7
_MAX_RISING_STEPS = 5000
_RISEN = 0.9
_SHORTENED = 0.7
_FRONT = np.array((1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0))
# Motor angles when upright: the front legs point away from the ground, the hind legs to it.
_STANDING = np.array((pi, 0.0, 0.0, pi, 0.0, pi, pi, 0.0)) - _SHORTENED
_BALANCING = np.array((0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 1.0, -1.0))
# Signs of the motor angles as the body rises: front legs rotate upward, hind legs downward.
_RISING = np.array((1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0))
# The front legs kick when a slow sine is near its maximum.
_KICK, _KICK_RATE, _KICK_ABOVE = 1.9, 0.01, 0.94


class MinitaurStandGymEnv(MinitaurGymEnv):
    """A Minitaur rises by itself, in the first step; then it learns to stay upright.

    Observation: that of `MinitaurGymEnv`. Action: swing of the hind legs, from -1 to 1. Reward: the fourth
    power of the sine of the pitch. An episode ends when that sine is less than 0.7.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 50}  # noqa: RUF012  # as Gymnasium has it

    def __init__(
        self,
        urdf_root: str | None = None,
        action_repeat: int = 1,
        observation_noise_stdev: Sequence[float] = SENSOR_NOISE_STDDEV,
        self_collision_enabled: bool = True,
        motor_velocity_limit: float = inf,
        pd_control_enabled: bool = False,
        render: bool = False,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment; for the arguments see `MinitaurGymEnv`."""
        super().__init__(
            urdf_root=urdf_root,
            action_repeat=action_repeat,
            observation_noise_stdev=observation_noise_stdev,
            self_collision_enabled=self_collision_enabled,
            motor_velocity_limit=motor_velocity_limit,
            pd_control_enabled=pd_control_enabled,
            accurate_motor_model_enabled=True,
            motor_overheat_protection=True,
            render=render,
            render_mode=render_mode,
        )
        self._set_spaces(1, self._action_bound, self._get_observation_upper_bound())

    def step(self, action: Any) -> Step:
        """Applies an action for one step; the first step of an episode ignores it and lets the robot rise.

        Raises:
            ValueError: The action is not one finite number.
        """
        if self._env_step_counter > 0:
            return super().step(action)
        self._checked(action)
        self._begin_if_needed()
        for moment in range(_MAX_RISING_STEPS):
            self._pace()
            self.minitaur.ApplyAction(self._rise(moment))
            self._p.stepSimulation()
            self.minitaur.ReceiveObservation()
            self._env_step_counter += 1
            if self._reward() > _RISEN:
                break
        return self._observe(), self._reward(), self._termination(), False, {}

    def _rise(self, moment: int) -> np.ndarray:
        """Motor angles [rad], (8,), at a simulation step of rising."""
        up = pybullet.getMatrixFromQuaternion(self.minitaur.GetTrueBaseOrientation())[8]
        angles = pi / 2 - _SHORTENED + (1.0 - up) * pi / 2 * _RISING
        phase = _KICK_RATE * moment
        if phase > pi and sin(phase) > _KICK_ABOVE:
            angles += _KICK * _FRONT
        return angles

    def _steepness(self) -> float:
        """Magnitude of the sine of the pitch."""
        return abs(float(self._up()[0]))

    def _reward(self) -> float:
        return self._steepness() ** 4

    def _termination(self) -> bool:
        return self._steepness() < LIMIT_FALLEN

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        return _STANDING + RANGE_OF_LEG_MOTION * action * _BALANCING
