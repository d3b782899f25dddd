"""A robot and its pose in a file."""

from __future__ import annotations

from dataclasses import dataclass

from carom.description import Pose, Robot
from carom.description.pose import IDENTITY


@dataclass(frozen=True, slots=True)
class PlacedRobot:
    """One of the robots in a file that holds a scene.

    Attributes:
        robot: The robot.
        pose: World pose of the link frame of its root.
        fixed_base: The file fixes it to the world.
    """

    robot: Robot
    pose: Pose = IDENTITY
    fixed_base: bool = False
