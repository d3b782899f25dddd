"""Base classes of all environments: a world of their own, and images of it."""

from __future__ import annotations

from typing import Any
from weakref import ref

import numpy as np

import pybullet
from pybullet_envs._gymnasium import gymnasium, require_gymnasium
from pybullet_utils.bullet_client import BulletClient

Place = tuple[float, float, float]


class BulletEnv(gymnasium.Env[np.ndarray, Any]):
    """An environment with a world of its own, made at the first `reset`.

    Attributes:
        picture_size: Width and height of the images of `render` [pixels].
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 60}  # noqa: RUF012  # as Gymnasium has it
    picture_size = (320, 240)
    _camera = (3.0, 0.0, -30.0)
    """Distance [m], yaw and pitch [degrees] of the camera."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        """Makes an environment.

        Args:
            render: Whether to open a window, as `render_mode="human"` does.
            render_mode: `human`, `rgb_array` or none.
        """
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode is {render_mode!r}, not one of {self.metadata['render_modes']}")
        require_gymnasium()
        self.render_mode = "human" if render and render_mode is None else render_mode
        self._p: Any = None

    def seed(self, seed: int | None = None) -> list[int]:
        """Seeds the random numbers of episodes to come, as scripts for the old gym do; see also `reset`."""
        self.np_random, used = gymnasium.utils.seeding.np_random(seed)
        return [used]

    def _connect(self) -> bool:
        """Makes the world if there is none; returns whether it is new."""
        if self._p is not None:
            return False
        self._p = BulletClient(pybullet.GUI if self.render_mode == "human" else pybullet.DIRECT)
        return True

    def _looked_at(self) -> Place:
        """The point that the camera looks at [m]."""
        return (0.0, 0.0, 0.0)

    def render(self, mode: str | None = None) -> np.ndarray | None:  # type: ignore[override]
        """An image (height, width, 3), white before `reset`; None if the environment has a window.

        Args:
            mode: `human` or `rgb_array`, for older scripts; by default the environment's `render_mode`, or
                `rgb_array` if that is None.
        """
        if (mode or self.render_mode or "rgb_array") != "rgb_array":
            return None
        width, height = self.picture_size
        if self._p is None:
            return np.full((height, width, 3), 255, np.uint8)
        distance, yaw, pitch = self._camera
        view = self._p.computeViewMatrixFromYawPitchRoll(self._looked_at(), distance, yaw, pitch, 0.0, 2)
        projection = self._p.computeProjectionMatrixFOV(60.0, width / height, 0.1, 100.0)
        picture = self._p.getCameraImage(width, height, view, projection)[2]
        return np.reshape(picture, (height, width, -1))[:, :, :3].astype(np.uint8)

    def close(self) -> None:
        """Closes the world; the next `reset` makes a new one."""
        if self._p is not None:
            self._p.disconnect()
            self._p = None


class Camera:
    """Camera of the viewer."""

    def __init__(self, env: MJCFBaseBulletEnv) -> None:
        self._env = ref(env)

    @property
    def env(self) -> MJCFBaseBulletEnv:
        """The environment, which has the camera."""
        env = self._env()
        if env is None:
            raise ReferenceError("the environment of this camera is gone")
        return env

    def move_and_look_at(self, i: float, j: float, k: float, x: float, y: float, z: float) -> None:
        """Looks at (x, y, z) [m] from the same distance and direction as before."""
        seen = self.env._p.getDebugVisualizerCamera()
        self.env._p.resetDebugVisualizerCamera(seen[10], seen[8], seen[9], [x, y, z])


class MJCFBaseBulletEnv(BulletEnv):
    """An environment of a robot in a scene; subclasses define `create_single_player_scene` and `step`.

    Attributes:
        robot: The robot.
        scene: The scene, from the first `reset` on.
        camera: Camera of the viewer.
        physicsClientId: The connection, -1 while there is none.
        isRender: Whether there is a window.
        stateId: Id of the saved state at the start of the first episode, -1 while there is none.
        potential: Result of the robot's `calc_potential` after the last step.
        rewards: The terms of the last reward.
        restores: Whether each later episode starts by restoring that saved state.
    """

    restores = False
    rewards: list[float]
    potential: float

    def __init__(self, robot: Any, render: bool = False, render_mode: str | None = None) -> None:
        """Makes an environment.

        Args:
            robot: The robot, a `pybullet_envs.robot_bases.XmlBasedRobot`.
            render: Whether to open a window, as `render_mode="human"` does.
            render_mode: `human`, `rgb_array` or none.
        """
        super().__init__(render, render_mode)
        self.robot = robot
        self.scene: Any = None
        self.stateId = self.physicsClientId = -1
        self.isRender = self.render_mode == "human"
        self.camera = Camera(self)
        self.action_space = robot.action_space
        self.observation_space = robot.observation_space

    def configure(self, args: Any) -> None:
        """Hands the robot arguments of its own."""
        self.robot.args = args

    def create_single_player_scene(self, bullet_client: Any) -> Any:
        """The scene, a `pybullet_envs.scene_abstract.Scene`."""
        raise NotImplementedError(f"{type(self).__name__} has no create_single_player_scene")

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        if self._connect():
            self.physicsClientId = self._p._client
            self._p.setPhysicsEngineParameter(deterministicOverlappingPairs=1)
        elif self.stateId >= 0:
            self._p.restoreState(self.stateId)
        if self.scene is None:
            self.scene = self.create_single_player_scene(self._p)
        self.scene.episode_restart(self._p)
        self.robot.scene = self.scene
        self.robot.np_random = self.np_random
        self._scene_is_set()
        state = self.robot.reset(self._p)
        self.potential = self.robot.calc_potential()
        if self.restores and self.stateId < 0:
            self.stateId = self._p.saveState()
        return state, {}

    def _scene_is_set(self) -> None:
        """Called by `reset` after the scene is set up and before the robot; for subclasses."""

    def HUD(self, state: Any, a: Any, done: bool) -> None:
        """Called at every step; does nothing."""

    def camera_adjust(self) -> None:
        """Moves the viewer's camera with the robot; does nothing here."""

    def _looked_at(self) -> Place:
        place = getattr(self.robot, "body_real_xyz", (0.0, 0.0, 0.0))
        return float(place[0]), float(place[1]), float(place[2])

    def close(self) -> None:
        """Closes the world; the next `reset` makes a new one."""
        super().close()
        self.robot.forget()
        self.scene = None
        self.stateId = self.physicsClientId = -1


def checked(action: Any) -> np.ndarray:
    """The action, clipped to -1 and 1.

    Raises:
        ValueError: A number is not finite.
    """
    values = np.asarray(action, dtype=float)
    if not np.isfinite(values).all():
        raise ValueError(f"the action {action!r} has a number that is not finite")
    return np.clip(values, -1.0, 1.0)
