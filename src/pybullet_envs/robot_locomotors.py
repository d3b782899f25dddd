"""Robots that run."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, ClassVar

import pybullet_data
from pybullet_envs.robot_parts import BodyPart
from pybullet_envs.robot_people import Humanoid, HumanoidFlagrun, HumanoidFlagrunHarder
from pybullet_envs.robot_walker import WalkerBase

__all__ = [
    "Ant",
    "HalfCheetah",
    "Hopper",
    "Humanoid",
    "HumanoidFlagrun",
    "HumanoidFlagrunHarder",
    "Walker2D",
    "WalkerBase",
    "get_cube",
    "get_sphere",
]


class Hopper(WalkerBase):
    """A hopper with one leg."""

    foot_list: ClassVar[Any] = ("foot",)

    def __init__(self) -> None:
        super().__init__("hopper.xml", "torso", action_dim=3, obs_dim=15, power=0.75)

    def alive_bonus(self, z: float, pitch: float) -> float:
        """1 while the robot stands, otherwise -1."""
        return 1.0 if z > 0.8 and abs(pitch) < 1.0 else -1.0


class Walker2D(WalkerBase):
    """A biped in a plane."""

    foot_list: ClassVar[Any] = ("foot", "foot_left")
    joint_power: ClassVar[Mapping[str, float]] = {"foot_joint": 30.0, "foot_left_joint": 30.0}

    def __init__(self) -> None:
        super().__init__("walker2d.xml", "torso", action_dim=6, obs_dim=22, power=0.40)

    def alive_bonus(self, z: float, pitch: float) -> float:
        """1 while the robot stands, otherwise -1."""
        return 1.0 if z > 0.8 and abs(pitch) < 1.0 else -1.0


class HalfCheetah(WalkerBase):
    """A runner with two legs in a plane, which may touch the ground with its feet only."""

    foot_list: ClassVar[Any] = ("ffoot", "fshin", "fthigh", "bfoot", "bshin", "bthigh")
    joint_power: ClassVar[Mapping[str, float]] = {
        "bthigh": 120.0,
        "bshin": 90.0,
        "bfoot": 60.0,
        "fthigh": 140.0,
        "fshin": 60.0,
        "ffoot": 30.0,
    }

    def __init__(self) -> None:
        super().__init__("half_cheetah.xml", "torso", action_dim=6, obs_dim=26, power=0.90)

    def alive_bonus(self, z: float, pitch: float) -> float:
        """1 while only feet touch the ground and the body is level enough, otherwise -1."""
        _, front_shin, front_thigh, _, back_shin, back_thigh = self.feet_contact
        fallen = front_shin or front_thigh or back_shin or back_thigh
        return 1.0 if abs(pitch) < 1.0 and not fallen else -1.0


class Ant(WalkerBase):
    """A quadruped: four legs around a sphere."""

    foot_list: ClassVar[Any] = ("front_left_foot", "front_right_foot", "left_back_foot", "right_back_foot")

    def __init__(self) -> None:
        super().__init__("ant.xml", "torso", action_dim=8, obs_dim=28, power=2.5)

    def alive_bonus(self, z: float, pitch: float) -> float:
        """1 while the sphere is off the ground, otherwise -1."""
        return 1.0 if z > 0.26 else -1.0


def get_cube(_p: Any, x: float, y: float, z: float) -> BodyPart:
    """Loads a small cube of 1.2 kg at a position [m] and returns its only link."""
    part = _lone_part(_p, "cube_small.urdf", (x, y, z))
    _p.changeDynamics(part.body, -1, mass=1.2)
    return part


def get_sphere(_p: Any, x: float, y: float, z: float) -> BodyPart:
    """Loads a red ball without collisions at a position [m] and returns its only link."""
    return _lone_part(_p, "sphere2red_nocol.urdf", (x, y, z))


def _lone_part(bullet_client: Any, file: str, position: tuple[float, float, float]) -> BodyPart:
    body = bullet_client.loadURDF(os.path.join(pybullet_data.getDataPath(), file), position)
    name = bullet_client.getBodyInfo(body)[0].decode()
    return BodyPart(bullet_client, name, [body], 0, -1)
