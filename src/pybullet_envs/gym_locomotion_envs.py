"""Robots that learn to run."""

from __future__ import annotations

import os
from abc import abstractmethod
from collections.abc import Mapping
from math import atan2, cos, sin
from typing import Any, ClassVar

import numpy as np

import pybullet_data
from pybullet_envs.env_bases import Place, checked
from pybullet_envs.robot_bases import MJCFEnv

_GOAL = (1e3, 0.0)
"""Where robots run to: a kilometre away [m]."""
_POWER = 100.0
_LARGEST_START = 0.1
_NEAR_LIMIT = 0.99
_LARGEST_OBSERVED = 5.0
_EFFORT, _STALL, _LIMIT = 2.0, 0.1, 0.1
"""What the power of motors, torques at rest and joints at their limits cost."""


class WalkerBaseBulletEnv(MJCFEnv):
    """A robot that is to run along x.

    Observation: height above that at the start; sine and cosine of the angle to the goal; velocity of the
    body in its own heading, times 0.3; roll and pitch; of each joint the position between its limits, from -1
    to 1, and a tenth of its rate; of each foot whether it is on the ground. All within ±5.

    Reward: being alive, coming nearer to the goal, less effort and joints at their limits.

    Attributes:
        power: Torque of an action of one, times that of the joint.
        feet: The links whose contact with the ground is observed.
        joint_power: Torque of joints [N m] that have not 100.
        effort: How much more than usual effort costs.
    """

    robot_name = "torso"
    time_step, frame_skip = 0.0165 / 4, 4
    power: float
    feet: ClassVar[tuple[str, ...]]
    joint_power: ClassVar[Mapping[str, float]] = {}
    effort = 1.0

    def _load(self) -> None:
        super()._load()
        self._joints = list(self.parts.motors)
        ground = self._p.loadSDF(os.path.join(pybullet_data.getDataPath(), "plane_stadium.sdf"))
        for body in ground:
            self._p.changeDynamics(body, -1, lateralFriction=0.8, restitution=0.5)
        self.parts.add(ground)
        floor = self.parts.links["floor"]
        self._ground = {(floor.body, floor.link)}

    def _place(self) -> None:
        for name in self._joints:
            self.parts.motors[name].place(self.np_random.uniform(-_LARGEST_START, _LARGEST_START))
        self._on_ground = np.zeros(len(self.feet), np.float32)
        self._first_height = self._starting_height()
        self._distance = self._goal()[1]

    def _starting_height(self) -> float:
        return float(self.parts.body.pose()[0][2])

    def _goal(self) -> tuple[float, float]:
        """Direction [rad] and distance [m] of the goal from the middle of all parts."""
        middle = np.mean([part.pose()[0] for part in self.parts.links.values()], axis=0)
        x, y = _GOAL[0] - float(middle[0]), _GOAL[1] - float(middle[1])
        return atan2(y, x), float(np.hypot(x, y))

    def _joint_states(self) -> np.ndarray:
        """(joints, 2) relative positions and rates."""
        return np.array([self.parts.motors[name].relative_state() for name in self._joints], np.float32)

    def _body_angles(self) -> tuple[float, float, float]:
        return self._p.getEulerFromQuaternion(self.parts.body.pose()[1].tolist())

    def _observe(self) -> np.ndarray:
        roll, pitch, yaw = self._body_angles()
        height = float(self.parts.body.pose()[0][2]) - self._first_height
        aside = self._goal()[0] - yaw
        vx, vy, vz = self.parts.body.velocity()
        ahead, across = cos(yaw) * vx + sin(yaw) * vy, cos(yaw) * vy - sin(yaw) * vx
        body = [height, sin(aside), cos(aside), 0.3 * ahead, 0.3 * across, 0.3 * vz, roll, pitch]
        whole = np.concatenate([body, self._joint_states().ravel(), self._on_ground])
        return np.clip(whole, -_LARGEST_OBSERVED, _LARGEST_OBSERVED).astype(np.float32)

    def _drive(self, action: np.ndarray) -> None:
        for name, share in zip(self._joints, action, strict=True):
            self.parts.motors[name].drive(self.power * self.joint_power.get(name, _POWER) * share)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Drives the joints for a step."""
        given = np.asarray(action, dtype=float)
        self._drive(checked(action))
        self._p.stepSimulation()
        # As in PyBullet an observation has the feet of the step before.
        seen = self._observe()
        states = self._joint_states()
        alive = self._alive(float(seen[0]) + self._first_height, self._body_angles()[1])
        before, self._distance = self._distance, self._goal()[1]
        progress = (before - self._distance) / self.frame_time
        effort = _EFFORT * float(np.abs(given * states[:, 1]).mean()) + _STALL * float(
            np.square(given).mean()
        )
        at_limit = _LIMIT * float(np.count_nonzero(np.abs(states[:, 0]) > _NEAR_LIMIT))
        for number, foot in enumerate(self.feet):
            self._on_ground[number] = self.parts.links[foot].touches(self._ground)
        return seen, alive + progress - self.effort * effort - at_limit, alive < 0.0, False, {}

    @abstractmethod
    def _alive(self, height: float, pitch: float) -> float:
        """The reward of being alive; below 0 the episode ends."""

    def _looked_at(self) -> Place:
        x, y, z = self.parts.body.pose()[0].tolist()
        return x, y, z


class HopperBulletEnv(WalkerBaseBulletEnv):
    """One leg."""

    model, power, feet = "hopper.xml", 0.75, ("foot",)
    observation_count, action_count = 15, 3

    def _alive(self, height: float, pitch: float) -> float:
        return 1.0 if height > 0.8 and abs(pitch) < 1.0 else -1.0


class Walker2DBulletEnv(WalkerBaseBulletEnv):
    """Two legs in a plane."""

    model, power, feet = "walker2d.xml", 0.40, ("foot", "foot_left")
    observation_count, action_count = 22, 6
    joint_power: ClassVar[Mapping[str, float]] = {"foot_joint": 30.0, "foot_left_joint": 30.0}

    def _alive(self, height: float, pitch: float) -> float:
        return 1.0 if height > 0.8 and abs(pitch) < 1.0 else -1.0


class HalfCheetahBulletEnv(WalkerBaseBulletEnv):
    """A runner in a plane; nothing but its feet is to touch the ground."""

    model, power = "half_cheetah.xml", 0.90
    feet = ("ffoot", "fshin", "fthigh", "bfoot", "bshin", "bthigh")
    observation_count, action_count = 26, 6
    joint_power: ClassVar[Mapping[str, float]] = {
        "bthigh": 120.0,
        "bshin": 90.0,
        "bfoot": 60.0,
        "fthigh": 140.0,
        "fshin": 60.0,
        "ffoot": 30.0,
    }

    def _alive(self, height: float, pitch: float) -> float:
        _, front_shin, front_thigh, _, back_shin, back_thigh = self._on_ground
        fallen = front_shin or front_thigh or back_shin or back_thigh
        return 1.0 if abs(pitch) < 1.0 and not fallen else -1.0


class AntBulletEnv(WalkerBaseBulletEnv):
    """Four legs around a ball."""

    model, power = "ant.xml", 2.5
    feet = ("front_left_foot", "front_right_foot", "left_back_foot", "right_back_foot")
    observation_count, action_count = 28, 8

    def _alive(self, height: float, pitch: float) -> float:
        return 1.0 if height > 0.26 else -1.0


class HumanoidBulletEnv(WalkerBaseBulletEnv):
    """A person."""

    model, power, feet = "humanoid_symmetric.xml", 0.41, ("right_foot", "left_foot")
    observation_count, action_count = 44, 17
    # Seventeen joints, of which four matter for walking.
    effort = 4.25
    _ORDER = (
        *("abdomen_z", "abdomen_y", "abdomen_x"),
        *(f"{side}_{joint}" for side in ("right", "left") for joint in ("hip_x", "hip_z", "hip_y", "knee")),
        *(f"{side}_{joint}" for side in ("right", "left") for joint in ("shoulder1", "shoulder2", "elbow")),
    )
    joint_power: ClassVar[Mapping[str, float]] = {
        f"{side}_{joint}": torque
        for side in ("right", "left")
        for joint, torque in (
            ("hip_y", 300.0),
            ("knee", 200.0),
            ("shoulder1", 75.0),
            ("shoulder2", 75.0),
            ("elbow", 75.0),
        )
    }

    def _starting_height(self) -> float:
        return 0.8

    def _drive(self, action: np.ndarray) -> None:
        for name, share in zip(self._ORDER, action, strict=True):
            self.parts.motors[name].drive(self.power * self.joint_power.get(name, _POWER) * share)

    def _alive(self, height: float, pitch: float) -> float:
        return 2.0 if height > 0.78 else -1.0
