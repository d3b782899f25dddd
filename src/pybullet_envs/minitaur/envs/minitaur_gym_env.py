"""A Minitaur with lagging sensors that learns to walk, and what all its environments are made from."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import inf
from typing import Any

import numpy as np

from pybullet_envs.bullet.minitaur import observation_bound
from pybullet_envs.env_bases import Place
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase
from pybullet_envs.minitaur.envs.minitaur import SENSOR_NOISE_STDDEV, Minitaur
from pybullet_envs.minitaur.envs.minitaur_derpy import MinitaurDerpy
from pybullet_envs.minitaur.envs.minitaur_rainbow_dash import MinitaurRainbowDash
from pybullet_envs.minitaur_env_bases import MinitaurEnvBase, Step

NUM_MOTORS = 8
DEFAULT_URDF_VERSION = "default"
DERPY_V0_URDF_VERSION = "derpy_v0"
RAINBOW_DASH_V0_URDF_VERSION = "rainbow_dash_v0"
MINIATUR_URDF_VERSION_MAP: dict[str, Callable[..., Minitaur]] = {
    DEFAULT_URDF_VERSION: Minitaur,
    DERPY_V0_URDF_VERSION: MinitaurDerpy,
    RAINBOW_DASH_V0_URDF_VERSION: MinitaurRainbowDash,
}
NUM_SIMULATION_ITERATION_STEPS = 300
# With torques, without, in seconds and steps of the simulation.
_STEPS = {True: (0.01, 5), False: (0.01, 1)}

Randomizers = EnvRandomizerBase | Iterable[EnvRandomizerBase] | None


class MinitaurGymEnv(MinitaurEnvBase[Minitaur]):
    """A Minitaur is to come far along x, and to spend little.

    Observation: angles [rad], velocities [rad/s] and torques [N m] of the eight motors, and the orientation
    of the base, all as sensed. Action: how each leg swings and then how far each is stretched, within -1 and
    1. Reward: the way forward, less energy, drift and leaning, by their weights. An episode ends with a fall.

    Attributes:
        control_time_step: How long a step of the environment is [s].
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 100}  # noqa: RUF012  # as Gymnasium has it
    picture_size = (480, 360)
    _reset_duration = 1.0

    def __init__(
        self,
        urdf_root: str | None = None,
        urdf_version: str | None = None,
        distance_weight: float = 1.0,
        energy_weight: float = 0.005,
        shake_weight: float = 0.0,
        drift_weight: float = 0.0,
        distance_limit: float = inf,
        observation_noise_stdev: Sequence[float] = SENSOR_NOISE_STDDEV,
        self_collision_enabled: bool = True,
        motor_velocity_limit: float = inf,
        pd_control_enabled: bool = False,
        leg_model_enabled: bool = True,
        accurate_motor_model_enabled: bool = False,
        remove_default_joint_damping: bool = False,
        motor_kp: float = 1.0,
        motor_kd: float = 0.02,
        control_latency: float = 0.0,
        pd_latency: float = 0.0,
        torque_control_enabled: bool = False,
        motor_overheat_protection: bool = False,
        hard_reset: bool = True,
        on_rack: bool = False,
        render: bool = False,
        num_steps_to_log: int = 1000,
        action_repeat: int = 1,
        control_time_step: float | None = None,
        env_randomizer: Randomizers = None,
        forward_reward_cap: float = inf,
        reflection: bool = True,
        log_path: str | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment.

        Args:
            urdf_root: The folder of the files; that of `pybullet_data` where not given.
            urdf_version: Which robot: `default`, `derpy_v0` or `rainbow_dash_v0`; the first where not given.
            distance_weight: Of the way forward [1/m].
            energy_weight: Of the energy spent [1/J].
            shake_weight: Of leaning, to the sum of the sines of both angles.
            drift_weight: Of the way aside [1/m].
            distance_limit: How far away from its start the robot may walk [m].
            observation_noise_stdev: Of the sensors; see `Minitaur`.
            self_collision_enabled: Whether the robot's links touch each other.
            motor_velocity_limit: How fast commands may lead the motors [rad/s].
            pd_control_enabled: Whether torques of a PD controller drive the motors.
            leg_model_enabled: Whether actions say how legs swing and stretch, or where motors go [rad].
            accurate_motor_model_enabled: Whether torques of a model of the motors drive them.
            remove_default_joint_damping: Whether links move through the air without damping.
            motor_kp: Gain for angles, of the model of the motors.
            motor_kd: Gain for velocities.
            control_latency: How old what the sensors tell is [s].
            pd_latency: How old what the motors' controllers see is [s].
            torque_control_enabled: Whether commands are duty cycles for the model of the motors.
            motor_overheat_protection: Whether a motor of that model that strains for a second is shut off.
            hard_reset: Whether each `reset` loads everything anew, or puts the robot back.
            on_rack: Whether the robot's base is fixed, in the air.
            render: Whether to open a window.
            num_steps_to_log: How many steps of an episode are logged at most.
            action_repeat: Steps of the simulation for each of the environment. Of effect with
                `control_time_step`; else it is 5 where torques drive the motors, and 1 where not.
            control_time_step: How long a step of the environment is [s]; 0.01 where not given.
            env_randomizer: What changes the robot at each `reset`, and disturbs it: one or several.
            forward_reward_cap: The most that a step's way forward counts [m].
            reflection: Whether the ground reflects; pictures here have no reflections.
            log_path: A folder for logs of the episodes, for which `protobuf` is needed; none are written
                where not given.
            render_mode: `human`, `rgb_array` or none.

        Raises:
            ValueError: There is no such `urdf_version`.
        """
        version = DEFAULT_URDF_VERSION if urdf_version is None else urdf_version
        if version not in MINIATUR_URDF_VERSION_MAP:
            raise ValueError(f"{version} is not a supported urdf_version.")
        if control_time_step is None:
            control_time_step, action_repeat = _STEPS[accurate_motor_model_enabled or pd_control_enabled]
        self.control_time_step = control_time_step
        super().__init__(
            urdf_root,
            control_time_step / action_repeat,
            action_repeat,
            NUM_SIMULATION_ITERATION_STEPS // action_repeat,
            distance_limit,
            leg_model_enabled,
            hard_reset,
            render,
            render_mode,
        )
        self._make_minitaur = MINIATUR_URDF_VERSION_MAP[version]
        self._robot: dict[str, Any] = {
            "self_collision_enabled": self_collision_enabled,
            "motor_velocity_limit": motor_velocity_limit,
            "pd_control_enabled": pd_control_enabled,
            "accurate_motor_model_enabled": accurate_motor_model_enabled,
            "remove_default_joint_damping": remove_default_joint_damping,
            "motor_kp": motor_kp,
            "motor_kd": motor_kd,
            "control_latency": control_latency,
            "pd_latency": pd_latency,
            "observation_noise_stdev": observation_noise_stdev,
            "torque_control_enabled": torque_control_enabled,
            "motor_overheat_protection": motor_overheat_protection,
            "on_rack": on_rack,
        }
        self._objective_weights = [distance_weight, energy_weight, drift_weight, shake_weight]
        self._forward_reward_cap = forward_reward_cap
        self._env_randomizers: list[EnvRandomizerBase] = []
        if isinstance(env_randomizer, Iterable):
            self._env_randomizers.extend(env_randomizer)
        elif env_randomizer is not None:
            self._env_randomizers.append(env_randomizer)
        self._log_path = log_path
        self._num_steps_to_log = num_steps_to_log
        self.logging: Any = None
        self._episode: Any = None
        if log_path is not None:
            # Logs alone need protobuf.
            from pybullet_envs.minitaur.envs.minitaur_logging import MinitaurLogging

            self.logging = MinitaurLogging(log_path)
        self._set_spaces(NUM_MOTORS, self._action_bound, self._get_observation_upper_bound())

    @property
    def pybullet_client(self) -> Any:
        """The world."""
        self._begin_if_needed()
        return self._p

    @property
    def ground_id(self) -> int:
        """The ground."""
        self._begin_if_needed()
        return self._ground_id

    @ground_id.setter
    def ground_id(self, new_ground_id: int) -> None:
        self._ground_id = new_ground_id

    @property
    def env_step_counter(self) -> int:
        """Steps since the episode began."""
        return self._env_step_counter

    @property
    def objective_weights(self) -> list[float]:
        """The weights of what `get_objectives` lists."""
        return self._objective_weights

    def add_env_randomizer(self, env_randomizer: EnvRandomizerBase) -> None:
        """Adds something that changes or disturbs the robot."""
        self._env_randomizers.append(env_randomizer)

    def set_time_step(self, control_step: float, simulation_step: float = 0.001) -> None:
        """Sets how long steps are, from now on.

        Args:
            control_step: Of the environment [s].
            simulation_step: Of the simulation [s].

        Raises:
            ValueError: The environment's is shorter than the simulation's.
        """
        if control_step < simulation_step:
            raise ValueError("Control step should be larger than or equal to simulation step.")
        self._begin_if_needed()
        self.control_time_step = control_step
        self._time_step = simulation_step
        self._action_repeat = round(control_step / simulation_step)
        self._solver_iterations = NUM_SIMULATION_ITERATION_STEPS // self._action_repeat
        self._p.setPhysicsEngineParameter(numSolverIterations=self._solver_iterations)
        self._p.setTimeStep(self._time_step)
        self.minitaur.SetTimeSteps(self._action_repeat, self._time_step)

    def _load_minitaur(self) -> Minitaur:
        return self._make_minitaur(
            pybullet_client=self._p,
            urdf_root=self._urdf_root,
            time_step=self._time_step,
            action_repeat=self._action_repeat,
            **self._robot,
        )

    def _initial_motor_angles(self) -> np.ndarray | None:
        """Where the motors are when an episode begins [rad], (8,); where they come to stand if none."""
        return None

    def reset(
        self,
        initial_motor_angles: Any = None,
        reset_duration: float | None = None,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode.

        Args:
            initial_motor_angles: Where the motors are to be [rad], (8,); the environment's where not given.
            reset_duration: How long the robot has to come there [s].
            seed: Of the random numbers.
            options: Of no effect.
        """
        super().reset(seed=seed)
        self._save_log()
        self._renew_world()
        # In PyBullet the robot comes to stand with a cone of friction where it was loaded just now, and with
        # the pyramid that everything else has where it was put back.
        self._p.setPhysicsEngineParameter(enableConeFriction=int(self._hard_reset))
        self.minitaur.np_random = self.np_random
        self.minitaur.Reset(
            reload_urdf=False,
            default_motor_angles=(
                self._initial_motor_angles() if initial_motor_angles is None else initial_motor_angles
            ),
            reset_time=self._reset_duration if reset_duration is None else reset_duration,
        )
        self._p.setPhysicsEngineParameter(enableConeFriction=0)
        self._begin_episode()
        for env_randomizer in self._env_randomizers:
            env_randomizer.randomize_env(self)
        self._add_targets()
        return self._observe(), {}

    def _add_targets(self) -> None:
        """Loads what comes into the world when the robot stands."""

    def step(self, action: Any) -> Step:
        """Moves on.

        Raises:
            ValueError: The action is not as many finite numbers as it should be, or one is out of bounds.
        """
        checked = self._checked(action)
        self._last_base_position: Place = self.minitaur.GetBasePosition()
        self._pace()
        for env_randomizer in self._env_randomizers:
            env_randomizer.randomize_step(self)
        commands = self._transform_action_to_motor_command(checked)
        self._disturb()
        self.minitaur.Step(commands, self._randomize_sub_step if self._env_randomizers else None)
        reward = self._reward()
        ended = self._termination()
        if self._episode is not None:
            from pybullet_envs.minitaur.envs.minitaur_logging import update_episode_proto

            update_episode_proto(self._episode, self.minitaur, commands, self._env_step_counter)
        self._env_step_counter += 1
        if ended:
            self.minitaur.Terminate()
        return self._observe(), reward, ended, False, {}

    def _disturb(self) -> None:
        """Changes the surroundings before a step."""

    def _randomize_sub_step(self, number: int) -> None:
        for env_randomizer in self._env_randomizers:
            env_randomizer.randomize_sub_step(self, number, self._action_repeat)

    def close(self) -> None:
        """Writes the log of the episode, and ends the world."""
        self._save_log()
        self._env_step_counter = 0
        super().close()

    def _save_log(self) -> None:
        if self.logging is None:
            return
        from pybullet_envs.minitaur.envs.minitaur_logging import MinitaurEpisode, preallocate_episode_proto

        if self._env_step_counter > 0:
            self.logging.save_episode(self._episode)
        self._episode = MinitaurEpisode()
        preallocate_episode_proto(self._episode, self._num_steps_to_log)

    def _reward(self) -> float:
        forward, aside, _ = np.subtract(self.minitaur.GetBasePosition(), self._last_base_position)
        energy = self._motor_power() * self._time_step
        leaning = abs(float(self._up()[:2].sum()))
        objectives = [min(float(forward), self._forward_reward_cap), -energy, -abs(float(aside)), -leaning]
        self._objectives.append(objectives)
        return float(np.dot(objectives, self._objective_weights))

    def _observe(self) -> np.ndarray:
        return np.array(self._get_observation(), np.float32)

    def _get_observation(self) -> np.ndarray:
        """What is sensed."""
        robot = self.minitaur
        self._observation = np.concatenate(
            (
                robot.GetMotorAngles(),
                robot.GetMotorVelocities(),
                robot.GetMotorTorques(),
                robot.GetBaseOrientation(),
            )
        )
        return self._observation

    def _get_true_observation(self) -> np.ndarray:
        """What would be sensed without delay and noise."""
        return self.minitaur.GetTrueObservation()[:28]

    def _get_observation_upper_bound(self) -> np.ndarray:
        """The greatest values of `_get_observation`."""
        return observation_bound()
