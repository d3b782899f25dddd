"""An environment with a Minitaur that learns to walk."""

from __future__ import annotations

from math import inf, pi
from typing import Any

import numpy as np

from pybullet_envs.bullet.env_randomizer_base import EnvRandomizerBase
from pybullet_envs.bullet.minitaur import Minitaur, observation_bound
from pybullet_envs.bullet.minitaur_env_randomizer import MinitaurEnvRandomizer
from pybullet_envs.minitaur_env_bases import ACTION_EPS, OBSERVATION_EPS, MinitaurEnvBase, Step

__all__ = [
    "ACTION_EPS",
    "BASE_ORIENTATION_OBSERVATION_INDEX",
    "MOTOR_ANGLE_OBSERVATION_INDEX",
    "MOTOR_TORQUE_OBSERVATION_INDEX",
    "MOTOR_VELOCITY_OBSERVATION_INDEX",
    "NUM_MOTORS",
    "NUM_SUBSTEPS",
    "OBSERVATION_EPS",
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "MinitaurBulletEnv",
]

NUM_SUBSTEPS = 5
NUM_MOTORS = 8
# Where in an observation the values of the motors and of the base begin.
MOTOR_ANGLE_OBSERVATION_INDEX = 0
MOTOR_VELOCITY_OBSERVATION_INDEX = MOTOR_ANGLE_OBSERVATION_INDEX + NUM_MOTORS
MOTOR_TORQUE_OBSERVATION_INDEX = MOTOR_VELOCITY_OBSERVATION_INDEX + NUM_MOTORS
BASE_ORIENTATION_OBSERVATION_INDEX = MOTOR_TORQUE_OBSERVATION_INDEX + NUM_MOTORS
# Size of the images of `render` [pixels].
RENDER_HEIGHT, RENDER_WIDTH = 720, 960
_TIME_STEP = 0.01
_SOLVER_ITERATIONS = 300
_SETTLING_STEPS = 100
_RANDOMIZER = MinitaurEnvRandomizer()


class MinitaurBulletEnv(MinitaurEnvBase[Minitaur]):
    """A Minitaur learns to walk far along x with little energy.

    Observation: angles [rad], velocities [rad/s] and torques [N m] of the eight motors, and the orientation
    of the base. Action: swing of each leg, then extension of each leg, from -1 to 1. Reward: weighted sum of
    forward progress, minus energy, drift and shaking. An episode ends with a fall.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 50}  # noqa: RUF012  # as Gymnasium has it
    picture_size = (RENDER_WIDTH, RENDER_HEIGHT)

    def __init__(
        self,
        urdf_root: str | None = None,
        action_repeat: int = 1,
        distance_weight: float = 1.0,
        energy_weight: float = 0.005,
        shake_weight: float = 0.0,
        drift_weight: float = 0.0,
        distance_limit: float = inf,
        observation_noise_stdev: float = 0.0,
        self_collision_enabled: bool = True,
        motor_velocity_limit: float = inf,
        pd_control_enabled: bool = False,
        leg_model_enabled: bool = True,
        accurate_motor_model_enabled: bool = True,
        motor_kp: float = 1.0,
        motor_kd: float = 0.02,
        torque_control_enabled: bool = False,
        motor_overheat_protection: bool = True,
        hard_reset: bool = True,
        on_rack: bool = False,
        render: bool = False,
        kd_for_pd_controllers: float = 0.3,
        env_randomizer: EnvRandomizerBase | None = _RANDOMIZER,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment.

        Args:
            urdf_root: Folder of the files; by default that of `pybullet_data`.
            action_repeat: Duration of an environment step, as a multiple of 10 ms.
            distance_weight: Weight of forward progress [1/m].
            energy_weight: Weight of the energy spent [1/J].
            shake_weight: Weight of vertical motion [1/m].
            drift_weight: Weight of sideways motion [1/m].
            distance_limit: Distance from the start at which an episode ends [m].
            observation_noise_stdev: Standard deviation of observation noise, relative to the bounds.
            self_collision_enabled: Whether the robot's links collide with each other.
            motor_velocity_limit: Velocity limit [rad/s]: commands are clipped to the range of one time step.
            pd_control_enabled: Whether torques of a PD controller drive the motors.
            leg_model_enabled: Whether actions are swing and extension of legs, or motor angles [rad].
            accurate_motor_model_enabled: Whether torques of a motor model drive the motors. With neither, the
                engine's position control does.
            motor_kp: Position gain of the motor model.
            motor_kd: Velocity gain of the motor model.
            torque_control_enabled: Whether commands are duty cycles for the motor model.
            motor_overheat_protection: Whether the motor model shuts a motor off after 1 s of high torque.
            hard_reset: Whether each `reset` loads everything again, or restores the state.
            on_rack: Whether the base is fixed in the air.
            render: Whether to open a window.
            kd_for_pd_controllers: Velocity gain of the PD controller.
            env_randomizer: Randomizer that changes the robot at each `reset`, or None.
            render_mode: `human`, `rgb_array` or none.
        """
        # Torques that depend on velocities need short time steps to be stable.
        self._by_torques = pd_control_enabled or accurate_motor_model_enabled
        parts = NUM_SUBSTEPS if self._by_torques else 1
        super().__init__(
            urdf_root,
            _TIME_STEP / parts,
            action_repeat * parts,
            _SOLVER_ITERATIONS // parts,
            distance_limit,
            leg_model_enabled,
            hard_reset,
            render,
            render_mode,
        )
        self._weights = np.array((distance_weight, -energy_weight, drift_weight, shake_weight))
        self._observation_noise_stdev = observation_noise_stdev
        self._torque_control_enabled = torque_control_enabled
        self._env_randomizer = env_randomizer
        self._robot: dict[str, Any] = {
            "time_step": self._time_step,
            "self_collision_enabled": self_collision_enabled,
            "motor_velocity_limit": motor_velocity_limit,
            "pd_control_enabled": pd_control_enabled,
            "accurate_motor_model_enabled": accurate_motor_model_enabled,
            "motor_kp": motor_kp,
            "motor_kd": motor_kd,
            "torque_control_enabled": torque_control_enabled,
            "motor_overheat_protection": motor_overheat_protection,
            "on_rack": on_rack,
            "kd_for_pd_controllers": kd_for_pd_controllers,
        }
        self._set_spaces(NUM_MOTORS, self._action_bound, observation_bound())

    def set_env_randomizer(self, env_randomizer: EnvRandomizerBase | None) -> None:
        """Sets the randomizer that changes the robot at each `reset`."""
        self._env_randomizer = env_randomizer

    def configure(self, args: Any) -> None:
        """Stores arguments, for compatibility with scripts."""
        self._args = args

    def _load_minitaur(self) -> Minitaur:
        return Minitaur(self._p, self._urdf_root, **self._robot)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode; first the robot settles for a hundred simulation steps."""
        super().reset(seed=seed)
        self._renew_world()
        if self._env_randomizer is not None:
            self._env_randomizer.randomize_env(self)
        self._begin_episode()
        for _ in range(0 if self._torque_control_enabled else _SETTLING_STEPS):
            if self._by_torques:
                self.minitaur.ApplyAction(np.full(NUM_MOTORS, pi / 2))
            self._p.stepSimulation()
        return self._observe(), {}

    def step(self, action: Any) -> Step:
        """Applies an action for one step.

        Raises:
            ValueError: The action is not eight finite numbers, or one is out of bounds.
        """
        self._begin_if_needed()
        commands = self._transform_action_to_motor_command(self._checked(action))
        self._pace()
        for _ in range(self._action_repeat):
            self.minitaur.ApplyAction(commands)
            self._p.stepSimulation()
        self._env_step_counter += 1
        reward = self._reward()
        return self._observe(), reward, self._termination(), False, {}

    def _reward(self) -> float:
        position = self.minitaur.GetBasePosition()
        forward, aside, up = np.subtract(position, self._last_base_position)
        self._last_base_position = position
        energy = self._motor_power() * self._time_step
        objectives = [float(forward), energy, -abs(float(aside)), -abs(float(up))]
        self._objectives.append(objectives)
        return float(self._weights @ objectives)

    def _observe(self) -> np.ndarray:
        """The present observation, with noise."""
        self._observation = np.array(self.minitaur.GetObservation())
        seen = self._observation
        if self._observation_noise_stdev > 0:
            noise = self.np_random.normal(scale=self._observation_noise_stdev, size=seen.shape)
            seen = seen + noise * observation_bound()
        return seen.astype(np.float32)
