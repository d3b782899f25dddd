"""A joint: how a child link can move relative to its parent link."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.layouts.codes import BALLS, DRIVEN, PLANES, SLIDING_JOINTS, JointCode

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
    SCREW = "screw"


class JointForm(NamedTuple):
    """What descriptions have to know of a joint type; what the engine has to is in `layouts.codes.JOINTS`.

    Attributes:
        code: The type of the engine.
        has_axis: It may have an axis in files; `needs_axis`: it has to.
        has_limit: It may have limits in files; `needs_limit`: it has to, and they hold it.
        urdf: Its name in URDF files; empty for none, here and below.
        sdf: Its names in SDF files.
        mjcf: Its name in MJCF files.
        usd: Its class in USD stages, without `Physics`.
        is_bullets: PyBullet reads it.
    """

    code: JointCode
    has_axis: bool = True
    needs_axis: bool = False
    has_limit: bool = True
    needs_limit: bool = False
    urdf: str = ""
    sdf: tuple[str, ...] = ()
    mjcf: str = ""
    usd: str = "Joint"
    is_bullets: bool = True


JOINTS: dict[JointType, JointForm] = {
    JointType.REVOLUTE: JointForm(
        JointCode.REVOLUTE, needs_axis=True, needs_limit=True,
        urdf="revolute", sdf=("revolute",), mjcf="hinge", usd="RevoluteJoint",
    ),
    JointType.CONTINUOUS: JointForm(
        JointCode.REVOLUTE, needs_axis=True, has_limit=False,
        urdf="continuous", sdf=("continuous",), mjcf="hinge", usd="RevoluteJoint",
    ),
    JointType.PRISMATIC: JointForm(
        JointCode.PRISMATIC, needs_axis=True, needs_limit=True,
        urdf="prismatic", sdf=("prismatic",), mjcf="slide", usd="PrismaticJoint",
    ),
    JointType.FIXED: JointForm(
        JointCode.FIXED, has_axis=False, urdf="fixed", sdf=("fixed",), usd="FixedJoint"
    ),
    JointType.FLOATING: JointForm(JointCode.FIXED, has_axis=False, urdf="floating", sdf=("floating",)),
    JointType.PLANAR: JointForm(JointCode.PLANAR, needs_axis=True, urdf="planar", sdf=("planar",)),
    JointType.SPHERICAL: JointForm(
        JointCode.SPHERICAL, urdf="spherical", sdf=("spherical", "ball"), mjcf="ball", usd="SphericalJoint"
    ),
    JointType.SCREW: JointForm(
        JointCode.SCREW, needs_axis=True, needs_limit=True, sdf=("screw",), is_bullets=False
    ),
}  # fmt: skip

JOINT_CODE = {kind: it.code for kind, it in JOINTS.items()}
# Which joint types have, or need, an axis and limits in files.
WITHOUT_AXIS = tuple(kind for kind, it in JOINTS.items() if not it.has_axis)
NEEDS_AXIS = tuple(kind for kind, it in JOINTS.items() if it.needs_axis)
WITHOUT_LIMIT = tuple(kind for kind, it in JOINTS.items() if not it.has_limit)
NEEDS_LIMIT = tuple(kind for kind, it in JOINTS.items() if it.needs_limit)
# Joint types whose positions are lengths, which scale with the robot.
SLIDES = tuple(kind for kind, it in JOINTS.items() if it.code in SLIDING_JOINTS)
# Joint types with one axis, whose drive is one number.
ONE_AXIS = tuple(kind for kind, it in JOINTS.items() if it.code in DRIVEN)
# Joint types whose positions are quaternions; an angle and two lengths; nothing, as they do not move.
BALL_TYPES = tuple(kind for kind, it in JOINTS.items() if it.code in BALLS)
PLANE_TYPES = tuple(kind for kind, it in JOINTS.items() if it.code in PLANES)
STILL = tuple(kind for kind, it in JOINTS.items() if it.code == JointCode.FIXED)
# What files with joints of several axes are read to, and the same without limits.
HINGE, SLIDER, BALL = JointType.REVOLUTE, JointType.PRISMATIC, JointType.SPHERICAL
UNLIMITED = {HINGE: JointType.CONTINUOUS}
HINGES = (HINGE, *UNLIMITED.values())


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
        pitch: How far a screw goes along its axis in one turn [m].
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
    pitch: float = 0.0
