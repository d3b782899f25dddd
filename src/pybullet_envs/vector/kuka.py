"""Vector environments with KUKA arms that grasp blocks.

The worlds are stepped together. Inverse kinematics and distances between shapes exist for one world only:
the single environment computes them, for one world after the other.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import pybullet as p
from carom.checks import Array
from carom.description.pose import Pose
from carom.description.transform import compose
from carom.model.body_spec import BASE
from carom.vector.rotations import euler_from_quaternions, turned
from carom.worlds.chosen import Mask
from pybullet_envs.bullet.kuka import (
    GRIPPER,
    LEFT_FINGER,
    LEFT_TIP,
    REACH_X,
    REACH_Y,
    RIGHT_FINGER,
    RIGHT_TIP,
    WRIST,
)
from pybullet_envs.bullet.kukaGymEnv import (
    BLOCK_HIGH,
    CHOICES,
    CLOSING_RISE,
    CLOSING_STEPS,
    FINGER_OPEN,
    GRASP_DISTANCE,
    LIFTING_RISE,
    LIFTING_STEPS,
    SINK,
    WRIST_HIGH,
    KukaGymEnv,
)
from pybullet_envs.vector.base import BulletVectorEnv, world_of

_ARM: list[int | str] = list(range(WRIST + 1))
_HAND: list[int | str] = [GRIPPER, LEFT_FINGER, LEFT_TIP, RIGHT_FINGER, RIGHT_TIP]
_ARM_GAIN = 0.3
_FAR, _NOWHERE = 1000.0, -1000.0
_CLOSENESS = 10.0


class _Unsettled(KukaGymEnv):
    """A single environment without the first step of an episode, which `begin` makes."""

    def _settle(self) -> None:
        pass


class KukaVectorEnv(BulletVectorEnv):
    """Grippers that move down to trays; see `pybullet_envs.bullet.kukaGymEnv.KukaGymEnv`.

    Args:
        num_envs: Number of environments.
        actionRepeat: Number of simulation steps per environment step.
        isDiscrete: Whether an action is one of 7 choices.
        maxSteps: Number of steps after which an episode ends.
        **options: Other arguments of `BulletVectorEnv`.
    """

    _asks = True

    def __init__(
        self,
        num_envs: int = 1,
        *,
        actionRepeat: int = 1,
        isDiscrete: bool = False,
        maxSteps: int = 1000,
        **options: Any,
    ) -> None:
        self._repeat, self._discrete, self._longest = actionRepeat, isDiscrete, maxSteps
        super().__init__(_Unsettled(isDiscrete=isDiscrete), num_envs, **options)

    def take(self, single: Any) -> None:
        """Find arm and block, and the forces of the motors."""
        self._single, self._asked = single, world_of(single)
        kuka = self._kuka = single._kuka
        self._arm, self._block = self.worlds[kuka.kukaUid], self.worlds[single.blockUid]
        self._joints, self._hand = self._arm.joints[_ARM], self._arm.joints[_HAND]
        self._low, self._high = np.array(single._block_ranges).T
        count = self.num_envs
        self._places = np.zeros((count, 3))
        self._targets, self._grips = np.zeros((count, len(_ARM))), np.zeros((count, len(_HAND)))
        self._hand_forces = np.array(
            [kuka.maxForce, kuka.fingerAForce, kuka.fingerTipForce, kuka.fingerBForce, kuka.fingerTipForce]
        )
        self._steps_taken = np.zeros(count, dtype=np.int64)
        self._grasped: Mask = np.zeros(count, dtype=bool)
        self._start_place = np.array(kuka.endEffectorPos)

    def begin(self, worlds: np.ndarray) -> None:
        """Place the blocks at random on the trays, and make the first step."""
        drawn = self.random.uniform(worlds, self._low, self._high)
        poses = [self._block_pose(x, y, yaw) for x, y, yaw in drawn.tolist()]
        places, turns = [pose.position for pose in poses], [pose.orientation for pose in poses]
        self._block.set_base_inertial_poses(places, turns, worlds)
        self._places[worlds] = self._start_place
        self._grips[worlds] = 0.0
        self._steps_taken[worlds] = 0
        self._grasped[worlds] = False
        self.worlds.step(where=worlds)

    def _block_pose(self, x: float, y: float, yaw: float) -> Pose:
        """Exact pose of the block's inertial frame when the block is loaded at (x, y)."""
        height, turn = self._single._block_height, p.getQuaternionFromEuler([0, 0, yaw])
        frame = self._asked.bodies[self._single.blockUid].link_inertial_frame(BASE)
        return compose(Pose((x, y, height), turn), frame)

    def act(self, actions: np.ndarray) -> None:
        """Keep the commands of the grippers for this step."""
        ways = np.array(CHOICES, dtype=np.float64)[actions] if self._discrete else actions
        self._commands = np.empty((self.num_envs, 5))
        self._commands[:, :2] = self._single._step_size * ways[:, :2]
        self._commands[:, 2] = SINK
        self._commands[:, 3] = self._single._turn_size * ways[:, 2]
        self._commands[:, 4] = FINGER_OPEN

    def simulate(self) -> None:
        """Move the grippers; those that reach their trays grasp and lift in the same step."""
        going = np.flatnonzero(~self._grasped)
        for _ in range(self._repeat):
            self._move(going, self._commands[going])
            late = self._steps_taken[going] > self._longest
            there = np.zeros(len(going), dtype=bool)
            for place in np.flatnonzero(~late):
                there[place] = self._at_tray(int(going[place]))
            if there.any():
                self._grasped[going[there]] = True
                self._grasp(going[there])
            going = going[~late & ~there]
            self._steps_taken[going] += 1
            if not len(going):
                break

    def _move(self, worlds: np.ndarray, commands: Array) -> None:
        """Apply commands as `Kuka.applyAction` does, and make a simulation step, in some worlds."""
        places = self._places[worlds] + commands[:, :3]
        places[:, 0] = np.clip(places[:, 0], *REACH_X)
        places[:, 1] = np.clip(places[:, 1], *REACH_Y)
        self._places[worlds] = places
        for world, place in zip(worlds.tolist(), places.tolist(), strict=True):
            self.worlds.copy_coordinates(world, self._asked)
            self._targets[world] = self._kuka.joints_for(place)[: len(_ARM)]
        fingers = commands[:, 4]
        self._grips[worlds, 0] += commands[:, 3]
        self._grips[worlds, 1], self._grips[worlds, 3] = -fingers, fingers
        self._joints.set_position_targets(
            self._targets,
            gains=_ARM_GAIN,
            max_forces=self._kuka.maxForce,
            max_velocities=self._kuka.maxVelocity,
        )
        self._hand.set_position_targets(self._grips, max_forces=self._hand_forces)
        self.worlds.step(where=worlds)

    def _at_tray(self, world: int) -> bool:
        self.worlds.copy_coordinates(world, self._asked)
        kuka = self._kuka
        return bool(self._single._p.getClosestPoints(kuka.trayUid, kuka.kukaUid, GRASP_DISTANCE))

    def _grasp(self, worlds: np.ndarray) -> None:
        """Close the fingers and lift, until the block or the wrist is high enough."""
        for step in range(CLOSING_STEPS):
            finger = FINGER_OPEN * (1.0 - step / CLOSING_STEPS)
            self._move(worlds, np.tile([0.0, 0.0, CLOSING_RISE, 0.0, finger], (len(worlds), 1)))
        for _ in range(LIFTING_STEPS):
            self._move(worlds, np.tile([0.0, 0.0, LIFTING_RISE, 0.0, 0.0], (len(worlds), 1)))
            blocks = self._block.base_inertial_poses[worlds, 2]
            wrists = self._arm.links.stepped_poses[worlds, WRIST, 2]
            worlds = worlds[(blocks <= BLOCK_HIGH) & (wrists <= WRIST_HIGH)]
            if not len(worlds):
                return

    def observe(self) -> np.ndarray:
        """Position, roll, pitch and yaw of the gripper; x, y and yaw of the block in the gripper's frame."""
        gripper, block = self._arm.links.stepped_poses[:, GRIPPER], self._block.base_inertial_poses
        whole = np.empty((self.num_envs, 9), np.float32)
        whole[:, :3] = gripper[:, :3]
        whole[:, 3:6] = euler_from_quaternions(gripper[:, 3:])
        back = gripper[:, 3:] * (-1.0, -1.0, -1.0, 1.0)
        whole[:, 6:8] = turned(back, block[:, :3] - gripper[:, :3])[:, :2]
        whole[:, 8] = euler_from_quaternions(_product(back, block[:, 3:]))[:, 2]
        return whole

    def reward(self, actions: np.ndarray) -> Array:
        """-10 times the distance of block and wrist, minus a cost of turning, plus a bonus for lifting."""
        single = self._single
        rewards = np.array([self._closeness(world) for world in range(self.num_envs)])
        rewards[self._block.base_inertial_poses[:, 2] > single._lifted_height] += single._success
        return rewards - single._turn_cost * np.abs(self._commands[:, 3])

    def _closeness(self, world: int) -> float:
        self.worlds.copy_coordinates(world, self._asked)
        block, arm = self._single.blockUid, self._kuka.kukaUid
        points = self._single._p.getClosestPoints(block, arm, _FAR, -1, WRIST)
        return -_CLOSENESS * points[0][8] if points else _NOWHERE

    def terminated(self) -> Mask:
        """Where the gripper has tried to grasp, or `maxSteps` is exceeded."""
        return self._grasped | (self._steps_taken > self._longest)

    def close_extras(self, **kwargs: Any) -> None:
        """Close the single environment."""
        self._single.close()


def _product(first: Array, second: Array) -> Array:
    """Products of quaternions (n, 4), x, y, z, w."""
    (a, b, c, d), (x, y, z, w) = first.T, second.T
    return np.column_stack(
        [
            d * x + a * w + b * z - c * y,
            d * y - a * z + b * w + c * x,
            d * z + a * y - b * x + c * w,
            d * w - a * x - b * y - c * z,
        ]
    )
