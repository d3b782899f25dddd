"""Data of the kernels of queries: rays, nearest points, lists of contacts, sensors."""

from carom.layouts.contacts import Candidate
from carom.layouts.types import (
    Array,
    Int32,
    IntRows,
    Ints,
    Quaternion,
    Reals,
    Rows,
    Truth,
    Vector3,
    Vector4,
    Vectors3,
    real,
    struct,
)

# Link indices up to this one mean any link.
ANY_LINK = -2

# Kinds of sensors, in the order of `description.sensor.SensorKind`; `kernels.sensors` measures them.
TOUCH, ACCELEROMETER, VELOCIMETER, GYRO, FORCE, TORQUE, MAGNETOMETER, RANGE_FINDER = range(8)
JOINT_POSITION, JOINT_VELOCITY, JOINT_ACTUATOR_FORCE, BALL_QUATERNION, BALL_ANGULAR_VELOCITY = range(8, 13)
JOINT_LIMIT_POSITION, JOINT_LIMIT_VELOCITY, JOINT_LIMIT_FORCE = range(13, 16)
ACTUATOR_POSITION, ACTUATOR_VELOCITY, ACTUATOR_FORCE = range(16, 19)
FRAME_POSITION, FRAME_QUATERNION, FRAME_X_AXIS, FRAME_Y_AXIS, FRAME_Z_AXIS = range(19, 24)
FRAME_LINEAR_VELOCITY, FRAME_ANGULAR_VELOCITY = range(24, 26)
FRAME_LINEAR_ACCELERATION, FRAME_ANGULAR_ACCELERATION = range(26, 28)
SUBTREE_CENTER_OF_MASS, SUBTREE_LINEAR_VELOCITY, SUBTREE_LINEAR_MOMENTUM = range(28, 31)
SUBTREE_ANGULAR_MOMENTUM, CLOCK, TENDON_POSITION, TENDON_VELOCITY, TENDON_ACTUATOR_FORCE = range(31, 36)

# Shapes of the volumes of touch sensors, in the order of `carom.description.site.SiteShape`.
SPHERE_VOLUME, CAPSULE_VOLUME, ELLIPSOID_VOLUME, CYLINDER_VOLUME, BOX_VOLUME = range(5)


@struct
class Places:
    """Body id and link index of each link row, as users have them."""

    place_body: Ints
    place_link: Ints  # -1: the base


@struct
class ContactReport:
    """Result of a query for contacts."""

    report_body_a: Ints
    report_body_b: Ints
    report_link_a: Ints
    report_link_b: Ints
    report_point_a: Vectors3  # in world axes
    report_point_b: Vectors3
    report_normal: Vectors3  # on b, towards a
    report_distance: Reals
    report_force: Reals  # along the normal [N]
    report_force1: Reals  # along the friction directions [N]
    report_force2: Reals
    report_direction1: Vectors3
    report_direction2: Vectors3
    report_count: Ints  # in the first entry: number of contacts
    report_first: Ints  # by place among manifolds: row of the first contact, -1 for none


@struct
class Touching:
    """Contacts between chosen links and some other links, summarised for each world."""

    link_place: Ints  # by link row: its index among the chosen links, or -1
    link_other: Ints  # by link row: 1 for one of the other links, else 0
    world_number: Ints  # number of contact points
    world_touching: Array[Truth]  # whether one of them has a normal impulse
    world_impulse: Vectors3  # total impulse on the chosen links, in world axes
    world_distance: Reals  # of the deepest point
    world_deepest: Vectors3  # that point on the chosen link, in world axes
    place_touching: Array[Truth]  # by world, then chosen link: whether the link has a contact point
    place_impulse: Vectors3  # likewise: total impulse on the link, in world axes


@struct
class Searches:
    """Pairs of shapes, and the nearest points of pairs within the maximum distance."""

    search_first: IntRows
    search_second: IntRows
    search_count: IntRows  # in the first entry: number of pairs found
    search_pair: IntRows  # index of each pair found
    search_found: Rows[Candidate]  # shape b is the second


@struct
class NearestPair:
    """Pairs of shapes, the same in all worlds, and the nearest points of the nearest pair in each world."""

    pair_first: Ints  # rows of the first shapes
    pair_second: Ints
    asked_count: Ints  # in the first entry: number of pairs
    asked_distance: Reals  # in the first entry: largest distance of interest [m]
    world_found: Ints  # 1 if a pair is that near, else 0
    world_point: Vectors3  # on the second shape, in world axes
    world_normal: Vectors3  # from the second shape to the first
    world_distance: Reals  # negative if they overlap


@struct
class Rays:
    """Rays and their hits."""

    ray_start: Vectors3
    ray_end: Vectors3
    ray_shape: Ints  # -1: no hit
    ray_body: Ints  # -1: no hit
    ray_link: Ints  # -1: the base, or no hit
    ray_fraction: Reals  # 1: no hit
    ray_position: Vectors3  # 0: no hit
    ray_normal: Vectors3  # in world axes; 0: no hit
    # The last hit found so far: only hits after it count. Shape -1 for none.
    ray_last_shape: Ints
    ray_last_fraction: Reals


@struct
class SensorModel:
    """One sensor."""

    kind: Int32  # see above
    link: Int32  # row of the link of its frame, or of its joint; -1 for none
    reference_link: Int32  # row of the link of the frame it is seen from; -1 for the world
    first_value: Int32  # where its numbers begin among those of a world
    dim: Int32
    # What else it measures: row of a position, dof or actuator; or its first entry in `member_row`.
    row: Int32
    other_row: Int32  # of an actuator: the dof beside the position
    row_count: Int32
    shape: Int32  # of a touch sensor's volume
    position: Vector3  # its frame in the inertial frame of the link
    turn: Quaternion
    reference_position: Vector3
    reference_turn: Quaternion
    vector: Vector3  # magnetic field, or size of the volume
    bias: Vector4
    lower: real  # bounds of what it shows
    upper: real


@struct
class SensorTable:
    """The sensors of a body, and what they show; `scene.sensors.table` fills it in.

    `value_shown` has the numbers of all sensors of the first world, then those of the next one. The kernel is
    given the time there, where a clock is.
    """

    sensor: Array[SensorModel]
    tree_number: Ints  # trees whose links are looked at
    member_row: Ints  # links of subtrees, actuators of joints
    number_given: Reals  # length of a substep [s]
    value_shown: Reals
