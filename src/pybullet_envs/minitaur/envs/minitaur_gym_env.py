"""An environment with a Minitaur with sensor latency that learns to walk; base class of the other ones."""

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
from pybullet_envs.minitaur_env_bases import ACTION_EPS, OBSERVATION_EPS, MinitaurEnvBase, Step

__all__ = [
    "ACTION_EPS",
    "BASE_ORIENTATION_OBSERVATION_INDEX",
    "DEFAULT_URDF_VERSION",
    "DERPY_V0_URDF_VERSION",
    "MINIATUR_URDF_VERSION_MAP",
    "MOTOR_ANGLE_OBSERVATION_INDEX",
    "MOTOR_TORQUE_OBSERVATION_INDEX",
    "MOTOR_VELOCITY_OBSERVATION_INDEX",
    "NUM_MOTORS",
    "NUM_SIMULATION_ITERATION_STEPS",
    "OBSERVATION_EPS",
    "RAINBOW_DASH_V0_URDF_VERSION",
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "MinitaurGymEnv",
    "Randomizers",
    "convert_to_list",
]

NUM_MOTORS = 8
# Where in an observation the values of the motors and of the base begin.
MOTOR_ANGLE_OBSERVATION_INDEX = 0
MOTOR_VELOCITY_OBSERVATION_INDEX = MOTOR_ANGLE_OBSERVATION_INDEX + NUM_MOTORS
MOTOR_TORQUE_OBSERVATION_INDEX = MOTOR_VELOCITY_OBSERVATION_INDEX + NUM_MOTORS
BASE_ORIENTATION_OBSERVATION_INDEX = MOTOR_TORQUE_OBSERVATION_INDEX + NUM_MOTORS
# Size of the images of `render` [pixels].
RENDER_HEIGHT, RENDER_WIDTH = 360, 480
DEFAULT_URDF_VERSION = "default"
DERPY_V0_URDF_VERSION = "derpy_v0"
RAINBOW_DASH_V0_URDF_VERSION = "rainbow_dash_v0"
MINIATUR_URDF_VERSION_MAP: dict[str, Callable[..., Minitaur]] = {
    DEFAULT_URDF_VERSION: Minitaur,
    DERPY_V0_URDF_VERSION: MinitaurDerpy,
    RAINBOW_DASH_V0_URDF_VERSION: MinitaurRainbowDash,
}
NUM_SIMULATION_ITERATION_STEPS = 300
# With and without torque-driven motors: environment step [s], and its number of simulation steps.
_STEPS = {True: (0.01, 5), False: (0.01, 1)}

Randomizers = EnvRandomizerBase | Iterable[EnvRandomizerBase] | None


def convert_to_list(obj: Any) -> Any:
    """What can be iterated over as it is, anything else in a list."""
    return obj if isinstance(obj, Iterable) else [obj]


class MinitaurGymEnv(MinitaurEnvBase[Minitaur]):
    """A Minitaur learns to walk far along x with little energy.

    Observation: observed angles [rad], velocities [rad/s] and torques [N m] of the eight motors, and
    orientation of the base. Action: swing of each leg, then extension of each leg, from -1 to 1. Reward:
    weighted sum of forward progress, minus energy, drift and tilt. An episode ends with a fall.

    Attributes:
        control_time_step: Duration of an environment step [s].
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 100}  # noqa: RUF012  # as Gymnasium has it
    picture_size = (RENDER_WIDTH, RENDER_HEIGHT)
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
            urdf_root: Folder of the files; by default that of `pybullet_data`.
            urdf_version: The robot: `default`, `derpy_v0` or `rainbow_dash_v0`; by default the first.
            distance_weight: Weight of forward progress [1/m].
            energy_weight: Weight of the energy spent [1/J].
            shake_weight: Weight of the tilt: of the sum of the sines of both angles.
            drift_weight: Weight of sideways motion [1/m].
            distance_limit: Distance from the start at which an episode ends [m].
            observation_noise_stdev: Standard deviations of the sensor noise; see `Minitaur`.
            self_collision_enabled: Whether the robot's links collide with each other.
            motor_velocity_limit: Velocity limit [rad/s]: commands are clipped to the range of one time step.
            pd_control_enabled: Whether torques of a PD controller drive the motors.
            leg_model_enabled: Whether actions are swing and extension of legs, or motor angles [rad].
            accurate_motor_model_enabled: Whether torques of a motor model drive the motors.
            remove_default_joint_damping: Whether linear and angular damping of the robot are 0.
            motor_kp: Position gain of the motor model.
            motor_kd: Velocity gain of the motor model.
            control_latency: Age of the observed sensor readings [s].
            pd_latency: Age of the readings that the motors' controllers use [s].
            torque_control_enabled: Whether commands are duty cycles for the motor model.
            motor_overheat_protection: Whether the motor model shuts a motor off after 1 s of high torque.
            hard_reset: Whether each `reset` loads everything again, or restores the state.
            on_rack: Whether the base is fixed in the air.
            render: Whether to open a window.
            num_steps_to_log: Maximum number of logged steps per episode.
            action_repeat: Number of simulation steps per environment step. It is used with
                `control_time_step` only; otherwise it is 5 if torques drive the motors, and 1 if not.
            control_time_step: Duration of an environment step [s]; by default 0.01.
            env_randomizer: One or several randomizers that change the robot at each `reset`, and disturb it.
            forward_reward_cap: Upper limit of the forward progress per step in the reward [m].
            reflection: No effect; images of Carom have no reflections.
            log_path: Folder for logs of the episodes, which need `protobuf`; by default, no logs are written.
            render_mode: `human`, `rgb_array` or none.

        Raises:
            ValueError: `urdf_version` is unknown.
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
            # Only logs need protobuf.
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
        """Id of the ground."""
        self._begin_if_needed()
        return self._ground_id

    @ground_id.setter
    def ground_id(self, new_ground_id: int) -> None:
        self._ground_id = new_ground_id

    @property
    def env_step_counter(self) -> int:
        """Number of environment steps since the episode began."""
        return self._env_step_counter

    @property
    def objective_weights(self) -> list[float]:
        """The weights of the terms in `get_objectives`."""
        return self._objective_weights

    def add_env_randomizer(self, env_randomizer: EnvRandomizerBase) -> None:
        """Adds a randomizer that changes or disturbs the robot."""
        self._env_randomizers.append(env_randomizer)

    def set_time_step(self, control_step: float, simulation_step: float = 0.001) -> None:
        """Sets the duration of steps, from now on.

        Args:
            control_step: Duration of an environment step [s].
            simulation_step: Time step of the simulation [s].

        Raises:
            ValueError: The environment step is shorter than the simulation step.
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
        """Motor angles at the start of an episode [rad], (8,); None for those of the settled robot."""
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
            initial_motor_angles: Initial motor angles [rad], (8,); by default those of the environment.
            reset_duration: Time for the motors to reach them [s].
            seed: Seed of the random numbers.
            options: No effect.
        """
        super().reset(seed=seed)
        self._save_log()
        self._renew_world()
        # In PyBullet the robot settles with a friction cone if it has just been loaded, and with the friction
        # pyramid of all other steps if its state was restored.
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
        """Loads bodies after the robot has settled; for subclasses."""

    def step(self, action: Any) -> Step:
        """Applies an action for one step.

        Raises:
            ValueError: The action has a wrong shape, a number that is not finite, or one out of bounds.
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
        """Changes the world before a step; for subclasses."""

    def _randomize_sub_step(self, number: int) -> None:
        for env_randomizer in self._env_randomizers:
            env_randomizer.randomize_sub_step(self, number, self._action_repeat)

    def close(self) -> None:
        """Writes the log of the episode, and closes the world."""
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
        """The present observation, with latency and noise."""
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
        """The present observation, without latency and noise."""
        return self.minitaur.GetTrueObservation()[:28]

    def _get_observation_upper_bound(self) -> np.ndarray:
        """Upper bounds of `_get_observation`."""
        return observation_bound()
