"""A joint: how a child link can move relative to its parent link."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.layouts.codes import JointCode

if TYPE_CHECKING:
    from carom.description.compliance import Compliance


class JointType(Enum):
    """The kinds of joint a description can hold."""

    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FIXED = "fixed"
    FLOATING = "floating"
    PLANAR = "planar"
    SPHERICAL = "spherical"


# Which joint types have, or need, an axis and limits in files.
WITHOUT_AXIS = (JointType.FIXED, JointType.FLOATING)
NEEDS_AXIS = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.PLANAR)
WITHOUT_LIMIT = (JointType.CONTINUOUS,)
NEEDS_LIMIT = (JointType.REVOLUTE, JointType.PRISMATIC)
# Joint types whose positions are lengths, which scale with the robot.
SLIDES = (JointType.PRISMATIC,)
# Joint types of the engine.
JOINT_CODE = {
    JointType.REVOLUTE: JointCode.REVOLUTE,
    JointType.CONTINUOUS: JointCode.REVOLUTE,
    JointType.PRISMATIC: JointCode.PRISMATIC,
    JointType.SPHERICAL: JointCode.SPHERICAL,
    JointType.PLANAR: JointCode.PLANAR,
    JointType.FIXED: JointCode.FIXED,
    JointType.FLOATING: JointCode.FIXED,
}


@dataclass(frozen=True, slots=True)
class JointLimit:
    """Bounds of a joint; `lower > upper` means unlimited.

    Attributes:
        lower: Least position [rad or m].
        upper: Largest position [rad or m].
        effort: Maximum torque or force of the drive [N m or N].
        velocity: Maximum speed [rad/s or m/s].
        twist: Largest twist of a spherical joint [rad]; negative means unlimited.
    """

    lower: float = 0.0
    upper: float = -1.0
    effort: float = 0.0
    velocity: float = 0.0
    twist: float = -1.0


@dataclass(frozen=True, slots=True)
class Mimic:
    """This joint follows another: position = multiplier · other + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class SafetyController:
    """Soft limits of a drive, as the file states them."""

    soft_lower: float = 0.0
    soft_upper: float = 0.0
    k_position: float = 0.0
    k_velocity: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint between two links of a robot.

    Attributes:
        parent: Index of the parent link in `Robot.links`.
        child: Index of the child link in `Robot.links`.
        frame: Joint frame in the parent's link frame; it is the child's link frame at position 0.
        axis: Unit axis in the joint frame.
        axis_length: Length the axis has in the file; PyBullet reports it unnormalised.
        damping: Viscous damping [N m s/rad or N s/m]. It is implicit in velocity where files are read as
            written; for PyBullet it is explicit.
        armature: Inertia of the drive, seen at the joint [kg m² or kg].
        stiffness: Of a spring at the joint [N m/rad or N/m].
        spring_reference: Position at which this spring is at rest [rad or m]; of a spherical joint it is
            always the position without rotation.
        friction: Dry friction as the file states it [N m or N]; PyBullet's API does not simulate it.
        limit_compliance: How its limits yield; None for rigid ones.
        limit_margin: Distance from a limit at which it begins to act [rad or m].
        friction_compliance: How its friction yields while it sticks; None for friction that holds it.
    """

    name: str
    type: JointType
    parent: int
    child: int
    frame: Pose = IDENTITY
    axis: Vector3 = (1.0, 0.0, 0.0)
    axis_length: float = 1.0
    limit: JointLimit = JointLimit()
    damping: float = 0.0
    friction: float = 0.0
    armature: float = 0.0
    stiffness: float = 0.0
    spring_reference: float = 0.0
    mimic: Mimic | None = None
    safety: SafetyController | None = None
    limit_compliance: Compliance | None = None
    limit_margin: float = 0.0
    friction_compliance: Compliance | None = None
