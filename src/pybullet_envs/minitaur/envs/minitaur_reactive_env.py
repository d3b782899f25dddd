"""An environment with a Minitaur that learns to walk without a given gait."""

from __future__ import annotations

from collections import namedtuple

from pybullet_envs.minitaur.envs.leg_pose_env import NUM_LEGS, LegPoseEnv
from pybullet_envs.minitaur.envs.minitaur_gym_env import NUM_MOTORS, Randomizers

__all__ = [
    "INIT_EXTENSION_POS",
    "INIT_SWING_POS",
    "NUM_LEGS",
    "MinitaurPose",
    "MinitaurReactiveEnv",
]

INIT_EXTENSION_POS = 2.0
INIT_SWING_POS = 0.0
_MAX_ACTION = 0.5

MinitaurPose = namedtuple(
    "MinitaurPose",
    [f"{part}_angle_{leg}" for part in ("swing", "extension") for leg in range(1, NUM_LEGS + 1)],
)
"""Swings, then extensions of all legs [rad]."""


class MinitaurReactiveEnv(LegPoseEnv):
    """A Minitaur learns to walk far along x, by swing and extension of its legs.

    Observation: roll, pitch [rad], their rates [rad/s], and the motor angles [rad]. Action: swing of each
    leg, then extension of each leg, added to those of a stand, up to 0.5 rad. Reward: that of
    `MinitaurGymEnv`. An episode ends when roll or pitch is larger than 0.3 rad.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 166}  # noqa: RUF012  # as Gymnasium has it

    def __init__(
        self,
        urdf_version: str | None = None,
        energy_weight: float = 0.005,
        control_time_step: float = 0.006,
        action_repeat: int = 6,
        control_latency: float = 0.02,
        pd_latency: float = 0.003,
        on_rack: bool = False,
        motor_kp: float = 1.0,
        motor_kd: float = 0.015,
        remove_default_joint_damping: bool = True,
        render: bool = False,
        num_steps_to_log: int = 1000,
        accurate_motor_model_enabled: bool = True,
        use_angle_in_observation: bool = True,
        hard_reset: bool = False,
        env_randomizer: Randomizers = None,
        log_path: str | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment; see `MinitaurGymEnv` for the arguments that have the same names.

        With `use_angle_in_observation` the motor angles are observed.
        """
        super().__init__(
            actions=NUM_MOTORS,
            bound=_MAX_ACTION,
            init_swing=INIT_SWING_POS,
            init_extension=INIT_EXTENSION_POS,
            tells_angles=use_angle_in_observation,
            urdf_version=urdf_version,
            energy_weight=energy_weight,
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
            accurate_motor_model_enabled=accurate_motor_model_enabled,
            hard_reset=hard_reset,
            env_randomizer=env_randomizer,
            log_path=log_path,
            render_mode=render_mode,
        )
