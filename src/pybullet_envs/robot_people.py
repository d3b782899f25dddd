"""Humanoids that run, straight on or to flags."""

from __future__ import annotations

import os
from collections.abc import Mapping
from math import cos, sin
from typing import Any, ClassVar

import numpy as np

import pybullet_data
from pybullet_envs.robot_parts import BodyPart
from pybullet_envs.robot_walker import WalkerBase

_FLAG_SPREAD, _FLAG_HEIGHT, _FLAG_REACHED, _FLAG_FRAMES = 0.5, 0.7, 1.0, 600
"""Share of the stadium for flags, their height [m], distance that counts as reached [m], frames per flag."""
_UPRIGHT, _LONGEST_DOWN = 0.8, 170
_PEACE, _HURL_PERIOD, _HURL_DISTANCE, _HURL_SPEEDS, _CUBE_MASS = 100, 30, 4.0, (20.0, 30.0), 1.2
_HALF_TURN = 3.14
_UNTURNED = (0.0, 0.0, 0.0, 1.0)
_MOTORS = (
    *(("abdomen_z", 100.0), ("abdomen_y", 100.0), ("abdomen_x", 100.0)),
    *(
        (f"{side}_{joint}", torque)
        for side in ("right", "left")
        for joint, torque in (("hip_x", 100.0), ("hip_z", 100.0), ("hip_y", 300.0), ("knee", 200.0))
    ),
    *(
        (f"{side}_{joint}", 75.0)
        for side in ("right", "left")
        for joint in ("shoulder1", "shoulder2", "elbow")
    ),
)


class Humanoid(WalkerBase):
    """A humanoid.

    Attributes:
        motor_names: Names of the joints that an action drives, in order.
        motor_power: Torques of these joints [N m], before `power` is applied.
        random_yaw: Whether episodes start with a random heading.
        random_lean: Whether the robot may then start lying down.
    """

    foot_list: ClassVar[Any] = ("right_foot", "left_foot")
    joint_power: ClassVar[Mapping[str, float]] = dict(_MOTORS)
    random_yaw = False
    random_lean = False

    def __init__(self) -> None:
        super().__init__("humanoid_symmetric.xml", "torso", action_dim=17, obs_dim=44, power=0.41)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Randomises the joint angles a little and, with `random_yaw`, the pose of the base."""
        super().robot_specific_reset(bullet_client)
        self.motor_names = [name for name, _ in _MOTORS]
        self.motor_power = [power for _, power in _MOTORS]
        self.motors = [self.jdict[name] for name in self.motor_names]
        if self.random_yaw:
            self._turn_about(bullet_client)
        self.initial_z = 0.8

    def _turn_about(self, bullet_client: Any) -> None:
        height, pitch = 1.4, 0.0
        yaw = self.np_random.uniform(-3.14, 3.14)
        if self.random_lean and self.np_random.uniform() < 0.5:
            height, pitch = (0.45, np.pi / 2.0) if self.np_random.uniform() < 0.5 else (0.25, 1.5 * np.pi)
        turn = bullet_client.getQuaternionFromEuler((0.0, pitch, yaw))
        self.robot_body.reset_pose((0.0, 0.0, height), turn)

    def alive_bonus(self, z: float, pitch: float) -> float:
        """2 while the robot stands, otherwise -1; 2, because exploring with 17 joints costs effort."""
        return 2.0 if z > 0.78 else -1.0


def _thing(bullet_client: Any, file: str) -> BodyPart:
    """Loads a body from a file of `pybullet_data`."""
    body = bullet_client.loadURDF(os.path.join(pybullet_data.getDataPath(), file))
    return BodyPart(bullet_client, bullet_client.getBodyInfo(body)[0].decode(), [body], 0, -1)


class HumanoidFlagrun(Humanoid):
    """A humanoid that runs to a flag, which moves when it is reached, or after 150 steps.

    As in PyBullet, if the flag moves in a step, the reward includes the jump of the distance to it.

    Attributes:
        flag: The flag, a ball without collision shape.
        flag_timeout: Number of steps until the flag moves.
    """

    def forget(self) -> None:
        """Drops links, joints and the flag."""
        super().forget()
        self.flag: BodyPart | None = None

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Resets the robot and moves the flag."""
        super().robot_specific_reset(bullet_client)
        self.flag_reposition()

    def flag_reposition(self) -> None:
        """Moves the flag to a random position."""
        halves = (self.scene.stadium_halflen, self.scene.stadium_halfwidth)
        self.walk_target_x, self.walk_target_y = (
            self.np_random.uniform(-half, half) * _FLAG_SPREAD for half in halves
        )
        if self.flag is None:
            self.flag = _thing(self._p, "sphere2red_nocol.urdf")
        self.flag.reset_pose((self.walk_target_x, self.walk_target_y, _FLAG_HEIGHT), _UNTURNED)
        self.flag_timeout = _FLAG_FRAMES / self.scene.frame_skip

    def calc_state(self) -> np.ndarray:
        """The present observation; moves the flag if it is reached or its time is over."""
        self.flag_timeout -= 1
        state = super().calc_state()
        if self.walk_target_dist >= _FLAG_REACHED and self.flag_timeout > 0:
            return state
        self.flag_reposition()
        state = super().calc_state()
        # The value is not read, but computing it updates the progress made by crawling.
        self.potential = self.calc_potential()
        return state


class HumanoidFlagrunHarder(HumanoidFlagrun):
    """A `HumanoidFlagrun` at which a heavy cube is thrown every 30 steps, if it stands.

    The robot may fall, and has to get up: it fails when `on_ground_frame_counter` reaches 170. The alive
    bonus is between 1 (lying) and 2 (standing); progress made by crawling is not rewarded.

    Attributes:
        aggressive_cube: The cube.
        frame: Number of steps in the episode.
        on_ground_frame_counter: Number of steps on the ground, minus steps off the ground since.
    """

    def forget(self) -> None:
        """Drops links, joints, the flag and the cube."""
        super().forget()
        self.aggressive_cube: BodyPart | None = None

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Resets the robot and places the cube behind it."""
        super().robot_specific_reset(bullet_client)
        if self.aggressive_cube is None:
            self.aggressive_cube = _thing(bullet_client, "cube_small.urdf")
            bullet_client.changeDynamics(self.aggressive_cube.body, -1, mass=_CUBE_MASS)
        self.aggressive_cube.reset_pose((-1.5, 0.0, 0.05), _UNTURNED)
        self.frame = self.on_ground_frame_counter = 0
        self.crawl_start_potential: float | None = None
        self.crawl_ignored_potential = 0.0

    def alive_bonus(self, z: float, pitch: float) -> float:
        """Between 1 and 2; -1 if the robot has been on the ground for too long."""
        attack = self.frame % _HURL_PERIOD == 0 and self.frame > _PEACE
        if attack and self.on_ground_frame_counter == 0:
            self._hurl()
        if z < _UPRIGHT:
            self.on_ground_frame_counter += 1
        elif self.on_ground_frame_counter > 0:
            self.on_ground_frame_counter -= 1
        self.frame += 1
        return self.potential_leak() if self.on_ground_frame_counter < _LONGEST_DOWN else -1.0

    def _hurl(self) -> None:
        """Throws the cube from a distance of 4 m at the predicted position of the robot."""
        assert self.aggressive_cube is not None
        angle = self.np_random.uniform(-_HALF_TURN, _HALF_TURN)
        speed = self.np_random.uniform(*_HURL_SPEEDS)
        target = np.array(self.body_xyz) + self.robot_body.speed() * (_HURL_DISTANCE / speed)
        start = target + np.array([_HURL_DISTANCE * cos(angle), _HURL_DISTANCE * sin(angle), 1.0])
        way = target - start
        velocity = way * (speed / np.linalg.norm(way)) + self.np_random.uniform(-1.0, 1.0, size=3)
        self.aggressive_cube.reset_position(start)
        self.aggressive_cube.reset_velocity(velocity)

    def potential_leak(self) -> float:
        """Alive bonus: from 1 (lying) to 2 (standing), by the height of the body."""
        return min(max(self.body_xyz[2], 0.0), _UPRIGHT) / _UPRIGHT + 1.0

    def calc_potential(self) -> float:
        """Potential without the progress made by crawling, plus 100 times `potential_leak`."""
        progress = super().calc_potential()
        upright = 100.0 * self.potential_leak()
        if self.body_xyz[2] >= _UPRIGHT:
            self.crawl_start_potential = None
            return progress - self.crawl_ignored_potential + upright
        if self.crawl_start_potential is None:
            self.crawl_start_potential = progress - self.crawl_ignored_potential
        self.crawl_ignored_potential = progress - self.crawl_start_potential
        return self.crawl_start_potential + upright
