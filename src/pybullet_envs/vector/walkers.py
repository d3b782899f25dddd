"""Vector environments in which robots learn to run."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

import numpy as np

from carom.checks import Array
from carom.vector.rotations import euler_from_quaternions
from carom.worlds.chosen import Mask
from pybullet_envs.gym_locomotion_envs import (
    AntBulletEnv,
    HalfCheetahBulletEnv,
    HopperBulletEnv,
    HumanoidBulletEnv,
    Walker2DBulletEnv,
)
from pybullet_envs.robot_walker import LARGEST_OBSERVED, LARGEST_START, NEAR_LIMIT
from pybullet_envs.vector.base import BulletVectorEnv, held
from pybullet_envs.vector.parts import Joints, Middle, Part

# Number of values for the body in an observation; those of joints and feet come after them.
_OF_BODY = 8


class WalkerVectorEnv(BulletVectorEnv):
    """Robots that learn to run to a goal; see `pybullet_envs.gym_locomotion_envs.WalkerBaseBulletEnv`.

    Attributes:
        feet_contact: Whether each foot was on the ground before the last step, (num_envs, feet).
        initial_z: Height of the bodies at the start [m], (num_envs,).
        heights: Heights of the bodies above the ground, as observed [m], (num_envs,).
        rpy: Roll, pitch and yaw of the bodies [rad], (num_envs, 3).
    """

    _single: Any
    _start_height: float | None = None
    """Initial height for observations [m]; None for the true initial height."""

    def __init__(self, num_envs: int = 1, **options: Any) -> None:
        """Makes the environments; see `BulletVectorEnv`."""
        super().__init__(self._single(), num_envs, **options)

    def take(self, single: Any) -> None:
        """Find joints and links, motor torques and costs."""
        robot = single.robot
        self._joints = Joints(self.worlds, robot.ordered_joints)
        self._motors = Joints(self.worlds, robot.motors)
        self._torques = robot.power * np.array([joint.power_coef for joint in robot.motors])
        self._body = Part(self.worlds, robot.robot_body)
        self._middle = Middle(self.worlds, robot.parts.values())
        self._runner = robot.feet[0].body
        ((self._ground, self._ground_link),) = single.ground_ids
        self._foot_columns = np.array([1 + foot.bodyPartIndex for foot in robot.feet])
        self._goal = (robot.walk_target_x, robot.walk_target_y)
        self._step_time = single.scene.dt
        self._costs = (single.electricity_cost, single.stall_torque_cost, single.joints_at_limit_cost)
        self.feet_contact: Mask = np.zeros((self.num_envs, len(robot.feet)), dtype=bool)
        self.initial_z = np.full(self.num_envs, np.nan)

    def begin(self, worlds: np.ndarray) -> None:
        """Randomise the joint angles a little."""
        angles = self.random.uniform(worlds, -LARGEST_START, LARGEST_START, self._joints.count)
        self._joints.put(worlds, angles)
        self.feet_contact[worlds] = False
        height = self._start_height
        self.initial_z[worlds] = self._body.poses()[worlds, 2] if height is None else height

    def act(self, actions: np.ndarray) -> None:
        """Apply torques to the joints; keep potential and foot contacts of the previous step."""
        self._before = self._potential
        # As in PyBullet an observation has the foot contacts of the previous step.
        touching = self.worlds.links_in_contact(self._runner, self._ground, self._ground_link)
        self.feet_contact = touching[:, self._foot_columns]
        self._motors.push(self._torques * held(actions))

    def observe(self) -> np.ndarray:
        """The observations of `WalkerBase`, (num_envs, size of an observation)."""
        count = self._joints.count
        whole = np.empty((self.num_envs, _OF_BODY + 2 * count + self.feet_contact.shape[1]), np.float32)
        self._observe_body(whole)
        joints = whole[:, _OF_BODY : _OF_BODY + 2 * count]
        joints[:, ::2] = self._joints.relative()
        joints[:, 1::2] = 0.1 * self._joints.velocities()
        self._rates = joints[:, 1::2].copy()
        self._at_limit = np.count_nonzero(np.abs(joints[:, ::2]) > NEAR_LIMIT, axis=1)
        whole[:, _OF_BODY + 2 * count :] = self.feet_contact
        np.clip(whole, -LARGEST_OBSERVED, LARGEST_OBSERVED, out=whole)
        self.heights = whole[:, 0] + self.initial_z
        return whole

    def _observe_body(self, whole: np.ndarray) -> None:
        """Fill in the values of the body, and compute the potential of the goal."""
        poses = self._body.poses()
        self.rpy = euler_from_quaternions(poses[:, 3:])
        yaw = self.rpy[:, 2]
        middle = self._middle.positions()
        dx, dy = self._goal[0] - middle[:, 0], self._goal[1] - middle[:, 1]
        self._potential = -np.hypot(dx, dy) / self._step_time
        aside = np.arctan2(dy, dx) - yaw
        vx, vy, vz = self._body.velocities().T
        cosine, sine = np.cos(yaw), np.sin(yaw)
        whole[:, 0] = poses[:, 2] - self.initial_z
        whole[:, 1] = np.sin(aside)
        whole[:, 2] = np.cos(aside)
        whole[:, 3] = 0.3 * (cosine * vx + sine * vy)
        whole[:, 4] = 0.3 * (cosine * vy - sine * vx)
        whole[:, 5] = 0.3 * vz
        whole[:, 6:_OF_BODY] = self.rpy[:, :2]

    def reward(self, actions: np.ndarray) -> Array:
        """Alive bonus and progress, minus costs of effort and of joints at their limits."""
        self._alive = np.where(self.standing(), self.alive_bonus, -1.0)
        electricity, stall, limits = self._costs
        work = electricity * np.abs(actions * self._rates).mean(axis=1)
        effort = work + stall * np.square(actions).mean(axis=1)
        return self._alive + (self._potential - self._before) + effort + limits * self._at_limit

    alive_bonus = 1.0
    """The reward of a step in which the robot stands; it is -1 otherwise."""

    @abstractmethod
    def standing(self) -> Mask:
        """Where the robot has not failed, (num_envs,)."""

    def terminated(self) -> Mask:
        """Where the robot has failed."""
        return self._alive < 0.0


class HopperVectorEnv(WalkerVectorEnv):
    """Hoppers with one leg."""

    _single = HopperBulletEnv

    def standing(self) -> Mask:
        """Where the robot is upright."""
        return (self.heights > 0.8) & (np.abs(self.rpy[:, 1]) < 1.0)


class Walker2DVectorEnv(HopperVectorEnv):
    """Bipeds in a plane."""

    _single = Walker2DBulletEnv


class HalfCheetahVectorEnv(WalkerVectorEnv):
    """Runners with two legs in a plane. A fall is penalised, but does not end the episode."""

    _single = HalfCheetahBulletEnv

    def take(self, single: Any) -> None:
        """Find also the links that must not touch the ground."""
        super().take(single)
        self._not_feet = [k for k, name in enumerate(single.robot.foot_list) if not name.endswith("foot")]

    def standing(self) -> Mask:
        """Where only feet touch the ground and the body is level enough."""
        fallen = self.feet_contact[:, self._not_feet].any(axis=1)
        return (np.abs(self.rpy[:, 1]) < 1.0) & ~fallen

    def terminated(self) -> Mask:
        """No environment."""
        return np.zeros(self.num_envs, dtype=bool)


class AntVectorEnv(WalkerVectorEnv):
    """Quadrupeds: four legs around a sphere."""

    _single = AntBulletEnv

    def standing(self) -> Mask:
        """Where the sphere is off the ground."""
        return self.heights > 0.26


class HumanoidVectorEnv(WalkerVectorEnv):
    """Humanoids."""

    _single = HumanoidBulletEnv
    _start_height = 0.8
    alive_bonus = 2.0

    def standing(self) -> Mask:
        """Where the robot is upright."""
        return self.heights > 0.78
