"""What a USD stage hands over to the world."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from carom.description.pose import Pose, Quaternion, Vector3
from carom.formats.placed import PlacedRobot

if TYPE_CHECKING:
    from carom.description.actuator import Actuator
    from carom.formats.mjcf.compiled.model import FileCamera

LinkPair = tuple[tuple[int, str], tuple[int, str]]
"""Two links, each by the number of its robot and its name."""


@dataclass(frozen=True, slots=True)
class Drive:
    """A drive of a joint.

    Attributes:
        joint: Name of the joint.
        actuator: What it does.
        control: The control that stands for the target of the file.
        name: Its name; empty for that of the joint.
        per_mass: Stiffness and damping are for each unit of the mass that it moves.
    """

    joint: str
    actuator: Actuator
    control: float = 0.0
    per_mass: bool = False
    name: str = ""


@dataclass(frozen=True, slots=True)
class Loop:
    """A joint that closes a loop of links.

    Attributes:
        name: Its name.
        links: Names of the links that it connects; empty for the world.
        frames: Its frame in that of each.
        points: Distances along `axis` at which points of both coincide [m]; none if their frames do.
        axis: In the frame of the joint.
    """

    name: str
    links: tuple[str, str]
    frames: tuple[Pose, Pose]
    points: tuple[float, ...] = ()
    axis: Vector3 = (1.0, 0.0, 0.0)


@dataclass(eq=False, slots=True)
class UsdRobot:
    """A robot of a stage, and what its description does not hold.

    Attributes:
        placed: The robot.
        drives: Drives of its joints.
        loops: Joints that close loops.
        touches_itself: Its links collide with each other.
        positions: Positions of joints that are not at 0 where the stage has the bodies [rad or m], by name.
        turns: Likewise orientations of spherical joints.
        velocity: Of the origin of a free root [m/s].
        angular_velocity: Of a free root [rad/s].
    """

    placed: PlacedRobot
    drives: list[Drive] = field(default_factory=list)
    loops: list[Loop] = field(default_factory=list)
    touches_itself: bool = False
    positions: dict[str, float] = field(default_factory=dict)
    turns: dict[str, Quaternion] = field(default_factory=dict)
    velocity: Vector3 = (0.0, 0.0, 0.0)
    angular_velocity: Vector3 = (0.0, 0.0, 0.0)


@dataclass(eq=False, slots=True)
class UsdScene:
    """All of a stage.

    Attributes:
        robots: Its robots, then its colliders that do not move.
        apart: Pairs of links that do not collide.
        cameras: Cameras by name.
        options: Values for the world, by name: `gravity` [m/s²].
    """

    robots: list[UsdRobot] = field(default_factory=list)
    apart: list[LinkPair] = field(default_factory=list)
    cameras: dict[str, FileCamera] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)
