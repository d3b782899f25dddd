"""Vector environments with arms that reach and push."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.checks import Array
from pybullet_envs.gym_manipulator_envs import (
    COUNTED,
    INSIDE,
    STALL,
    WELL_INSIDE,
    WORK,
    PusherBulletEnv,
    ReacherBulletEnv,
)
from pybullet_envs.robot_manipulators import TORQUE, TURN
from pybullet_envs.vector.base import BulletVectorEnv, held
from pybullet_envs.vector.parts import Joints, Part


class ReacherVectorEnv(BulletVectorEnv):
    """Arms of two links that move their tips to targets; see `pybullet_envs.gym_manipulator_envs`."""

    def __init__(self, num_envs: int = 1, **options: Any) -> None:
        """Makes the environments; see `BulletVectorEnv`."""
        super().__init__(ReacherBulletEnv(), num_envs, **options)

    def take(self, single: Any) -> None:
        """Find links and targets."""
        robot = single.robot
        self._links = Joints(self.worlds, [robot.central_joint, robot.elbow_joint])
        self._target = Joints(self.worlds, [robot.jdict["target_x"], robot.jdict["target_y"]])
        self._tip, self._aim = Part(self.worlds, robot.fingertip), Part(self.worlds, robot.target)
        self._reach = robot.TARG_LIMIT

    def begin(self, worlds: np.ndarray) -> None:
        """Randomise the positions of targets and links."""
        reach = np.array([self._reach, self._reach, TURN, TURN])
        places = self.random.uniform(worlds, -reach, reach)
        self._target.put(worlds, places[:, :2])
        self._links.put(worlds, places[:, 2:])

    def act(self, actions: np.ndarray) -> None:
        """Apply torques to both joints."""
        self._before = self._potential
        self._links.push(TORQUE * held(actions))

    def observe(self) -> np.ndarray:
        """The observations, see `pybullet_envs.robot_manipulators.Reacher`."""
        angles = self._links.between_limits()
        self._rates = 0.1 * self._links.velocities()
        self._bend = angles[:, 1]
        away = self._tip.poses()[:, :3] - self._aim.poses()[:, :3]
        self._potential = -100.0 * np.linalg.norm(away, axis=1)
        whole = np.empty((self.num_envs, 9), np.float32)
        whole[:, :2] = self._target.positions()
        whole[:, 2:4] = away[:, :2]
        whole[:, 4] = np.cos(angles[:, 0])
        whole[:, 5] = np.sin(angles[:, 0])
        whole[:, 6] = self._rates[:, 0]
        whole[:, 7] = self._bend
        whole[:, 8] = self._rates[:, 1]
        return whole

    def reward(self, actions: np.ndarray) -> Array:
        """100 times the decrease of the distance [m], minus costs of effort and of a joint at its limit."""
        pushes = np.abs(actions)
        effort = WORK * np.abs(actions * self._rates).sum(axis=1) + STALL * pushes.sum(axis=1)
        stuck = np.where(np.abs(np.abs(self._bend) - 1.0) < 0.01, 0.1, 0.0)
        return (self._potential - self._before) - effort - stuck


class PusherVectorEnv(BulletVectorEnv):
    """Arms that push cylinders to discs; see `pybullet_envs.gym_manipulator_envs.PusherBulletEnv`."""

    def __init__(self, num_envs: int = 1, **options: Any) -> None:
        """Makes the environments; see `BulletVectorEnv`."""
        super().__init__(PusherBulletEnv(), num_envs, **options)

    def take(self, single: Any) -> None:
        """Find the arm, the object and the target."""
        robot = single.robot
        self._joints = Joints(self.worlds, robot.ordered_joints)
        self._arm = Joints(self.worlds, robot.arm)
        self._counted = Joints(self.worlds, [robot.jdict[name] for name in COUNTED])
        self._slides = {
            thing: Joints(self.worlds, [robot.jdict[f"{thing}_{axis}"] for axis in "xy"])
            for thing in ("target", "object")
        }
        self._parts = [Part(self.worlds, part) for part in (robot.fingertip, robot.object, robot.target)]
        self._origin = robot.zero_offset[:2]
        self._to_target = np.zeros((self.num_envs, 2))

    def begin(self, worlds: np.ndarray) -> None:
        """Randomise the positions of arms, objects and targets."""
        drawn = self.random.draw(worlds, _draw)
        target, thing = _around(drawn[:, :2], drawn[:, :2], drawn[:, 2]), drawn[:, 3:5]
        thing = _around(thing, thing - target, drawn[:, 5])
        self._slides["target"].put(worlds, target - self._origin)
        self._slides["object"].put(worlds, thing - self._origin)
        self._arm.put(worlds, drawn[:, 6:])
        self._to_target[worlds] = target - thing

    def act(self, actions: np.ndarray) -> None:
        """Apply torques to the joints."""
        self._arm.push(TORQUE * held(actions))

    def observe(self) -> np.ndarray:
        """The observations, see `pybullet_envs.robot_manipulators.SevenJointArm`."""
        count = self._joints.count
        positions, velocities = self._joints.positions(), self._joints.velocities()
        self._relative = self._joints.between_limits()
        whole = np.empty((self.num_envs, 4 * count + 11), np.float32)
        whole[:, : 2 * count : 2] = positions
        whole[:, 1 : 2 * count : 2] = velocities
        whole[:, 2 * count : 4 * count : 2] = self._relative
        whole[:, 2 * count + 1 : 4 * count : 2] = 0.1 * velocities
        whole[:, 4 * count : 4 * count + 2] = self._to_target
        for number, part in enumerate(self._parts):
            first = 4 * count + 2 + 3 * number
            whole[:, first : first + 3] = part.poses()[:, :3]
        return whole

    def reward(self, actions: np.ndarray) -> Array:
        """Minus the effort and, as in PyBullet, minus 0.1 for each joint within its limits."""
        work = np.einsum("ij,ij->i", np.abs(actions), np.abs(self._counted.velocities()))
        inside = np.count_nonzero(np.abs(self._relative) < WELL_INSIDE, axis=1)
        return -(WORK * work + STALL * actions.sum(axis=1)) - INSIDE * inside


def _draw(generator: np.random.Generator) -> np.ndarray:
    """Random numbers for an episode of one environment, in the order of the single environment."""
    target = generator.uniform(-1.0, 1.0, size=2), generator.uniform(0.5, 0.8)
    thing = generator.uniform(-1.0, 1.0, size=2), generator.uniform(0.1, 0.4)
    return np.array([*target[0], target[1], *thing[0], thing[1], *generator.uniform(-TURN, TURN, size=7)])


def _around(ways: Array, measured: Array, distances: Array) -> Array:
    """Vectors `ways` (n, 2), divided by the lengths of `measured` (n, 2), times distances (n,)."""
    return ways / np.linalg.norm(measured, axis=1)[:, None] * distances[:, None]
