"""A Minitaur that stands up on its hind legs and stays there."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, pi, sin
from typing import Any

import numpy as np

import pybullet
from pybullet_envs.minitaur.envs.minitaur import SENSOR_NOISE_STDDEV
from pybullet_envs.minitaur.envs.minitaur_gym_env import MinitaurGymEnv
from pybullet_envs.minitaur_env_bases import Step

RANGE_OF_LEG_MOTION = 0.7
LIMIT_FALLEN = 0.7
_MOST_RISING_STEPS = 5000
_RISEN = 0.9
_SHORTENED = 0.7
_FRONT = np.array((1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0))
# Up, the front legs stretch away from the ground and the hind legs to it.
_STANDING = np.array((pi, 0.0, 0.0, pi, 0.0, pi, pi, 0.0)) - _SHORTENED
_BALANCING = np.array((0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 1.0, -1.0))
# As the body rises, the front legs turn upward, and the hind legs downward.
_RISING = np.array((1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0))
# Kicks with the front legs come when a slow sine is near its top.
_KICK, _KICK_RATE, _KICK_ABOVE = 1.9, 0.01, 0.94


class MinitaurStandGymEnv(MinitaurGymEnv):
    """A Minitaur rises by itself, in the first step; then it is to keep upright.

    Observation: as `MinitaurGymEnv`. Action: how far the hind legs swing, within -1 and 1. Reward: the fourth
    power of the sine of its pitch. An episode ends when that sine is less than 0.7.
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
        """Makes the environment; all arguments are as of `MinitaurGymEnv`."""
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
        """Rises, in the first step of an episode, whatever the action; moves on after that.

        Raises:
            ValueError: The action is not one finite number.
        """
        if self._env_step_counter > 0:
            return super().step(action)
        self._checked(action)
        self._begin_if_needed()
        for moment in range(_MOST_RISING_STEPS):
            self._pace()
            self.minitaur.ApplyAction(self._rise(moment))
            self._p.stepSimulation()
            self.minitaur.ReceiveObservation()
            self._env_step_counter += 1
            if self._reward() > _RISEN:
                break
        return self._observe(), self._reward(), self._termination(), False, {}

    def _rise(self, moment: int) -> np.ndarray:
        """Angles of the motors [rad], (8,), to rise with at a step of the simulation."""
        up = pybullet.getMatrixFromQuaternion(self.minitaur.GetTrueBaseOrientation())[8]
        angles = pi / 2 - _SHORTENED + (1.0 - up) * pi / 2 * _RISING
        phase = _KICK_RATE * moment
        if phase > pi and sin(phase) > _KICK_ABOVE:
            angles += _KICK * _FRONT
        return angles

    def _steepness(self) -> float:
        """Sine of the pitch, without its sign."""
        return abs(float(self._up()[0]))

    def _reward(self) -> float:
        return self._steepness() ** 4

    def _termination(self) -> bool:
        return self._steepness() < LIMIT_FALLEN

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        return _STANDING + RANGE_OF_LEG_MOTION * action * _BALANCING
