"""Integer codes shared by kernels and Python, and what the engine has to know of each joint type."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class JointCode(IntEnum):
    """Joint types of the engine; up to `FIXED` the values are PyBullet's, which has no others."""

    REVOLUTE = 0
    PRISMATIC = 1
    SPHERICAL = 2
    PLANAR = 3
    FIXED = 4
    SCREW = 7


class ConstraintKind(IntEnum):
    """Kinds of constraint: on the joints of one tree, and those created by users."""

    MOTOR = 0
    LIMIT = 1
    SPHERICAL_MOTOR = 2
    SPHERICAL_LIMIT = 3
    USER = 4
    FRICTION = 5
    ACTUATOR = 6


class ActivationDynamics(IntEnum):
    """How the activation of an actuator follows its control."""

    NONE = 0  # it has no activation: its input is the control
    INTEGRATOR = 1  # the rate is the control
    FILTER = 2  # first order, by an Euler step
    FILTER_EXACT = 3  # first order, by its exact solution
    MUSCLE = 4  # first order, with time constants that depend on control and activation


class PathKind(IntEnum):
    """Parts of the path of a tendon."""

    JOINT = 0  # adds a share of the position of a joint
    SITE = 1  # the path goes through this point
    SPHERE = 2  # the path goes around it if it is in the way
    CYLINDER = 3  # likewise
    PULLEY = 4  # a new branch of the path begins
    BALL = 5  # adds a share of the angle by which a spherical joint is turned
    CRANK = 6  # a slider along z that a rod connects to the site that follows


class FluidShape(IntEnum):
    """What of a link feels a fluid."""

    BOX = 0  # the box of its inertia
    ELLIPSOID = 1  # one in its inertial frame
    NONE = 2


class UserConstraintKind(IntEnum):
    """Kinds of user constraint between links; the values up to `GEAR` are PyBullet's."""

    PRISMATIC = 1
    FIXED = 4
    POINT_TO_POINT = 5
    GEAR = 6
    COUPLING = 7
    TENDON = 8
    TENDON_COUPLING = 9
    TRANSMISSION = 10  # of an actuator to a tendon, or to a site
    BASE_FRICTION = 11  # dry friction of a free body, along and about three axes each


class Activity(IntEnum):
    """Sleep state of a tree."""

    ACTIVE = 0
    WANTS_SLEEP = 1  # simulated, until no tree of its island is active
    ASLEEP = 2
    WOKEN = 3  # as WANTS_SLEEP, in the first substep after being asleep
    ABSENT = 4  # not in this world: it does not move, and nothing meets it, see `engine.presence`


class FrictionBound(IntEnum):
    """How the impulses of two friction rows of a contact are bounded."""

    PYRAMID = 0  # each one
    CONE = 1  # both together
    ISOTROPIC = 2  # both together, after steps of the same size


class ShapeKind(IntEnum):
    """Kinds of collision shape; in comments the content of `Shapes.shape_size` for each."""

    SPHERE = 0  # radius
    BOX = 1  # half extents
    CAPSULE = 2  # radius, half length along z, margin of its bounding box
    CYLINDER = 3  # radius, half length along z
    PLANE = 4  # unit normal
    HULL = 5  # half extents of its bounds
    TRIANGLES = 6  # half extents of its bounds
    HEIGHTFIELD = 7  # half extents of its bounds


class Part(IntEnum):
    """Whether Bullet has a shape in a compound: its link has other shapes, or its pose is no identity."""

    ALONE = 0
    FIRST = 1  # of its link; it stands for the link where bounds of links matter
    OTHER = 2


class JointTraits(NamedTuple):
    """What of a joint type is not its motion, which is in `kernels.joints`.

    Attributes:
        dofs: Number of its velocities.
        motor: Kind of its motor. Joints with a motor can have friction, too.
        limit: Kind of its limit.
        slides: Its position is a length, not an angle.
        coordinates: Names of its positions, if it has several. Four are a quaternion, and then its velocity
            is an angular one in the axes of its link; three are an angle and two lengths.
    """

    dofs: int
    motor: ConstraintKind | None = None
    limit: ConstraintKind | None = None
    slides: bool = False
    coordinates: tuple[str, ...] = ()


_ONE_MOTOR = (1, ConstraintKind.MOTOR, ConstraintKind.LIMIT)
JOINTS: dict[JointCode, JointTraits] = {
    JointCode.REVOLUTE: JointTraits(*_ONE_MOTOR),
    JointCode.PRISMATIC: JointTraits(*_ONE_MOTOR, slides=True),
    JointCode.SPHERICAL: JointTraits(
        3,
        ConstraintKind.SPHERICAL_MOTOR,
        ConstraintKind.SPHERICAL_LIMIT,
        coordinates=("qx", "qy", "qz", "qw"),
    ),
    JointCode.PLANAR: JointTraits(3, coordinates=("angle", "x", "y")),
    JointCode.FIXED: JointTraits(0),
    JointCode.SCREW: JointTraits(*_ONE_MOTOR),
}
DOF_COUNT = {code: it.dofs for code, it in JOINTS.items()}
POSITION_COUNT = {code: len(it.coordinates) or it.dofs for code, it in JOINTS.items()}
# Joints whose positions are lengths, not angles; quaternions; an angle and two lengths.
SLIDING_JOINTS = tuple(code for code, it in JOINTS.items() if it.slides)
BALLS = tuple(code for code, count in POSITION_COUNT.items() if count > DOF_COUNT[code])
PLANES = tuple(code for code, it in JOINTS.items() if len(it.coordinates) == it.dofs > 0)
# Kinds of motor and limit by joint type.
MOTOR_KIND: dict[int, ConstraintKind] = {
    code: it.motor for code, it in JOINTS.items() if it.motor is not None
}
LIMIT_KIND: dict[int, ConstraintKind] = {
    code: it.limit for code, it in JOINTS.items() if it.limit is not None
}

# Joints that can have friction.
WITH_FRICTION = tuple(MOTOR_KIND)
# Joints that can have actuators: one motor along one axis.
DRIVEN = tuple(code for code, it in JOINTS.items() if it.motor == ConstraintKind.MOTOR)

BASE_POSITIONS = 7
BASE_VELOCITIES = 6

# Maximum number of solver rows of one constraint: three axes of a spherical joint.
MAX_ROWS_PER_CONSTRAINT = 3

# Columns of `State.dof_motor` (settings of motors) and of `State.dof_pd` (explicit PD control). Rows of
# numbers, not structs: users see them as the arrays `World.motor` and `World.pd`, states are saved with them,
# and a command writes several adjacent numbers at once (`scene.joint_motor`).
MOTOR_POSITION, MOTOR_VELOCITY, MOTOR_KP, MOTOR_KD = 0, 1, 2, 3
MOTOR_MAX_IMPULSE, MOTOR_VELOCITY_CLAMP, MOTOR_DAMPING, MOTOR_TARGET_W = 4, 5, 6, 7
# Of a joint with one degree of freedom: 1 for a servo, whose gains are stiffness [N m/rad or N/m] and damping
# [N m s/rad or N s/m], implicit in velocity; 0 for PyBullet's, which are shares of the errors per substep.
MOTOR_SERVO = 7
PD_POSITION, PD_VELOCITY, PD_KP, PD_KD, PD_MAX_FORCE = 0, 1, 2, 3, 4

# Columns of `Model.actuator_muscle`: greatest active force; length at rest of fibre and tendon; the range of
# normalised lengths in which it acts; speed at which it does not act, in lengths at rest per second; passive
# force at the end of this range and active force when lengthened fast, per greatest active force.
MUSCLE_FORCE, MUSCLE_FIBRE, MUSCLE_TENDON, MUSCLE_SHORTEST = 0, 1, 2, 3
MUSCLE_LONGEST, MUSCLE_SPEED, MUSCLE_PASSIVE, MUSCLE_LENGTHENING = 4, 5, 6, 7

# Columns of `PairRows.contact_rows`, the rows of a contact; -1 for none.
NORMAL_ROW, LATERAL_ROW, ROLLING_ROW, SPINNING_ROW = 0, 1, 2, 3

# What `Shapes.shape_columns`, which is for height fields, says of a hull whose margin is a part of it.
ROUNDED = 1

# Kernels read codes as Warp constants.
REVOLUTE, PRISMATIC, SPHERICAL, PLANAR, FIXED, SCREW = map(int, JointCode)
MOTOR, LIMIT, SPHERICAL_MOTOR, SPHERICAL_LIMIT, USER, FRICTION, ACTUATOR = map(int, ConstraintKind)
UNFILTERED, INTEGRATOR, FILTER, FILTER_EXACT, MUSCLE = map(int, ActivationDynamics)
USER_PRISMATIC, USER_FIXED, USER_POINT_TO_POINT, USER_GEAR, USER_COUPLING = map(
    int, tuple(UserConstraintKind)[:5]
)
USER_TENDON, USER_TENDON_COUPLING, USER_TRANSMISSION, USER_BASE_FRICTION = map(
    int, tuple(UserConstraintKind)[5:]
)
PATH_JOINT, PATH_SITE, PATH_SPHERE, PATH_CYLINDER, PATH_PULLEY, PATH_BALL, PATH_CRANK = map(int, PathKind)
IN_FLUID_AS_BOX, IN_FLUID_AS_ELLIPSOID, NOT_IN_FLUID = map(int, FluidShape)
ACTIVE, WANTS_SLEEP, ASLEEP, WOKEN, ABSENT = map(int, Activity)
CONE = int(FrictionBound.CONE)
ISOTROPIC = int(FrictionBound.ISOTROPIC)
SPHERE, BOX, CAPSULE, CYLINDER, PLANE, HULL, TRIANGLES, HEIGHTFIELD = map(int, ShapeKind)
ALONE, FIRST_PART, OTHER_PART = map(int, Part)

# What `Shapes.shape_columns` says of a hull whose vertices are those of facets of an ellipsoid. Its size has
# the half axes of that, and its core a kind of its own.
ELLIPSOID_FACETS, ELLIPSOID = 2, 8

# What it says of a hull after whose vertices rows follow that say which are beside each other, see
# `geometry.hull_graph`; and how many of its vertices a search looks at before it climbs from the farthest.
WITH_GRAPH, FIRST_LOOKED_AT = 3, 32

# Purposes of `kernels.dynamics.dynamics.link_bias_forces`.
FREE_MOTION, CONSTRAINT_FEEDBACK, LAST_STEP = 0, 1, 2

# Frames of external forces; the values are PyBullet's.
LINK_FRAME, WORLD_FRAME = 1, 2

# Bits of `LinkModel.sensor`: Bullet's force-torque sensor, and what sensors of sites need.
SENSED, LOADED, LIMITED = 1, 2, 4
