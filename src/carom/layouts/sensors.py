"""Data of the kernel that reads sensors: `SensorTable`.

`scene.sensors.native_table` fills it in; `kernels.sensors` says what sensors of each kind measure.
"""

from carom.layouts.types import Array, Int32, Ints, Quaternion, Reals, Vector3, Vector4, real, struct

# Kinds of sensors, in the order of `carom.description.sensor.SensorKind`.
TOUCH, ACCELEROMETER, VELOCIMETER, GYRO, FORCE, TORQUE, MAGNETOMETER, RANGE_FINDER = range(8)
JOINT_POSITION, JOINT_VELOCITY, JOINT_ACTUATOR_FORCE, BALL_QUATERNION, BALL_ANGULAR_VELOCITY = range(8, 13)
JOINT_LIMIT_POSITION, JOINT_LIMIT_VELOCITY, JOINT_LIMIT_FORCE = range(13, 16)
ACTUATOR_POSITION, ACTUATOR_VELOCITY, ACTUATOR_FORCE = range(16, 19)
FRAME_POSITION, FRAME_QUATERNION, FRAME_X_AXIS, FRAME_Y_AXIS, FRAME_Z_AXIS = range(19, 24)
FRAME_LINEAR_VELOCITY, FRAME_ANGULAR_VELOCITY = range(24, 26)
FRAME_LINEAR_ACCELERATION, FRAME_ANGULAR_ACCELERATION = range(26, 28)
SUBTREE_CENTER_OF_MASS, SUBTREE_LINEAR_VELOCITY, SUBTREE_LINEAR_MOMENTUM = range(28, 31)
SUBTREE_ANGULAR_MOMENTUM, CLOCK, TENDON_POSITION, TENDON_VELOCITY = range(31, 35)

# Shapes of the volumes of touch sensors, in the order of `carom.description.site.SiteShape`.
SPHERE_VOLUME, CAPSULE_VOLUME, ELLIPSOID_VOLUME, CYLINDER_VOLUME, BOX_VOLUME = range(5)


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
    """The sensors of a body, and what they show.

    `value_shown` has the numbers of all sensors of the first world, then those of the next one. The kernel is
    given the time there, where a clock is.
    """

    sensor: Array[SensorModel]
    tree_number: Ints  # trees whose links are looked at
    member_row: Ints  # links of subtrees, actuators of joints
    number_given: Reals  # length of a substep [s]
    value_shown: Reals
