"""An environment with a Minitaur that walks to a ball."""

from __future__ import annotations

import os
from math import atan2, cos, hypot, pi, sin

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.minitaur.envs.minitaur_gym_env import ACTION_EPS, NUM_MOTORS, MinitaurGymEnv

__all__ = [
    "ACTION_EPS",
    "GOAL_DISTANCE_THRESHOLD",
    "GOAL_REWARD",
    "INIT_BALL_ANGLE",
    "INIT_BALL_DISTANCE",
    "REWARD_SCALING",
    "MinitaurBallGymEnv",
]

GOAL_DISTANCE_THRESHOLD = 0.8
GOAL_REWARD = 1000.0
REWARD_SCALING = 1e-3
INIT_BALL_ANGLE = pi / 3
INIT_BALL_DISTANCE = 5.0
_STRIDE = 0.5
_STEERING = 0.5
_RATE = 200.0


class MinitaurBallGymEnv(MinitaurGymEnv):
    """A Minitaur with a given gait is steered to a ball 5 m away.

    Observation: direction [rad], positive to the right, and distance [m] of the ball in the robot's frame.
    Action: steering, from -1 to 1. Reward: the negative distance in km, plus 1 on arrival, which ends the
    episode.
    """

    _camera = (2.0, -70.0, -30.0)

    def __init__(
        self,
        urdf_root: str | None = None,
        self_collision_enabled: bool = True,
        pd_control_enabled: bool = False,
        leg_model_enabled: bool = True,
        on_rack: bool = False,
        render: bool = False,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment; see `MinitaurGymEnv` for the arguments.

        Without `leg_model_enabled` there is no gait, and an action is the angle of all motors [rad].
        """
        super().__init__(
            urdf_root=urdf_root,
            self_collision_enabled=self_collision_enabled,
            pd_control_enabled=pd_control_enabled,
            leg_model_enabled=leg_model_enabled,
            on_rack=on_rack,
            render=render,
            render_mode=render_mode,
        )
        self._ball_id = -1
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)
        low, high = np.array(((-pi, 0.0), (pi, 100.0)), np.float32)
        self.observation_space = gymnasium.spaces.Box(low, high, dtype=np.float32)

    def _add_targets(self) -> None:
        angle = self.np_random.uniform(-INIT_BALL_ANGLE, INIT_BALL_ANGLE)
        place = [INIT_BALL_DISTANCE * cos(angle), INIT_BALL_DISTANCE * sin(angle), 1]
        file = os.path.join(self._urdf_root, "sphere_with_restitution.urdf")
        self._ball_id = self._p.loadURDF(file, place)

    def _get_observation(self) -> np.ndarray:
        bullet = self._p
        robot = bullet.getBasePositionAndOrientation(self.minitaur.quadruped)
        ball = bullet.getBasePositionAndOrientation(self._ball_id)
        (x, y, _), _ = bullet.multiplyTransforms(*bullet.invertTransform(*robot), *ball)
        self._observation = np.array((atan2(x, y) - pi / 2, hypot(x, y)))
        return self._observation

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        if not self._leg_model_enabled:
            return action.repeat(NUM_MOTORS)
        self._check_bounds(action)
        phase = _RATE * self.minitaur.GetTimeSinceReset()
        wave, aside = sin(phase), _STEERING * float(action[0])
        one, other = wave * (_STRIDE + aside), -wave * (_STRIDE - aside)
        up, down = wave * _STRIDE, -wave * _STRIDE
        return self.minitaur.ConvertFromLegModel((one, other, other, one, up, down, down, up))

    def _arrived(self) -> bool:
        return bool(self._observation[1] < GOAL_DISTANCE_THRESHOLD)

    def _reward(self) -> float:
        return float(GOAL_REWARD * self._arrived() - self._observation[1]) * REWARD_SCALING

    def _termination(self) -> bool:
        return self._arrived()
