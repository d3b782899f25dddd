"""An environment with a Minitaur that alternately lifts two legs and the other two."""

from __future__ import annotations

from math import cos, pi

import numpy as np

from pybullet_envs.minitaur.envs.leg_pose_env import NUM_LEGS, BentLegsEnv
from pybullet_envs.minitaur.envs.minitaur_gym_env import NUM_MOTORS, Randomizers

DESIRED_PITCH = 0
INIT_EXTENSION_POS = 2.6
INIT_SWING_POS = 0.0
STEP_PERIOD = 1.0 / 3.0
STEP_AMPLITUDE = 0.75
_MAX_ACTION = 0.1
_UPRIGHT = 0.85
# Legs that are lifted in one period and in the next: those at opposite corners.
_LIFTED = ((0.0, 1.0, 1.0, 0.0), (1.0, 0.0, 0.0, 1.0))


class MinitaurAlternatingLegsEnv(BentLegsEnv):
    """A Minitaur steps on the spot, with three steps per second, and learns to keep its balance.

    Observation: roll, pitch minus desired pitch [rad], and their rates [rad/s]. Action: swing of each leg,
    then extension of each leg, added to the gait, up to 0.1 rad. Reward: 1 per step. An episode ends when the
    base is tilted by more than 32 degrees.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 66}  # noqa: RUF012  # as Gymnasium has it

    def __init__(
        self,
        urdf_version: str | None = None,
        control_time_step: float = 0.006,
        action_repeat: int = 6,
        control_latency: float = 0,
        pd_latency: float = 0,
        on_rack: bool = False,
        motor_kp: float = 1.0,
        motor_kd: float = 0.02,
        remove_default_joint_damping: bool = False,
        render: bool = False,
        num_steps_to_log: int = 1000,
        env_randomizer: Randomizers = None,
        log_path: str | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment; for the arguments see `MinitaurGymEnv`."""
        super().__init__(
            actions=NUM_MOTORS,
            bound=_MAX_ACTION,
            init_swing=INIT_SWING_POS,
            init_extension=INIT_EXTENSION_POS,
            accurate_motor_model_enabled=True,
            hard_reset=False,
            urdf_version=urdf_version,
            control_time_step=control_time_step,
            action_repeat=action_repeat,
            control_latency=control_latency,
            pd_latency=pd_latency,
            on_rack=on_rack,
            motor_kp=motor_kp,
            motor_kd=motor_kd,
            remove_default_joint_damping=remove_default_joint_damping,
            render=render,
            num_steps_to_log=num_steps_to_log,
            env_randomizer=env_randomizer,
            log_path=log_path,
            render_mode=render_mode,
        )

    def _signal(self, t: float) -> np.ndarray:
        lifted = _LIFTED[int(t / STEP_PERIOD) % 2]
        extension = STEP_AMPLITUDE * (cos(2 * pi * t / STEP_PERIOD) - 1.0)
        pose = self._init_pose.copy()
        pose[NUM_LEGS:] += np.multiply(extension, lifted)
        return pose

    def is_fallen(self) -> bool:
        """Whether the base is tilted by more than 32 degrees."""
        return bool(self._up()[2] < _UPRIGHT)

    def _reward(self) -> float:
        return 1.0

    def _told(self, angles: np.ndarray, rates: np.ndarray) -> np.ndarray:
        return super()._told(angles - (0.0, self.desired_pitch, 0.0), rates)
