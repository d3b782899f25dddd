"""What the reader of compiled MJCF hands over."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Any

from carom.description import Collision, Joint, Pose, Visual
from carom.description.compliance import Compliance, PairContact
from carom.description.fluid import FluidEllipsoid
from carom.description.link import ContactParameters, Rgba
from carom.description.pose import IDENTITY, Vector3
from carom.description.stage import Stage, StageLight
from carom.description.tendon import TendonLook
from carom.description.transform import compose
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.inertia import BodyInertia
from carom.formats.placed import PlacedRobot
from carom.layouts.codes import PathKind

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.description.sensor import SensorSpec
    from carom.formats.mjcf.compiled.context import CompiledContext
    from carom.formats.mjcf.compiled.deformables.file_skin import FileSkin

Along = Callable[[Iterable[tuple[str, float]]], float]
NODE = "node"
"""Kind of the sliders of nodes of flexes, which only keyframes name."""
_OF_IMAGES = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


@dataclass(frozen=True, slots=True)
class BallLimit:
    """The limit of a spherical joint.

    Attributes:
        angle: The greatest angle of its rotation [rad].
        compliance: How it yields.
        margin: Angle from the limit at which it begins to act [rad].
    """

    angle: float
    compliance: Compliance
    margin: float


@dataclass(eq=False, slots=True)
class CompiledJoint:
    """A joint of a body; its frame, parent and child are set later.

    Attributes:
        joint: Type, axis in the body's frame, limits, damping and so on.
        anchor: Its position in the body's frame [m].
        reference: Its position where the body is as the file states it [rad or m].
        element: The element that states it.
        context: The reading of its file.
        actuator_range: Bounds of the sum of its actuators' forces [N m or N].
        spring_damper: Time constant [s] and damping ratio of its spring, if both are positive.
        ball_limit: Of a spherical joint that is limited.
    """

    joint: Joint
    anchor: Vector3
    reference: float
    element: Element
    context: CompiledContext
    actuator_range: tuple[float, float] = (-inf, inf)
    spring_damper: tuple[float, float] = (0.0, 0.0)
    ball_limit: BallLimit | None = None


@dataclass(eq=False, slots=True)
class CompiledBody:
    """A body and all bodies in it.

    Attributes:
        name: Its name; made up if it has none.
        element: The element that states it.
        pose: Of its frame in that of its parent.
        joints: Its joints, in order.
        is_free: It has a free joint.
        free_damping: Damping of its free joint, along and about all axes [N s/m, N m s/rad].
        free_armature: Armature of its free joint [kg, kg m²].
        free_stiffness: Of the spring of its free joint, along and about all axes [N/m, N m/rad].
        free_friction: Greatest force and torque of dry friction along and about each of its axes [N, N m].
        free_compliance: How that friction yields.
        is_mocap: It is moved by users only.
        inertia: Its mass.
        collisions: Its shapes that collide.
        visuals: Its shapes that are seen.
        contact: Friction of its geoms.
        gravity_compensation: Share of its weight that is carried.
        fluids: Ellipsoids on which the fluid acts, instead of the box of its inertia, and their poses.
        children: Bodies in it.
    """

    name: str
    element: Element
    pose: Pose = IDENTITY
    joints: list[CompiledJoint] = field(default_factory=list)
    is_free: bool = False
    free_damping: float = 0.0
    free_armature: float = 0.0
    free_stiffness: float = 0.0
    free_friction: float = 0.0
    free_compliance: Compliance | None = None
    is_mocap: bool = False
    inertia: BodyInertia = field(default_factory=BodyInertia.none)
    collisions: list[Collision] = field(default_factory=list)
    visuals: list[Visual] = field(default_factory=list)
    contact: ContactParameters = field(default_factory=ContactParameters)
    gravity_compensation: float = 0.0
    fluids: list[tuple[FluidEllipsoid, Pose]] = field(default_factory=list)
    children: list[CompiledBody] = field(default_factory=list)


def world_poses(world: CompiledBody) -> dict[str, Pose]:
    """World poses of all bodies at the reference, by name."""
    poses = {world.name: IDENTITY}
    pending = [(child, IDENTITY) for child in world.children]
    while pending:
        body, around = pending.pop()
        pose = poses[body.name] = compose(around, body.pose)
        pending += [(child, pose) for child in body.children]
    return poses


@dataclass(frozen=True, slots=True)
class Site:
    """A named frame on a body.

    Attributes:
        name: Its name.
        body: Name of the body that has it; `world` for the world.
        frame: Its pose in the frame of that body.
        kind: Its shape, which marks it and bounds what touch sensors feel.
        size: Sizes of that shape, as MJCF states them [m].
        rgba: Its colour.
        group: Number of its group.
    """

    name: str
    body: str
    frame: Pose
    kind: str
    size: Vector3
    rgba: Rgba | None = None
    group: int = 0


@dataclass(frozen=True, slots=True)
class Lens:
    """How a camera projects, in widths and heights of its image.

    Attributes:
        focal: Focal lengths.
        middle: Where the optical axis meets the image, from its top left corner.
    """

    focal: tuple[float, float]
    middle: tuple[float, float]


@dataclass(frozen=True, slots=True)
class FileCamera:
    """A camera on a body.

    Attributes:
        name: Its name.
        body: Name of the body that has it; `world` for the world.
        frame: Its pose in the frame of that body; it looks along -z, y is up.
        field_of_view: Vertical angle [degrees].
        resolution: Width and height [pixels].
        mode: `fixed` to the body; `track` and `trackcom`: it moves with the body or the centre of mass of all
            in it, but does not turn; `targetbody` and `targetbodycom`: it looks at another body or at the
            centre of mass of all in that.
        target: Name of that other body; empty if there is none.
        lens: How it projects if the file says more than a field of view; None if not.
        is_orthographic: Its rays are parallel, and `field_of_view` is the height of what it sees [m].
    """

    name: str
    body: str
    frame: Pose
    field_of_view: float
    resolution: tuple[int, int]
    mode: str
    target: str = ""
    lens: Lens | None = None
    is_orthographic: bool = False

    @property
    def image_frame(self) -> Pose:
        """Its pose in the frame of that body with axes as of images: it looks along z, y is down."""
        return compose(self.frame, _OF_IMAGES)


@dataclass(frozen=True, slots=True)
class FileLight:
    """A light on a body.

    Attributes:
        body: Name of the body that has it; `world` for the world.
        light: What it is, in the frame of that body.
        mode: As that of cameras.
        target: Name of the body at which it is aimed; empty if there is none.
    """

    body: str
    light: StageLight
    mode: str
    target: str = ""


@dataclass(frozen=True, slots=True)
class FileKeyframe:
    """A named state, as MJCF lists it: all joints of the file in its order.

    Attributes:
        name: Its name.
        time: [s].
        positions: `qpos`; quaternions have w first. Empty if it states none: the reference.
        velocities: `qvel`. Empty for zero.
        controls: `ctrl`. Empty for zero.
        activations: `act`. Empty for zero.
    """

    name: str
    time: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    controls: tuple[float, ...]
    activations: tuple[float, ...] = ()


@dataclass(eq=False, slots=True)
class FileActuator:
    """An actuator of the file.

    Attributes:
        name: Its name; made up if it has none.
        spec: What it does; None if that is not built.
        has_activation: It has a state in `act`.
        damping_ratio: Of a servo whose damping follows from the mass that it moves; 0 for none.
    """

    name: str
    spec: ActuatorSpec | None
    has_activation: bool
    damping_ratio: float = 0.0


@dataclass(frozen=True, slots=True)
class FileCoupling:
    """A joint that follows another, or a tendon whose length follows that of another.

    Attributes:
        name: Its name; made up if it has none.
        follower: Name of the joint or tendon.
        leader: Name of the one that it follows; None if it is held.
        coefficients: Of the polynomial in the position of the leader; of a tendon in what it is longer than
            at the reference.
        enabled: It holds.
        compliance: How it yields.
    """

    name: str
    follower: str
    leader: str | None
    coefficients: tuple[float, float, float, float, float]
    enabled: bool
    compliance: Compliance


@dataclass(frozen=True, slots=True)
class FileConnection:
    """A frame on a body that coincides with one on another, or, unless it is a weld, its origin.

    Attributes:
        name: Its name; made up if it has none.
        is_weld: Axes coincide as well.
        first: Name of a body.
        first_frame: The frame in that of the body.
        second: Name of the other body, or `world`.
        second_frame: The frame in that of the other body.
        enabled: It holds.
        compliance: How it yields.
        torque_scale: What an error of the axes of a weld counts beside one of its origins [m].
    """

    name: str
    is_weld: bool
    first: str
    first_frame: Pose
    second: str
    second_frame: Pose
    enabled: bool
    compliance: Compliance
    torque_scale: float = 1.0


@dataclass(frozen=True, slots=True)
class FileFriction:
    """Dry friction of a free body.

    Attributes:
        body: Name of the body.
        friction: Greatest force along each axis of the world, and torque about each of its own [N, N m].
        compliance: How it yields.
    """

    body: str
    friction: float
    compliance: Compliance


@dataclass(frozen=True, slots=True)
class FilePart:
    """A part of the path of a tendon.

    Attributes:
        kind: What it is.
        on: Name of its body, or of its joint; empty for a pulley.
        frame: Its pose in the frame of that body.
        size: Coefficient of a joint, radius of a sphere or cylinder, or divisor of a pulley.
        side_on: Name of the body of a side site; empty if there is none.
        side: That site in the frame of that body.
    """

    kind: PathKind
    on: str
    frame: Pose = IDENTITY
    size: float = 0.0
    side_on: str = ""
    side: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class FileTendon:
    """A tendon.

    Attributes:
        name: Its name; made up if it has none.
        parts: Its path.
        robot: Name of the robot that it moves; empty if it is not simulated.
        stiffness: Of its spring.
        damping: Of its damper.
        spring_range: Lengths between which its spring is slack; None for that at the rest of all springs.
        range: Least and greatest length.
        friction: Greatest force of its friction.
        armature: Inertia along it.
        actuator_range: Bounds of the sum of its actuators' forces [N].
        limit_compliance: How its limit yields.
        limit_margin: Distance from its limit at which it begins to act [m].
        look: How it is drawn.
        stiffness_terms: Stiffness per stretch, and per its square.
    """

    name: str
    parts: tuple[FilePart, ...]
    robot: str
    stiffness: float
    damping: float
    spring_range: tuple[float, float] | None
    range: tuple[float, float]
    friction: float
    limit_compliance: Compliance = field(default_factory=Compliance)
    limit_margin: float = 0.0
    armature: float = 0.0
    actuator_range: tuple[float, float] = (-inf, inf)
    look: TendonLook | None = None
    stiffness_terms: tuple[float, float] = (0.0, 0.0)


@dataclass(eq=False, slots=True)
class CompiledModel:
    """All of a file.

    Attributes:
        name: Its name.
        robots: A robot for each body of the world, and one for all geoms of the world.
        joints: Names of all joints in the order of `qpos`, and the number of coordinates of each.
        flexes: Cables, cloth and soft solids.
        lacks: Attributes of keyframes that have numbers for what is left out, in places that are not known.
        starts: Positions of joints whose reference is not 0, by name.
        excluded: Pairs of bodies that don't collide with each other.
        paired: Pairs of bodies that collide with each other whatever their groups say, and how.
        options: Gravity, time step and other numbers and words of `<option>`, by name.
        sites: By name.
        cameras: By name.
        lights: Those that are on.
        skins: Surfaces that follow bodies.
        stage: Sky, headlight and haze.
        keyframes: By name.
        reference: Positions of all joints at the reference, as keyframes have them.
        actuators: In the order of `ctrl`.
        couplings: Of joints, by `<equality>`.
        connections: Of bodies, by `<equality>`.
        frictions: Of free bodies.
        equality_count: Number of all constraints in `<equality>`.
        tendons: By name; those that are not simulated have no robot.
        tendon_couplings: Of tendons, by `<equality>`.
        still: World poses of bodies that do not move, and of the world.
        free_weights: Inverse mass and inverse inertia of the frame of each free robot, by name.
        weight_along: Of each robot, by name, a function that gives the inverse mass along a sum of positions
            of its joints, each by its name and times a share.
        body_weights: Inverse mass and inverse inertia of each body at the reference, by name.
        joint_weights: Inverse mass of each joint at the reference, by name.
        sensors: Those that are built, in order; what they refer to has a name of its own in the whole file.
    """

    name: str = ""
    robots: list[PlacedRobot] = field(default_factory=list)
    joints: list[tuple[str, str, str]] = field(default_factory=list)
    flexes: list[FileFlex] = field(default_factory=list)
    lacks: set[str] = field(default_factory=set)
    starts: dict[str, float] = field(default_factory=dict)
    excluded: list[tuple[str, str]] = field(default_factory=list)
    paired: dict[tuple[str, str], PairContact] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)
    sites: dict[str, Site] = field(default_factory=dict)
    cameras: dict[str, FileCamera] = field(default_factory=dict)
    lights: list[FileLight] = field(default_factory=list)
    skins: list[FileSkin] = field(default_factory=list)
    stage: Stage = field(default_factory=Stage)
    keyframes: dict[str, FileKeyframe] = field(default_factory=dict)
    reference: list[float] = field(default_factory=list)
    actuators: list[FileActuator] = field(default_factory=list)
    couplings: list[FileCoupling] = field(default_factory=list)
    connections: list[FileConnection] = field(default_factory=list)
    frictions: list[FileFriction] = field(default_factory=list)
    equality_count: int = 0
    sensors: list[SensorSpec] = field(default_factory=list)
    tendons: dict[str, FileTendon] = field(default_factory=dict)
    tendon_couplings: list[FileCoupling] = field(default_factory=list)
    still: dict[str, Pose] = field(default_factory=dict)
    free_weights: dict[str, tuple[float, float]] = field(default_factory=dict)
    weight_along: dict[str, Along] = field(default_factory=dict)
    body_weights: dict[str, tuple[float, float]] = field(default_factory=dict)
    joint_weights: dict[str, float] = field(default_factory=dict)
