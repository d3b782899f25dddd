"""What quick calls need of connections and of bodies, as addresses."""

from carom.layouts.gates import Gate
from carom.layouts.model import State
from carom.layouts.quick.world import Scene
from carom.layouts.records import At, Double, Int32, Int64, Object, Read, c_record

# Numbers in a row of `State`: a pose, a twist or a wrench, and the settings of a motor.
POSE_NUMBERS = State.fields["link_pose"].entry.shape[0]
SPATIAL_NUMBERS = State.fields["link_twist"].entry.shape[0]
MOTOR_NUMBERS = State.fields["dof_motor"].entry.shape[0]


@c_record(inertial_frame=POSE_NUMBERS, from_inertial_frame=POSE_NUMBERS)
class Link:
    """A link other than a base.

    Attributes:
        inertial_frame: Its pose in the link frame.
        from_inertial_frame: The link frame in the inertial frame.
        is_turned: The two frames have different axes.
    """

    inertial_frame: Double
    from_inertial_frame: Double
    is_turned: Int64


@c_record(factors=3)
class MassTerm:
    """A part of a moment of inertia: mass / divisor * factors; see `carom.model.inertia.MassTerm`."""

    divisor: Double
    factors: Double


@c_record(terms=(3, 2))
class Moments:
    """Moments of inertia of a link's shapes as a function of the mass: for each axis the sum of two terms."""

    terms: MassTerm
    is_known: Int64


@c_record(center=3, half=3)
class Box:
    """The box around the shapes of a link, in its inertial frame.

    Attributes:
        center: Its center.
        half: Its half extents.
        is_moved: It moves with the link.
        is_turned: It rotates with the link.
    """

    center: Double
    half: Double
    is_moved: Int64
    is_turned: Int64


@c_record()
class Joint:
    """A joint.

    Attributes:
        position: Index of its first position among those of the body.
        velocity: Index of its first velocity among those of the body.
        position_count: Number of its positions, one more than of velocities if it is spherical.
        dof_count: Number of its degrees of freedom.
        has_sensor: It measures reaction forces.
        lower: Least target position.
        upper: Greatest target position.
    """

    position: Int32
    velocity: Int32
    position_count: Int32
    dof_count: Int32
    has_sensor: Int32
    lower: Double
    upper: Double


@c_record()
class Body:
    """The state of a body.

    Attributes:
        position: Of the base: 3 numbers, then 4 of its orientation; then of the joints.
        velocity: Angular, then linear; then of the joints.
        pose: Of all links, the base first.
        twist: Linear and angular velocity of each link.
        wrench: Force and torque on each link in the next step.
        motor: The motor of each degree of freedom.
        pd: The PD drive of each degree of freedom.
        torque: On each degree of freedom in the next step.
        motor_impulse: Of the last step, on each degree of freedom.
        reaction: Force and torque that sensors measure, for each link.
        links: All except the base; null until they are first needed.
        joints: All joints.
        position_count: Number of positions.
        velocity_count: Number of velocities.
        force_factor: How many times external forces act.
        link_count: Number of links, without the base.
        tree: Row of the tree.
        first_link: Row of the base.
        dynamics: A list of the `LinkDynamics` of the links, the base first.
        handle: The Python object of the body; an attribute of it is whether the base is fixed.
        derived: A dictionary of data that are derived from masses.
        moments: Of the links, the base first; null until a mass is first changed.
        boxes: Of the links, the base first; null until they are first needed.
    """

    position: At[Double]
    velocity: At[Double]
    pose: At[Double]
    twist: At[Double]
    wrench: At[Double]
    motor: At[Double]
    pd: At[Double]
    torque: At[Double]
    motor_impulse: Read[Double]
    reaction: Read[Double]
    links: At[Link]
    joints: Read[Joint]
    position_count: Int64
    velocity_count: Int64
    force_factor: Double
    link_count: Int64
    tree: Int64
    first_link: Int64
    dynamics: Object
    handle: Object
    derived: Object
    moments: Read[Moments]
    boxes: Read[Box]


@c_record()
class Client:
    """A connection: its world, its bodies by number, and its lock.

    Attributes:
        scene: The world.
        bodies: By number; null where there is none.
        body_count: Number of places in `bodies`.
        gate: The lock.
        is_held: 1 while Python has to handle all calls: its window holds steps up, or was closed.
        connection: The Python object of the connection.
        time_step: The duration of a step [s].
        reports_analytics: 1 if steps return statistics of the solver, which Python makes.
        world_bodies: A dictionary with the Python objects of the bodies, by number.
        joint_count_name: Name of an attribute of these.
        encoded_names_name: Name of an attribute of these.
    """

    scene: At[Scene]
    bodies: At[At[Body]]
    body_count: Int64
    gate: At[Gate]
    is_held: Int64
    connection: Object
    time_step: Double
    reports_analytics: Int64
    world_bodies: Object
    joint_count_name: Object
    encoded_names_name: Object
