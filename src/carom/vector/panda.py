"""Tasks for a Panda: reach a goal, push a cube to a goal, pick up a cube and hold it at a goal."""

from __future__ import annotations

from abc import abstractmethod
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import pybullet_data
from carom.camera import Camera
from carom.checks import Array
from carom.vector.single import SingleEnv
from carom.vector.worlds_env import WorldsEnv
from carom.world.world import World
from carom.worlds.chosen import Mask

_TIME_STEP, _STEPS = 1.0 / 240.0, 12
_GRAVITY = (0.0, 0.0, -9.81)
_ARM, _FINGERS, _TIP = 7, 2, "panda_grasptarget"
_HOME = np.array([0.0, 0.3, 0.0, -2.1, 0.0, 2.4, 0.785])
_SPREAD = 0.1
"""Maximum deviation of the joints from `_HOME` at the start of an episode [rad]."""
_FARTHEST_TURN = 0.05
"""Change of a joint's target by an action of 1 [rad]."""
_OPEN = 0.04
_NEAR = 0.05
"""Maximum distance that counts as success [m]."""
_HALF_CUBE = 0.025
_STEADY_GAIN, _MAX_VELOCITY = 0.2, 2.0


class PandaTask(WorldsEnv):
    """Base class of the tasks.

    Action: changes of the targets of the seven joints, from -1 to 1, in units of 0.05 rad; if the task needs
    fingers, also their opening, from -1 (closed) to 1 (open).

    Observation: positions and velocities of the joints, opening of the fingers, position of the fingertips,
    position of the goal, the difference of both; in tasks with a cube also the cube's position, its
    difference from the fingertips and the goal's difference from it. Reward: minus the distance to the goal
    (with a cube also minus half the distance from the fingertips to the cube), plus 1 at the goal
    (`infos["success"]`).

    An episode lasts `max_episode_steps`.

    Args:
        num_envs: Number of environments.
        **options: As for `WorldsEnv`.
    """

    _has_cube = True
    _uses_fingers = True
    _lowest_goal: tuple[float, float, float]
    _highest_goal: tuple[float, float, float]

    def __init__(self, num_envs: int = 1, **options: Any) -> None:
        # PyBullet's contacts, with which policies of this task were trained, and which GPUs have.
        world = World(time_step=_TIME_STEP, contact="bullet")
        world.gravity = _GRAVITY
        # Carom's own, whatever `getDataPath` serves: the task is the same for everyone.
        assets = Path(pybullet_data.__file__).parent
        world.load_urdf(assets / "plane.urdf", as_pybullet=True)
        panda = world.load_urdf(assets / "franka_panda" / "panda.urdf", fixed_base=True, as_pybullet=True)
        cube = world.load_urdf(assets / "cube_small.urdf", as_pybullet=True) if self._has_cube else None
        numbers = 2 * _ARM + 1 + 9 + (9 if self._has_cube else 0)
        action = np.ones(_ARM + self._uses_fingers, np.float32)
        endless = np.full(numbers, np.inf, np.float32)
        options.setdefault(
            "camera", Camera.with_field_of_view(320, 240, 50.0).look_at((1.3, -0.9, 0.9), (0.4, 0, 0.2))
        )
        super().__init__(
            world,
            num_envs,
            gymnasium.spaces.Box(-endless, endless),
            gymnasium.spaces.Box(-action, action),
            steps=_STEPS,
            **options,
        )
        # Nobody else has its bodies.
        world.let_go()
        self._panda = self.worlds[panda]
        self._cube = None if cube is None else self.worlds[cube]
        self._tip_row = self._panda.links.names[1:].index(_TIP)
        self._lower, self._upper = (limits[:, :_ARM] for limits in self._panda.joints.limits)
        self._wanted = np.zeros((num_envs, _ARM + _FINGERS))
        self.goals = np.zeros((num_envs, 3))

    def begin(self, worlds: np.ndarray) -> None:
        """Choose random positions of the joints, the cube and the goal."""
        turns = self.random.uniform(worlds, -_SPREAD, _SPREAD, _ARM)
        opening = _OPEN if self._uses_fingers else 0.0
        pose = np.concatenate([_HOME + turns, np.full((len(worlds), _FINGERS), opening)], axis=1)
        self._wanted[worlds] = self._panda.joints.positions[worlds] = pose
        self.goals[worlds] = self.random.uniform(
            worlds, np.array(self._lowest_goal), np.array(self._highest_goal)
        )
        if self._cube is not None:
            places = self.random.uniform(worlds, np.array([0.4, -0.2]), np.array([0.6, 0.2]))
            on_floor = np.column_stack([places, np.full(len(worlds), _HALF_CUBE)])
            self._cube.set_base_inertial_poses(on_floor, where=worlds)

    def act(self, actions: np.ndarray) -> None:
        """Change the position targets of the joints."""
        held = np.clip(actions, -1.0, 1.0)
        arm = self._wanted[:, :_ARM]
        np.clip(arm + _FARTHEST_TURN * held[:, :_ARM], self._lower, self._upper, out=arm)
        if self._uses_fingers:
            self._wanted[:, _ARM:] = 0.5 * _OPEN * (held[:, _ARM:] + 1.0)
        self._panda.joints.set_position_targets(
            self._wanted, gains=_STEADY_GAIN, max_velocities=_MAX_VELOCITY
        )

    def observe(self) -> np.ndarray:
        """The observations, as described in `PandaTask`."""
        positions = self._panda.joints.positions
        self._tips = self._panda.links.poses[:, self._tip_row, :3]
        parts = [
            positions[:, :_ARM],
            self._panda.joints.velocities[:, :_ARM],
            positions[:, _ARM:].sum(axis=1, keepdims=True),
            self._tips,
            self.goals,
            self.goals - self._tips,
        ]
        if self._cube is not None:
            self._places = self._cube.base_inertial_poses[:, :3]
            parts += [self._places, self._places - self._tips, self.goals - self._places]
        return np.concatenate(parts, axis=1, dtype=np.float32, casting="same_kind")

    def reward(self, actions: np.ndarray) -> Array:
        """The rewards, as described in `PandaTask`."""
        away = np.linalg.norm(self.goals - self.moved(), axis=1)
        self._success: Mask = away < _NEAR
        reward = self._success - away
        if self._cube is not None:
            reward -= 0.5 * np.linalg.norm(self._places - self._tips, axis=1)
        return reward

    def infos(self) -> dict[str, Any]:
        """A mask of the environments in which the goal is reached, as `success`."""
        return {"success": self._success.copy()}

    @abstractmethod
    def moved(self) -> Array:
        """Position of the fingertips or cube that has to reach the goal [m], (num_envs, 3)."""


class PandaReach(PandaTask):
    """The fingertips have to reach a point in the air."""

    _has_cube = _uses_fingers = False
    _lowest_goal, _highest_goal = (0.35, -0.25, 0.1), (0.65, 0.25, 0.5)

    def moved(self) -> Array:
        """Positions of the fingertips."""
        return self._tips


class PandaPush(PandaTask):
    """A cube has to be pushed to a point on the floor; the fingers stay closed."""

    _uses_fingers = False
    _lowest_goal, _highest_goal = (0.4, -0.25, _HALF_CUBE), (0.7, 0.25, _HALF_CUBE)

    def moved(self) -> Array:
        """Positions of the cube."""
        return self._places


class PandaPick(PandaTask):
    """A cube has to be held at a point in the air."""

    _lowest_goal, _highest_goal = (0.4, -0.2, 0.1), (0.6, 0.2, 0.3)

    def moved(self) -> Array:
        """Positions of the cube."""
        return self._places


single_PandaReach, single_PandaPush, single_PandaPick = (
    partial(SingleEnv, task) for task in (PandaReach, PandaPush, PandaPick)
)
"""Single environments of the three tasks, for `gymnasium.make`."""
