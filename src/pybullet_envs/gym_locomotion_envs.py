"""Robots that learn to run."""

from __future__ import annotations

import os
from abc import abstractmethod
from collections.abc import Iterable, Mapping
from math import atan2, cos, sin
from typing import Any, ClassVar

import numpy as np

import pybullet_data
from pybullet_envs.env_bases import Place, checked
from pybullet_envs.robot_bases import MJCFEnv

_POWER = 100.0
_LARGEST_START = 0.1
_NEAR_LIMIT = 0.99
_LARGEST_OBSERVED = 5.0
_EFFORT, _STALL, _LIMIT = 2.0, 0.1, 0.1
"""What the power of motors, torques at rest and joints at their limits cost."""

_HALF_STADIUM = (105.0 * 0.25, 50.0 * 0.25)
_FLAG_SPREAD, _FLAG_HEIGHT, _FLAG_REACHED, _FLAG_FRAMES = 0.5, 0.7, 1.0, 600
"""Share of the stadium in which flags stand, their height, what is near [m], frames before they move."""
_UPRIGHT, _LONGEST_DOWN = 0.8, 170
_PEACE, _HURL_PERIOD, _HURL_DISTANCE, _HURL_SPEEDS, _CUBE_MASS = 100, 30, 4.0, (20.0, 30.0), 1.2
_HALF_TURN = 3.14


class WalkerBaseBulletEnv(MJCFEnv):
    """A robot that is to run along x.

    Observation: height above that at the start; sine and cosine of the angle to the goal; velocity of the
    body in its own heading, times 0.3; roll and pitch; of each joint the position between its limits, from -1
    to 1, and a tenth of its rate; of each foot whether it is on the ground. All within ±5.

    Reward: being alive, coming nearer to the goal, less effort and joints at their limits.

    Attributes:
        goal: Where it is to run to (x, y) [m]: a kilometre away.
        power: Torque of an action of one, times that of the joint.
        feet: The links whose contact with the ground is observed.
        joint_power: Torque of joints [N m] that have not 100.
        effort: How much more than usual effort costs.
    """

    robot_name = "torso"
    time_step, frame_skip = 0.0165 / 4, 4
    goal = (1e3, 0.0)
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

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode."""
        first = super().reset(seed=seed, options=options)
        self._potential = self._standing()
        return first

    def _place(self) -> None:
        for name in self._joints:
            self.parts.motors[name].place(self.np_random.uniform(-_LARGEST_START, _LARGEST_START))
        self._on_ground = np.zeros(len(self.feet), np.float32)
        self._first_height = self._starting_height()

    def _starting_height(self) -> float:
        return self._height()

    def _height(self) -> float:
        return float(self.parts.body.pose()[0][2])

    def _middle(self) -> tuple[float, float]:
        """Of all parts (x, y) [m]."""
        x, y, _ = np.mean([part.pose()[0] for part in self.parts.links.values()], axis=0).tolist()
        return x, y

    def _way_to_goal(self) -> tuple[float, float]:
        """Direction [rad] and distance [m] of the goal from the middle of all parts."""
        (x, y), (goal_x, goal_y) = self._middle(), self.goal
        return atan2(goal_y - y, goal_x - x), float(np.hypot(goal_x - x, goal_y - y))

    def _standing(self) -> float:
        """What coming to where it is now is worth; the reward has by how much that grows."""
        return -self._way_to_goal()[1] / self.frame_time

    def _joint_states(self) -> np.ndarray:
        """(joints, 2) relative positions and rates."""
        return np.array([self.parts.motors[name].relative_state() for name in self._joints], np.float32)

    def _body_angles(self) -> tuple[float, float, float]:
        return self._p.getEulerFromQuaternion(self.parts.body.pose()[1].tolist())

    def _observe(self) -> np.ndarray:
        roll, pitch, yaw = self._body_angles()
        height = self._height() - self._first_height
        aside = self._way_to_goal()[0] - yaw
        vx, vy, vz = self.parts.body.velocity()
        ahead, across = cos(yaw) * vx + sin(yaw) * vy, cos(yaw) * vy - sin(yaw) * vx
        body = [height, sin(aside), cos(aside), 0.3 * ahead, 0.3 * across, 0.3 * vz, roll, pitch]
        whole = np.concatenate([body, self._joint_states().ravel(), self._on_ground])
        return np.clip(whole, -_LARGEST_OBSERVED, _LARGEST_OBSERVED).astype(np.float32)

    def _driven(self) -> Iterable[str]:
        """The joints that the numbers of an action drive."""
        return self._joints

    def _drive(self, action: np.ndarray) -> None:
        for name, share in zip(self._driven(), action, strict=True):
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
        before, self._potential = self._potential, self._standing()
        progress = self._potential - before
        effort = _EFFORT * float(np.abs(given * states[:, 1]).mean()) + _STALL * float(
            np.square(given).mean()
        )
        at_limit = _LIMIT * float(np.count_nonzero(np.abs(states[:, 0]) > _NEAR_LIMIT))
        for number, foot in enumerate(self.feet):
            self._on_ground[number] = self.parts.links[foot].touches(self._ground)
        return seen, alive + progress - self.effort * effort - at_limit, self._ended(alive), False, {}

    def _ended(self, alive: float) -> bool:
        """Whether the episode is over, given the reward of being alive."""
        return alive < 0.0

    @abstractmethod
    def _alive(self, height: float, pitch: float) -> float:
        """The reward of being alive; below 0 the robot has failed."""

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
    """A runner in a plane; nothing but its feet is to touch the ground, which costs but ends no episode."""

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

    def _ended(self, alive: float) -> bool:
        return False


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

    def _driven(self) -> Iterable[str]:
        return self._ORDER

    def _alive(self, height: float, pitch: float) -> float:
        return 2.0 if height > 0.78 else -1.0


class HumanoidFlagrunBulletEnv(HumanoidBulletEnv):
    """A person that runs to a flag, which moves on when it is reached, or after 150 steps.

    As in PyBullet the reward of a step in which the flag moves has the whole way that the goal jumped.
    """

    def _load(self) -> None:
        super()._load()
        self._flag = self._thing("sphere2red_nocol.urdf")

    def _thing(self, file: str) -> int:
        return self._p.loadURDF(os.path.join(pybullet_data.getDataPath(), file))

    def _place(self) -> None:
        super()._place()
        self._move_flag()

    def _move_flag(self) -> None:
        x, y = (self.np_random.uniform(-half, half) * _FLAG_SPREAD for half in _HALF_STADIUM)
        self.goal = x, y
        self._p.resetBasePositionAndOrientation(self._flag, (x, y, _FLAG_HEIGHT), (0.0, 0.0, 0.0, 1.0))
        self._patience = _FLAG_FRAMES / self.frame_skip

    def _observe(self) -> np.ndarray:
        self._patience -= 1
        if self._way_to_goal()[1] < _FLAG_REACHED or self._patience <= 0:
            self._move_flag()
        return super()._observe()


class HumanoidFlagrunHarderBulletEnv(HumanoidFlagrunBulletEnv):
    """As `HumanoidFlagrunBulletEnv`, while a heavy cube is hurled at it every 30 steps, if it stands.

    It may fall and has to get up: an episode ends after 170 steps more on the ground than not. Being alive is
    worth between 1 lying down and 2 standing; ways crawled are worth nothing.
    """

    def _load(self) -> None:
        super()._load()
        self._cube = self._thing("cube_small.urdf")
        self._p.changeDynamics(self._cube, -1, mass=_CUBE_MASS)

    def _place(self) -> None:
        super()._place()
        self._p.resetBasePositionAndOrientation(self._cube, (-1.5, 0.0, 0.05), (0.0, 0.0, 0.0, 1.0))
        self._steps = self._steps_down = 0
        self._crawl_start: float | None = None
        self._crawled = 0.0

    def _observe(self) -> np.ndarray:
        moved_from = self.goal
        seen = super()._observe()
        if self.goal != moved_from:
            # As in PyBullet, whose bookkeeping of crawling goes on when the flag moves.
            self._standing()
        return seen

    def _alive(self, height: float, pitch: float) -> float:
        if self._steps % _HURL_PERIOD == 0 and self._steps > _PEACE and self._steps_down == 0:
            self._hurl()
        if height < _UPRIGHT:
            self._steps_down += 1
        elif self._steps_down > 0:
            self._steps_down -= 1
        self._steps += 1
        return self._uprightness() if self._steps_down < _LONGEST_DOWN else -1.0

    def _hurl(self) -> None:
        """Throws the cube from 4 m away at where the robot will be."""
        angle = self.np_random.uniform(-_HALF_TURN, _HALF_TURN)
        speed = self.np_random.uniform(*_HURL_SPEEDS)
        target = np.array([*self._middle(), self._height()])
        target += self.parts.body.velocity() * (_HURL_DISTANCE / speed)
        start = target + np.array([_HURL_DISTANCE * cos(angle), _HURL_DISTANCE * sin(angle), 1.0])
        way = target - start
        velocity = way * (speed / np.linalg.norm(way)) + self.np_random.uniform(-1.0, 1.0, size=3)
        turn = self._p.getBasePositionAndOrientation(self._cube)[1]
        self._p.resetBasePositionAndOrientation(self._cube, start.tolist(), turn)
        self._p.resetBaseVelocity(self._cube, velocity.tolist(), (0.0, 0.0, 0.0))

    def _uprightness(self) -> float:
        """1 for one that lies, 2 for one that stands."""
        return min(max(self._height(), 0.0), _UPRIGHT) / _UPRIGHT + 1.0

    def _standing(self) -> float:
        progress = super()._standing()
        if self._height() >= _UPRIGHT:
            self._crawl_start = None
            return progress - self._crawled + 100.0 * self._uprightness()
        if self._crawl_start is None:
            self._crawl_start = progress - self._crawled
        self._crawled = progress - self._crawl_start
        return self._crawl_start + 100.0 * self._uprightness()
