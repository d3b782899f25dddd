"""An environment with a Minitaur that trots."""

from __future__ import annotations

from math import pi

import numpy as np

from pybullet_envs.minitaur.envs.leg_pose_env import NUM_LEGS, LegPoseEnv
from pybullet_envs.minitaur.envs.minitaur_gym_env import NUM_MOTORS, Randomizers

_MAX_ACTION = 0.25
# The legs at opposite corners move together.
_PHASES = np.array((0.0, pi, pi, 0.0))


class MinitaurTrottingEnv(LegPoseEnv):
    """A Minitaur whose feet move along ellipses learns to keep its balance and to walk far along x.

    Observation: roll, pitch [rad] and their rates [rad/s]; optionally the motor angles of the gait and the
    observed motor angles [rad]. Action: swing of each leg, then extension of each leg, added to those of the
    gait, up to 0.25 rad. Reward: that of `MinitaurGymEnv`. An episode ends when roll or pitch is larger than
    0.3 rad.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 166}  # noqa: RUF012  # as Gymnasium has it

    def __init__(
        self,
        urdf_version: str | None = None,
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
        use_signal_in_observation: bool = False,
        use_angle_in_observation: bool = False,
        hard_reset: bool = False,
        env_randomizer: Randomizers = None,
        log_path: str | None = None,
        init_extension: float = 2.0,
        init_swing: float = 0.0,
        step_frequency: float = 2.0,
        extension_amplitude: float = 0.35,
        swing_amplitude: float = 0.3,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment; see `MinitaurGymEnv` for the arguments that have the same names.

        With `use_signal_in_observation` the motor angles of the gait are observed, with
        `use_angle_in_observation` the observed motor angles. The gait moves swing and extension of the legs
        around `init_swing` and `init_extension` [rad], with `step_frequency` [1/s] and the amplitudes
        `swing_amplitude` and `extension_amplitude` [rad].
        """
        self._step_frequency = step_frequency
        self._extension_amplitude = extension_amplitude
        self._swing_amplitude = swing_amplitude
        super().__init__(
            actions=NUM_MOTORS,
            bound=_MAX_ACTION,
            init_swing=init_swing,
            init_extension=init_extension,
            tells_signal=use_signal_in_observation,
            tells_angles=use_angle_in_observation,
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
            accurate_motor_model_enabled=accurate_motor_model_enabled,
            hard_reset=hard_reset,
            env_randomizer=env_randomizer,
            log_path=log_path,
            render_mode=render_mode,
        )

    def _signal(self, t: float) -> np.ndarray:
        turned = 2 * pi * self._step_frequency * t + _PHASES
        gait = (self._swing_amplitude * np.sin(turned), self._extension_amplitude * np.cos(turned))
        return self._init_pose + np.reshape(gait, 2 * NUM_LEGS)
