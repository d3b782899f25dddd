"""Base class of the Minitaur environments: flat ground, leg commands, falls and observations."""

from __future__ import annotations

import os
import time
from abc import abstractmethod
from math import hypot, inf
from typing import Any, Generic, TypeVar

import numpy as np

import pybullet
import pybullet_data
from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.env_bases import BulletEnv, Place
from pybullet_envs.minitaur_bases import MinitaurBody

ACTION_EPS = 0.01
OBSERVATION_EPS = 0.01
_UPRIGHT = 0.85
_LOWEST = 0.13

RobotT = TypeVar("RobotT", bound=MinitaurBody)
Step = tuple[np.ndarray, float, bool, bool, dict[str, Any]]


class MinitaurEnvBase(BulletEnv, Generic[RobotT]):
    """A Minitaur on flat ground, rewarded for forward progress minus the energy it spends.

    The first episode begins at the first `reset`, or before something that needs an episode: in PyBullet it
    begins when the environment is made, and scripts rely on this.
    """

    _camera = (1.0, 0.0, -30.0)
    _action_bound = 1.0

    def __init__(
        self,
        urdf_root: str | None,
        time_step: float,
        action_repeat: int,
        solver_iterations: int,
        distance_limit: float,
        leg_model_enabled: bool,
        hard_reset: bool,
        render: bool,
        render_mode: str | None,
    ) -> None:
        """Stores the settings.

        Args:
            urdf_root: Folder of the robot's files; by default that of `pybullet_data`.
            time_step: Time step of the simulation [s].
            action_repeat: Number of simulation steps per environment step.
            solver_iterations: Number of solver iterations per simulation step.
            distance_limit: Distance from the start at which an episode ends [m].
            leg_model_enabled: Whether actions are swing and extension of legs; otherwise, motor angles.
            hard_reset: Whether each `reset` loads everything again.
            render: Whether to open a window.
            render_mode: `human`, `rgb_array` or none.
        """
        super().__init__(render, render_mode)
        self._urdf_root = pybullet_data.getDataPath() if urdf_root is None else urdf_root
        self._time_step = time_step
        self._action_repeat = action_repeat
        self._solver_iterations = solver_iterations
        self._distance_limit = distance_limit
        self._leg_model_enabled = leg_model_enabled
        self._hard_reset = hard_reset
        self._minitaur: RobotT | None = None
        self._ground_id = -1
        self._loaded_bodies: set[int] = set()
        self._loaded_state = -1
        self._env_step_counter = 0
        self._last_base_position: Place = (0.0, 0.0, 0.0)
        self._objectives: list[list[float]] = []
        self._observation = np.zeros(0)
        self._last_frame_time = 0.0

    def _set_spaces(self, actions: int, bound: float, most: np.ndarray) -> None:
        """Makes the spaces: `actions` numbers within ±`bound`, and observations within ±`most`."""
        self.action_space: gymnasium.spaces.Space[Any] = gymnasium.spaces.Box(
            -bound, bound, (actions,), np.float32
        )
        high = np.asarray(most + OBSERVATION_EPS, np.float32)
        self.observation_space: gymnasium.spaces.Space[Any] = gymnasium.spaces.Box(
            -high, high, dtype=np.float32
        )

    @property
    def minitaur(self) -> RobotT:
        """The robot."""
        self._begin_if_needed()
        assert self._minitaur is not None
        return self._minitaur

    def _begin_if_needed(self) -> None:
        if self._minitaur is None:
            self.reset()

    def close(self) -> None:
        """Closes the world; a new one is made when it is needed."""
        self._minitaur = None
        super().close()

    def _load_world(self) -> None:
        """Loads the ground and the robot into an empty world."""
        bullet = self._p
        bullet.resetSimulation()
        bullet.setPhysicsEngineParameter(numSolverIterations=self._solver_iterations)
        bullet.setTimeStep(self._time_step)
        self._ground_id = bullet.loadURDF(os.path.join(self._urdf_root, "plane.urdf"))
        self._load_things()
        bullet.setGravity(0, 0, -10)
        self._minitaur = self._load_minitaur()
        self._loaded_bodies = self._bodies()
        self._loaded_state = bullet.saveState()

    def _load_things(self) -> None:
        """Loads other bodies, before the robot; for subclasses."""

    @abstractmethod
    def _load_minitaur(self) -> RobotT:
        """Loads the robot."""

    def _renew_world(self) -> None:
        """Loads everything, or restores exactly the state after loading.

        Bodies that were added since are removed. If a body is missing, everything is loaded again.
        """
        if self._connect() or self._hard_reset or not self._loaded_bodies <= self._bodies():
            self._load_world()
            return
        for body in self._bodies() - self._loaded_bodies:
            self._p.removeBody(body)
        self._p.restoreState(self._loaded_state)
        self.minitaur.Reset(reload_urdf=False)

    def _bodies(self) -> set[int]:
        return {self._p.getBodyUniqueId(number) for number in range(self._p.getNumBodies())}

    def _begin_episode(self) -> None:
        self._env_step_counter = 0
        self._last_base_position = (0.0, 0.0, 0.0)
        self._objectives = []
        if self.render_mode == "human":
            self._p.resetDebugVisualizerCamera(*self._camera, [0, 0, 0])

    def _pace(self) -> None:
        """With a window, waits until real time catches up, and moves the camera with the robot."""
        if self.render_mode != "human":
            return
        since = time.time() - self._last_frame_time
        time.sleep(max(0.0, self._action_repeat * self._time_step - since))
        self._last_frame_time = time.time()
        yaw, pitch, distance = self._p.getDebugVisualizerCamera()[8:11]
        self._p.resetDebugVisualizerCamera(distance, yaw, pitch, self.minitaur.GetBasePosition())

    def _checked(self, action: Any) -> np.ndarray:
        """A copy of the action as floats.

        Raises:
            ValueError: The action has another shape than expected, or a number is not finite.
        """
        values = np.array(action, dtype=float)
        if values.shape != self.action_space.shape:
            raise ValueError(f"the action has shape {values.shape}, not {self.action_space.shape}")
        if not np.isfinite(values).all():
            raise ValueError(f"the action {action!r} has a number that is not finite")
        return values

    def _check_bounds(self, action: np.ndarray) -> None:
        """Checks that commands for legs are within bounds.

        Raises:
            ValueError: A command is greater than 1, or less than -1.
        """
        for number, value in enumerate(action):
            if abs(value) > self._action_bound + ACTION_EPS:
                raise ValueError(f"{number}th action {value} out of bounds.")

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        """The motor commands for an action."""
        if not self._leg_model_enabled:
            return action
        self._check_bounds(action)
        return self.minitaur.ConvertFromLegModel(action)

    def _looked_at(self) -> Place:
        return self.minitaur.GetBasePosition()

    def _up(self) -> np.ndarray:
        """The vertical direction in the observed frame of the base, (3,)."""
        orientation = self.minitaur.GetBaseOrientation()
        return np.array(pybullet.getMatrixFromQuaternion(orientation)[6:])

    def is_fallen(self) -> bool:
        """Whether the base is tilted by more than 32 degrees, or less than 13 cm high."""
        return bool(self._up()[2] < _UPRIGHT or self.minitaur.GetBasePosition()[2] < _LOWEST)

    def _termination(self) -> bool:
        if self._distance_limit < inf:
            x, y, _ = self.minitaur.GetBasePosition()
            if hypot(x, y) > self._distance_limit:
                return True
        return self.is_fallen()

    def _motor_power(self) -> float:
        """Magnitude of the total mechanical power of all motors [W]."""
        return abs(float(np.dot(self.minitaur.GetMotorTorques(), self.minitaur.GetMotorVelocities())))

    def get_objectives(self) -> list[list[float]]:
        """Terms of the reward in each step of the episode: forward progress, energy, drift and shaking."""
        return self._objectives

    def get_minitaur_motor_angles(self) -> np.ndarray:
        """Angles of the motors, as last observed [rad], (8,)."""
        return self._observation[:8]

    def get_minitaur_motor_velocities(self) -> np.ndarray:
        """Velocities of the motors, as last observed [rad/s], (8,)."""
        return self._observation[8:16]

    def get_minitaur_motor_torques(self) -> np.ndarray:
        """Torques of the motors, as last observed [N m], (8,)."""
        return self._observation[16:24]

    def get_minitaur_base_orientation(self) -> np.ndarray:
        """Orientation of the base, as last observed (x, y, z, w)."""
        return self._observation[24:]
