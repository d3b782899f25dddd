"""An environment with a Minitaur that stands on a tilting floor."""

from __future__ import annotations

import numpy as np

from pybullet_envs.minitaur.envs.leg_pose_env import NUM_LEGS, BentLegsEnv
from pybullet_envs.minitaur.envs.minitaur_gym_env import (
    DERPY_V0_URDF_VERSION,
    NUM_MOTORS,
    RAINBOW_DASH_V0_URDF_VERSION,
    Randomizers,
)

__all__ = [
    "DERPY_V0_URDF_VERSION",
    "DESIRED_PITCH",
    "INIT_EXTENSION_POS",
    "INIT_SWING_POS",
    "MOVING_FLOOR_TOTAL_STEP",
    "NUM_MOTORS",
    "PERTURBATION_TOTAL_STEP",
    "RAINBOW_DASH_V0_URDF_VERSION",
    "STEP_AMPLITUDE",
    "STEP_PERIOD",
    "MinitaurFourLegStandEnv",
]

DESIRED_PITCH = 0
STEP_PERIOD = 1.0 / 3.0
STEP_AMPLITUDE = 0.75
PERTURBATION_TOTAL_STEP = 100
INIT_EXTENSION_POS = 2.0
INIT_SWING_POS = 0.0
MOVING_FLOOR_TOTAL_STEP = 100
_MAX_ACTION = 1.0
_MAX_TILT = 0.2
_UPRIGHT, _LOWEST = 0.85, 0.15
_AT_ORIGIN, _LEVEL = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)


class MinitaurFourLegStandEnv(BentLegsEnv):
    """A Minitaur learns to stay level on a floor that tilts at random.

    Observation: roll and pitch [rad]; optionally their rates [rad/s] and the motor angles [rad]. Action:
    extension of each leg, added to that of a stand, up to 1 rad. Reward: 1 / (0.001 + |roll| + |pitch|), at
    most 1000. An episode ends when the base is tilted by more than 32 degrees, or is less than 15 cm high.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 166}  # noqa: RUF012  # as Gymnasium has it

    def __init__(
        self,
        urdf_version: str | None = None,
        hard_reset: bool = True,
        remove_default_joint_damping: bool = True,
        control_latency: float = 0.0,
        pd_latency: float = 0.0,
        on_rack: bool = False,
        motor_kp: float = 1.0,
        motor_kd: float = 0.02,
        render: bool = False,
        env_randomizer: Randomizers = None,
        use_angular_velocity_in_observation: bool = False,
        use_motor_angle_in_observation: bool = False,
        control_time_step: float = 0.006,
        action_repeat: int = 6,
        log_path: str | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment; see `MinitaurGymEnv` for the arguments that have the same names.

        With `use_angular_velocity_in_observation` the rates of roll and pitch are observed, with
        `use_motor_angle_in_observation` the motor angles.
        """
        self._tilts = np.array((_LEVEL, _LEVEL))
        super().__init__(
            actions=NUM_LEGS,
            bound=_MAX_ACTION,
            init_swing=INIT_SWING_POS,
            init_extension=INIT_EXTENSION_POS,
            tells_rates=use_angular_velocity_in_observation,
            tells_angles=use_motor_angle_in_observation,
            accurate_motor_model_enabled=True,
            reflection=False,
            urdf_version=urdf_version,
            hard_reset=hard_reset,
            remove_default_joint_damping=remove_default_joint_damping,
            control_latency=control_latency,
            pd_latency=pd_latency,
            on_rack=on_rack,
            motor_kp=motor_kp,
            motor_kd=motor_kd,
            render=render,
            env_randomizer=env_randomizer,
            control_time_step=control_time_step,
            action_repeat=action_repeat,
            log_path=log_path,
            render_mode=render_mode,
        )

    def _disturb(self) -> None:
        """Tilts the floor a little further to its target, which changes every 100 steps."""
        part, whole = self._env_step_counter % MOVING_FLOOR_TOTAL_STEP, MOVING_FLOOR_TOTAL_STEP
        if part == 0:
            _, now = self._p.getBasePositionAndOrientation(self._ground_id)
            roll, pitch = (self.np_random.uniform(-_MAX_TILT, _MAX_TILT) for _ in "xy")
            self._tilts = np.array((now, self._p.getQuaternionFromEuler([roll, pitch, 0.0])))
        share = part / whole
        tilt = (1.0 - share, share) @ self._tilts
        self._p.resetBasePositionAndOrientation(self._ground_id, _AT_ORIGIN, tilt)

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        return super()._transform_action_to_motor_command(np.concatenate((np.zeros(NUM_LEGS), action)))

    def is_fallen(self) -> bool:
        """Whether the base is tilted by more than 32 degrees, or less than 15 cm high."""
        return bool(self._up()[2] < _UPRIGHT or self.minitaur.GetBasePosition()[2] < _LOWEST)

    def _reward(self) -> float:
        return float(1.0 / (0.001 + np.abs(self.minitaur.GetBaseRollPitchYaw()[:2]).sum()))
