"""A body ready for the engine: a robot flattened into the link order and frames of the solver.

`carom.model.assemble` makes one from a `Robot` and the loading options; `carom.model.builder`
appends it to the flat arrays of a `Model`. Functions that report on bodies read it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from struct import pack, unpack
from typing import TYPE_CHECKING, Any

from carom.description import Collision, ContactParameters, JointType, Mimic, Pose, Visual
from carom.description.joint import JOINT_CODE
from carom.description.pose import IDENTITY, Vector3
from carom.layouts.codes import BALLS, POSITION_COUNT
from carom.layouts.contacts import MARGIN

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.description.compliance import Compliance
    from carom.description.fluid import FluidEllipsoid
    from carom.description.keyframe import BodyKeyframe
    from carom.description.sensor import SensorSpec
    from carom.description.site import SiteSpec
    from carom.model.soft_spec import SoftSpec

BASE = -1
# Bullet's default [1/s], a float32 in its source.
DEFAULT_LINK_DAMPING = unpack("f", pack("f", 0.04))[0]
DEFAULT_MAX_VELOCITY = 100.0
DEFAULT_CONTACT = ContactParameters()


@dataclass(repr=False, eq=False, slots=True)
class LinkSpec:
    """A link and its parent joint.

    Attributes:
        name: Link name.
        parent: Index of the parent in `BodySpec.links`; -1 is the base. Always less than the
            link's own index.
        mass: [kg].
        inertia: Principal moments [kg m²] along the axes of the inertial frame.
        inertial_frame: Inertial (centre of mass) frame in the link frame.
        joint_name: Name of the joint to the parent (empty for the base).
        joint_type: Kind of that joint. `FLOATING` never occurs: inside a tree it is fixed.
        joint_frame: Joint frame in the parent's link frame; the link frame at joint position 0.
        joint_axis: Unit axis in the joint frame.
        joint_axis_length: Length the axis has in the file; PyBullet reports it unnormalised.
        lower: Lower limit as the file states it [rad or m].
        upper: Upper limit; `lower > upper` means none.
        limited: The engine enforces `lower` and `upper`.
        effort: Largest drive force the file states; not enforced.
        velocity: Maximum speed the file states; not enforced.
        twist: Twist limit of a spherical joint [rad]; negative means none.
        pitch: How far a screw goes along its axis in one turn [m].
        damping: Viscous joint damping [N m s/rad or N s/m]: explicit in a body with `is_held`, else implicit.
        armature: Inertia of the drive, seen at the joint [kg m² or kg].
        stiffness: Of a spring at the joint [N m/rad or N/m].
        spring_reference: Position at which this spring is at rest [rad or m]; of a spherical joint it is
            always the position without rotation.
        friction: Dry friction of the joint [N m or N]; not simulated in a body with `is_held`.
        limit_compliance: How the joint's limits yield; None for rigid ones.
        limit_margin: Distance from a limit at which it begins to act [rad or m].
        friction_compliance: How its friction yields while it sticks; None for friction that holds it.
        collisions: Collision shapes, with poses in the link frame.
        visuals: Visual shapes, with poses in the link frame.
        compound_margin: Distance by which the bounds of several shapes, or of one that is not in the
            inertial frame, are widened [m].
        default_margins: Boxes, cylinders and planes have Bullet's own collision margins
            (`carom.model.inertia`), as those from MJCF files do in PyBullet, instead of `MARGIN`.
        exact_edges: No margin rounds the edges of boxes and cylinders, as in MuJoCo.
        contact: Contact parameters of the link.
        mimic: The joint this one follows, as the file states it; not simulated in a body with `is_held`.
        gravity_compensation: Share of its weight that a force at its centre of mass carries.
        fluid: What feels the fluid of the world instead of the box of its inertia.
        user_data: Key and value pairs stated by the file for the link.
    """

    name: str
    parent: int = BASE
    mass: float = 0.0
    inertia: Vector3 = (0.0, 0.0, 0.0)
    inertial_frame: Pose = IDENTITY
    joint_name: str = ""
    joint_type: JointType = JointType.FIXED
    joint_frame: Pose = IDENTITY
    joint_axis: Vector3 = (1.0, 0.0, 0.0)
    joint_axis_length: float = 1.0
    lower: float = 0.0
    upper: float = -1.0
    limited: bool = False
    effort: float = 0.0
    velocity: float = 0.0
    twist: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    armature: float = 0.0
    stiffness: float = 0.0
    spring_reference: float = 0.0
    limit_compliance: Compliance | None = None
    limit_margin: float = 0.0
    friction_compliance: Compliance | None = None
    collisions: tuple[Collision, ...] = ()
    visuals: tuple[Visual, ...] = ()
    compound_margin: float = MARGIN
    default_margins: bool = False
    exact_edges: bool = False
    contact: ContactParameters = DEFAULT_CONTACT
    mimic: Mimic | None = None
    gravity_compensation: float = 0.0
    fluid: FluidEllipsoid | None = None
    user_data: dict[str, str] = field(default_factory=dict)
    pitch: float = 0.0

    @property
    def spring_rest(self) -> tuple[float, ...]:
        """The position coordinates at which the joint's spring is at rest when it is loaded."""
        code = JOINT_CODE[self.joint_type]
        if code in BALLS:
            return (0.0, 0.0, 0.0, 1.0)
        return (self.spring_reference,) * POSITION_COUNT[code]


class Reusable:
    """Base of specifications that several bodies may share; its attributes are no part of their value.

    Attributes:
        is_reused: Whether another body was made from it before, and it has not changed since.
        pattern: What is the same for all these bodies; see `carom.scene.pattern`. None until the second one.
    """

    __slots__ = ("is_reused", "pattern")

    def __post_init__(self) -> None:
        self.is_reused: bool = False
        self.pattern: Any = None


@dataclass(repr=False, eq=False, slots=True)
class BodySpec(Reusable):
    """A tree of links; it does not change any more after a body has been made from it.

    Attributes:
        name: Name of the robot.
        base: The root link; of its joint fields damping, armature and stiffness count, if it is free
            and not `is_held`.
        links: Every other link, parents before children, in the order users index joints.
        fixed_base: The base does not move (mass 0).
        flags: The loading flags it was made with.
        source: The file it came from, if any.
        user_data: Key and value pairs stated by the file for the model.
        soft: The specification of a soft body; its base is fixed and has neither shapes nor links.
        link_damping: Share of the velocity of the body's links that air takes away [1/s].
        max_velocity: Greatest speed of each of its coordinates [rad/s or m/s]; PyBullet's holds them at 100.
        is_held: As in PyBullet, motors hold all joints until they are commanded, joints have no friction
            and follow no others, and their damping is explicit.
        actuators: What drives its joints besides their motors.
        sites: Named frames on its links.
        sensors: What it measures.
        keyframes: Its states by name.
        base_rest: Position and orientation of its base at which a spring there is at rest; empty without one.
        is_mocap: Its base is fixed, and moved by users only: also with the mouse in the viewer.
    """

    name: str
    base: LinkSpec
    links: list[LinkSpec] = field(default_factory=list)
    fixed_base: bool = False
    flags: int = 0
    source: Path | None = None
    user_data: dict[str, str] = field(default_factory=dict)
    soft: SoftSpec | None = None
    link_damping: float = DEFAULT_LINK_DAMPING
    max_velocity: float = DEFAULT_MAX_VELOCITY
    is_held: bool = True
    actuators: tuple[ActuatorSpec, ...] = ()
    sites: tuple[SiteSpec, ...] = ()
    sensors: tuple[SensorSpec, ...] = ()
    keyframes: tuple[BodyKeyframe, ...] = ()
    is_mocap: bool = False
    base_rest: tuple[float, ...] = ()

    @property
    def damping_field(self) -> str:
        """The array of `Model` with the damping of its joints."""
        return "dof_damping" if self.is_held else "dof_implicit_damping"

    def link(self, index: int) -> LinkSpec:
        """A link by its index; -1 is the base."""
        return self.base if index == BASE else self.links[index]
