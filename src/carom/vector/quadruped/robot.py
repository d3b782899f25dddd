"""The quadruped and its ground: what terms of its tasks are computed from, and its actions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import pybullet_data
from carom.camera import Camera
from carom.checks import Array
from carom.vector.managers import ManagerEnv, Task
from carom.vector.quadruped.terrain import KINDS, random_terrain
from carom.vector.rotations import turned
from carom.world.world import World
from carom.worlds.chosen import Mask

_TIME_STEP, _STEPS = 1.0 / 200.0, 4
_LEGS = ("FR", "FL", "RR", "RL")
_HOME = np.tile([0.0, 0.8, -1.6], len(_LEGS))
_TURN, _LIMIT = 0.35, 2.0
"""Change of a joint's target by an action of 1 [rad], and the greatest action."""
_GAIT = 1.8
"""Strides of the clock per second."""
_PHASES = np.array([0.0, 0.5, 0.5, 0.0])
_LIFT = np.array([0.0, 0.3, -0.6])
"""How far the joints of a leg bend in the middle of the time that its foot is in the air [rad]."""
_START = 0.33
"""Height of the trunk above the ground at the start [m]."""
_FOOT = 0.02
_SCAN_X, _SCAN_Y = np.linspace(-0.45, 0.45, 7), np.linspace(-0.3, 0.3, 5)
"""Where the ground is measured, in front of and to the left of the trunk [m]."""


class QuadrupedRobot(ManagerEnv):
    """An A1 on random terrain, on which tasks of its own kind are put together.

    Args:
        num_envs: Number of environments.
        task: The terms.
        seed_of_terrain: The same seed gives the same ground.
        **options: As for `WorldsEnv`.
    """

    def __init__(self, num_envs: int, task: Task, *, seed_of_terrain: int, **options: Any) -> None:
        self.terrain = random_terrain(seed_of_terrain)
        # PyBullet's contacts, with which policies of this task were trained, and which GPUs have.
        world = World(time_step=_TIME_STEP, contact="bullet")
        world.gravity = (0.0, 0.0, -9.81)
        self._ground_body = world.load(self.terrain.body())
        # Carom's own, whatever `getDataPath` serves: the task is the same for everyone.
        assets = Path(pybullet_data.__file__).parent
        self._robot_body = world.load_urdf(assets / "a1" / "a1.urdf", (0.0, 0.0, _START))
        action = np.full(len(_HOME), _LIMIT, np.float32)
        options.setdefault("steps", _STEPS)
        options.setdefault(
            "camera", Camera.with_field_of_view(480, 320, 50.0).look_at((-17, -12, 6), (-12, 0, 0))
        )
        super().__init__(world, num_envs, gymnasium.spaces.Box(-action, action), task, **options)
        # Nobody else has its bodies.
        world.let_go()

    def prepare(self) -> None:
        """Find the parts of the robot, and measure it once."""
        self.robot = self.worlds[self._robot_body]
        names = self.robot.links.names[1:]
        self.feet = [f"{leg}_toe" for leg in _LEGS]
        self.home: Array = _HOME.copy()
        self.kind_count: int = len(KINDS)
        self.trunk_mass = float(self.robot.dynamics("trunk")["mass"][0])
        self._trunk_row = names.index("imu_link")
        self._foot_rows = np.array([names.index(foot) for foot in self.feet])
        # `links_in_contact` has the base in front.
        self._leg_rows = np.array(
            [[1 + names.index(f"{leg}_{part}") for part in ("hip", "upper")] for leg in _LEGS]
        )
        self._upright = self.robot.base_inertial_poses[0].copy()
        self.levels = np.zeros(self.num_envs, dtype=np.int64)
        self.kinds = np.zeros(self.num_envs, dtype=np.int64)
        self.stiffness: Array = np.full((self.num_envs, 1), 30.0)
        self.damping: Array = np.full((self.num_envs, 1), 0.8)
        self.walked: Array = np.zeros(self.num_envs)
        self.asked: Array = np.zeros(self.num_envs)
        self._targets: Array = np.tile(_HOME, (self.num_envs, 1))
        self.measure()

    def begin(self, worlds: np.ndarray) -> None:
        """See `ManagerEnv.begin`."""
        super().begin(worlds)
        self.walked[worlds] = self.asked[worlds] = 0.0

    def apply(self, actions: Array) -> None:
        """Set the targets of the joints."""
        lifts = np.sin(2.0 * np.pi * self._phases())[:, :, None] * ~self.wanted_touching()[:, :, None]
        gait = self.home - (lifts * _LIFT).reshape(self.num_envs, -1)
        self._targets[...] = gait + _TURN * np.clip(actions, -_LIMIT, _LIMIT)
        self.robot.joints.set_springs(self._targets, stiffness=self.stiffness, damping=self.damping)

    def simulate(self) -> None:
        """Take a step; note how far the robots walk, and how far they should."""
        command = self.commands["velocity"][:, :2]
        before = self.robot.base_inertial_poses[:, :2].copy()
        flat = np.concatenate([command, np.zeros((self.num_envs, 1))], axis=1)
        ahead = turned(self.trunks[:, 3:], flat)[:, :2]
        super().simulate()
        speed = np.sqrt(np.square(command).sum(axis=1))
        moved = self.robot.base_inertial_poses[:, :2] - before
        self.walked += (moved * ahead).sum(axis=1) / np.maximum(speed, 1e-6)
        self.asked += speed * self.duration

    def observe(self) -> Any:
        """The observations of all terms, side by side."""
        self.measure()
        return super().observe()

    def measure(self) -> None:
        """Compute what the terms need of the present state."""
        poses = self.robot.links.poses
        self.trunks: Array = poses[:, self._trunk_row].copy()
        """Poses of the trunk's frame, (num_envs, 7)."""
        back = self.trunks[:, 3:] * np.array([-1.0, -1.0, -1.0, 1.0])
        moving = self.robot.base_velocities
        self.velocities: Array = turned(back, moving[:, :3])
        """Velocity of the trunk in its own axes [m/s], (num_envs, 3)."""
        self.rates: Array = turned(back, moving[:, 3:])
        """Angular velocity of the trunk in its own axes [rad/s], (num_envs, 3)."""
        self.gravity: Array = turned(back, np.tile([0.0, 0.0, -1.0], (self.num_envs, 1)))
        """Direction of gravity in the axes of the trunk, (num_envs, 3)."""
        feet = poses[:, self._foot_rows, :3]
        self.foot_heights: Array = feet[..., 2] - self.terrain.height(feet[..., :2]) - _FOOT
        """Heights of the feet above the ground [m], (num_envs, 4)."""
        self.ground: Array = self.terrain.height(self._scanned())
        """Heights of the ground around the robot [m], (num_envs, n)."""
        found = self.worlds.links_in_contact(self._robot_body, self._ground_body)
        self.touching: Mask = found[:, 1 + self._foot_rows]
        """Which feet touch the ground, (num_envs, 4)."""
        self.bumping: Mask = np.logical_or.reduce(found[:, self._leg_rows], axis=2)
        """Which legs touch it with the hip or the thigh, (num_envs, 4)."""
        self.trunk_touching: Mask = found[:, 0].copy()
        """Whether the trunk touches it, (num_envs,)."""

    def _scanned(self) -> Array:
        """Where the ground is measured, (num_envs, n, 2): a grid that turns with the heading."""
        x, y, z, w = self.trunks[:, 3:].T
        cosine, sine = w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z)
        length = np.maximum(np.sqrt(cosine * cosine + sine * sine), 1e-9)
        cosine, sine = (cosine / length)[:, None], (sine / length)[:, None]
        ahead, aside = (part.reshape(-1) for part in np.meshgrid(_SCAN_X, _SCAN_Y, indexing="ij"))
        turned_grid = np.stack([cosine * ahead - sine * aside, sine * ahead + cosine * aside], axis=-1)
        return self.trunks[:, None, :2] + turned_grid

    def stand(self, worlds: np.ndarray, places: Array, turns: Array) -> None:
        """Put robots on the ground at places (n, 2) [m], turned about z [rad] (n,), at rest."""
        half = 0.5 * turns
        zeros = np.zeros(len(worlds))
        turn = np.stack([zeros, zeros, np.sin(half), np.cos(half)], axis=1)
        first = np.tile(self._upright[3:], (len(worlds), 1))
        # The product of the two quaternions: turned about z after standing upright.
        axis = turn[:, 3:] * first[:, :3] + first[:, 3:] * turn[:, :3] + np.cross(turn[:, :3], first[:, :3])
        real = turn[:, 3] * first[:, 3] - (turn[:, :3] * first[:, :3]).sum(axis=1)
        around = places[:, None] + np.array([[0.2, 0.15], [0.2, -0.15], [-0.2, 0.15], [-0.2, -0.15], [0, 0]])
        heights = _START + self.terrain.height(around).max(axis=1)
        orientations = np.concatenate([axis, real[:, None]], axis=1)
        self.robot.set_base_inertial_poses(np.column_stack([places, heights]), orientations, where=worlds)

    def clock(self) -> Array:
        """Sine and cosine of the phase of the stride, (num_envs, 2)."""
        phase = 2.0 * np.pi * _GAIT * self.duration * self.episode_steps
        return np.stack([np.sin(phase), np.cos(phase)], axis=1)

    def wanted_touching(self) -> Mask:
        """Which feet should be on the ground, (num_envs, 4): diagonal pairs in turn; all when standing."""
        standing = np.logical_not(np.any(self.commands["velocity"], axis=1))
        return np.logical_or(self._phases() < 0.5, standing.reshape(-1, 1))

    def _phases(self) -> Array:
        """Phases of the legs in the stride, from 0 to 1, (num_envs, 4); from 0.5 on a foot is in the air."""
        times = self.duration * self.episode_steps.astype(np.float64)
        return np.mod(_GAIT * times[:, None] + _PHASES, 1.0)

    def torques(self) -> Array:
        """Torques of the springs at the end of the step [N m], (num_envs, 12)."""
        bent = self._targets - self.robot.joints.positions
        return self.stiffness * bent - self.damping * self.robot.joints.velocities
