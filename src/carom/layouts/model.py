"""Data of the kernels of a step: `Settings`, `Model`, `State` and `Scratch`.

`Model` is topology and parameters. Topology is shared by all worlds; parameters, `State` and `Scratch`
have a leading world axis. Quantities that are used together are fields of one struct per tree, link,
dof, constraint or row, so that a kernel reads them from one address. Fields of a world state their axis
and whether they are state, parameter or cache: `Model.link` and `State.link_pose` have one entry per link.

A *tree* is one body: a base and its links. A *dof* is one velocity coordinate; the six of the base
come first, angular before linear. *Active* dofs are those that dynamics may change: all of a
floating tree, the joint dofs of a fixed one; `tree_first_dof` is the first of them.
"""

from carom.layouts.types import (
    Array,
    Int32,
    IntRows,
    Matrix3,
    Quaternion,
    RealRows,
    Rows,
    TransformRows,
    Vector3,
    Vector3Rows,
    Vector4Rows,
    Vector6Rows,
    Vector8Rows,
    cache,
    parameter,
    real,
    state,
    struct,
)

# Value of `Settings.looks_ahead` if all shapes do.
EVERY_SHAPE = 2


@struct
class Settings:
    """Engine parameters, passed to kernels by value."""

    time_step: real  # of one substep [s]
    duration: real  # of a step [s]
    iterations: Int32
    inner_iterations: Int32
    residual_threshold: real
    joint_erp: real
    contact_erp: real
    friction_erp: real
    contact_softness: real
    contact_slop: real
    contact_warm_starting: real
    restitution_threshold: real
    cone_friction: Int32
    split_impulse: Int32
    split_threshold: real
    feedback_in_world: Int32
    feedback_in_joint: Int32
    minimum_island_size: Int32
    # 1: contacts are relaxed in the order of their links, see `kernels.solver.contact_order`
    order_by_links: Int32
    tree_count: Int32
    link_count: Int32
    user_count: Int32
    constraint_count: Int32
    shape_count: Int32
    filter_count: Int32  # entries of `Shapes.filter_link_a`
    has_pair_contacts: Int32  # 1: some pair of links has contacts of its own, see `Shapes.filter_impedance`
    # 1: some shape has a swept sphere, see `kernels.contact.bounds`; or `EVERY_SHAPE`.
    looks_ahead: Int32
    near: real  # gap between bounds up to which Bullet takes them for overlapping: it widens both [m]
    # 1: forces are those of the positions and velocities before the substep, see `kernels.integrators`.
    explicit_forces: Int32
    filter_both: Int32  # 1: both masks must let the other's group pass; 0: one is enough


@struct
class TreeModel:
    """One body: a base and its links."""

    first_link: Int32
    link_count: Int32
    first_position: Int32
    position_count: Int32
    first_velocity: Int32
    first_dof: Int32
    dof_count: Int32
    fixed: Int32
    first_block: Int32  # first block of its matrices; a block is four columns of a row
    first_delta: Int32  # first block of four entries of its vectors
    sensor_count: Int32  # links with `LinkModel.sensor`
    sensed_count: Int32  # those of them with `codes.SENSED`
    first_late: Int32  # first row of its links with late velocities, see `kernels.late`
    late_count: Int32  # those links: all but the base, or none
    is_followed: Int32  # 1: each step keeps its motion in the state, for sensors
    constraint_count: Int32
    batch: Int32  # first tree of its batch: small islands that are solved together
    first_constraint: Int32  # first constraint of its batch, if it is the first tree of one
    batch_constraints: Int32  # constraints of its batch, if it is the first tree of one; else 0
    first_actuator: Int32
    actuator_count: Int32
    can_sleep: Int32
    can_wake: Int32  # 1: wakes up when it moves
    sleep_threshold: real  # it may fall asleep after a time with its sum of squared velocities below this


@struct
class LinkModel:
    """One link, or the base of a tree, and the joint to its parent."""

    parent: Int32  # -1 for a base
    joint_type: Int32
    first_position: Int32
    first_dof: Int32
    dof_count: Int32
    nearest_dof: Int32  # last dof on the path from the root to this link, -1 for none
    sensor: Int32  # bits: see `codes.SENSED`, `codes.LOADED`, `codes.LIMITED`
    number: Int32  # among the links that can move, in Bullet's order; -1 if it cannot
    fluid: Int32  # what feels the fluid: see `codes.FluidShape`
    joint_rotation: Quaternion  # of the inertial frame in the parent's inertial frame, at position 0
    pivot_in_parent: Vector3  # joint origin in the parent's inertial frame
    com_from_pivot: Vector3  # centre of mass from the joint origin, in the inertial frame
    axis: Vector3  # angular or linear velocity per unit of the joint's rate, in the inertial frame
    unit_axis: Vector3
    # First translation of a planar joint, or that of a screw per radian, in the inertial frame.
    planar_axis1: Vector3
    planar_axis2: Vector3


@struct
class DofModel:
    """One velocity coordinate."""

    parent: Int32  # next active dof towards the root, -1 for none


@struct
class ConstraintModel:
    """One joint motor, joint limit or user constraint."""

    kind: Int32
    tree: Int32
    link: Int32  # of a user constraint: its row in `UserConstraints`
    place: Int32  # in Bullet's order, before it is sorted by island
    actuator: Int32  # its row, if it is one


@struct
class ActuatorModel:
    """One actuator."""

    dynamics: Int32  # see `codes.ActivationDynamics`
    is_muscle: Int32  # 1: its force is that of a muscle, not affine
    is_early: Int32  # 1: it acts with the activation at the end of the substep, not that at its beginning
    # Of actuators of one joint or tendon whose sum has bounds: how many rows before it the first one is,
    # which has the row of all actuators of a joint, and how many rows after it the next one is; 0 for none.
    follows: Int32
    to_next: Int32
    pulled: Int32  # link that it pulls towards all that touches it, the base being 1; 0 for none


@struct
class Model:
    """Topology and parameters of every body.

    The first link row of a tree is its base. Indices of links, dofs and positions count over all trees.
    All worlds share the topology. Parameters that may differ between worlds have a leading world axis, with
    one row for each world, or a single row shared by all worlds.
    """

    tree: Array[TreeModel] = parameter("tree")
    link: Array[LinkModel] = parameter("link")
    dof: Array[DofModel] = parameter("dof")
    constraint: Array[ConstraintModel] = parameter("constraint")
    actuator: Array[ActuatorModel] = parameter("actuator")

    gravity_vector: Vector3Rows = parameter("gravity")  # in the first entry [m/s²]
    # In the first entries; see `kernels.dynamics.fluid`.
    fluid_density: RealRows = parameter("fluid")  # [kg/m³]
    fluid_viscosity: RealRows = parameter("fluid")  # [Pa s]
    fluid_wind: Vector3Rows = parameter("fluid")  # velocity of the fluid in world axes [m/s]
    tree_linear_damping: RealRows = parameter("tree")
    tree_angular_damping: RealRows = parameter("tree")
    tree_max_velocity: RealRows = parameter("tree")
    link_mass: RealRows = parameter("link")
    link_inertia: Vector3Rows = parameter("link")  # principal moments
    # share of its weight that a force at its centre of mass carries
    link_gravity_compensation: RealRows = parameter("link")
    # Of links that the fluid sees as ellipsoids: semi-axes and coefficients, as in `FluidEllipsoid`; added
    # mass and inertia, per density.
    link_fluid_shape: Vector8Rows = parameter("link")
    link_fluid_added: Vector6Rows = parameter("link")
    # not 0: some joint has armature, implicit damping or a spring
    tree_joint_terms: RealRows = parameter("tree")
    dof_damping: RealRows = parameter("dof")  # explicit, as PyBullet's
    dof_armature: RealRows = parameter("dof")  # inertia of the drive, seen at the joint
    dof_implicit_damping: RealRows = parameter("dof")
    dof_stiffness: RealRows = parameter("dof")
    # position at which the joint's spring is at rest; of a ball a quaternion
    position_spring: RealRows = parameter("position")
    constraint_lower: RealRows = parameter("constraint")
    constraint_upper: RealRows = parameter("constraint")
    constraint_twist: RealRows = parameter("constraint")
    constraint_max_impulse: RealRows = parameter("constraint")
    # Of limits and friction that yield, see `kernels.dynamics.yielding`.
    constraint_reference: Vector4Rows = parameter("constraint")
    constraint_impedance: Vector4Rows = parameter("constraint")
    # distance from a limit at which it begins to act [rad or m]
    constraint_margin: RealRows = parameter("constraint")
    # Force = (gain · terms) input + bias · terms, where the terms are 1, length and velocity of the actuator.
    actuator_gain: Vector3Rows = parameter("actuator")
    actuator_bias: Vector3Rows = parameter("actuator")
    actuator_gear: RealRows = parameter("actuator")  # length per position of the joint
    actuator_control_lower: RealRows = parameter("actuator")
    actuator_control_upper: RealRows = parameter("actuator")
    actuator_force_lower: RealRows = parameter("actuator")
    actuator_force_upper: RealRows = parameter("actuator")
    # Of the force of all actuators of its joint on it, or of the sum of those of its tendon.
    actuator_joint_lower: RealRows = parameter("actuator")
    actuator_joint_upper: RealRows = parameter("actuator")
    actuator_activation_lower: RealRows = parameter("actuator")
    actuator_activation_upper: RealRows = parameter("actuator")
    actuator_time_constant: RealRows = parameter("actuator")  # of a filter, or of a muscle's activation [s]
    actuator_muscle: Vector8Rows = parameter("actuator")  # columns: see `codes`
    # of its deactivation [s]; width of the transition between both
    actuator_muscle_time: Vector3Rows = parameter("actuator")


@struct
class State:
    """Data that change in each step, and inputs for the next step."""

    position: RealRows = state("position", bounded=True)
    dof_velocity: RealRows = state("dof", bounded=True)
    dof_motor: Vector8Rows = state("dof", joints=True)
    dof_pd: Vector8Rows = state("dof", joints=True)
    dof_torque: RealRows = state("dof")
    dof_motor_impulse: RealRows = state("dof")
    # Of joints of trees with sensors, in the last substep: of all own rows of the joint, of its limits.
    dof_joint_impulse: RealRows = state("dof")
    dof_limit_impulse: RealRows = state("dof")
    link_pose: TransformRows = state("link", bounded=True)  # of the inertial frame
    # linear velocity of the centre of mass, angular velocity
    link_twist: Vector6Rows = state("link", bounded=True)
    link_wrench: Vector6Rows = state("link")  # external force, torque about the centre of mass
    link_reaction: Vector6Rows = state("link")  # force-torque sensor: force, torque
    # the same without Bullet's errors, see `kernels.dynamics.feedback`
    link_load: Vector6Rows = state("link")
    # Of links with late velocities, in world axes: linear velocity of the centre of mass and angular velocity
    # that the next substep takes them to have, and the part of it that is by their joints.
    late_velocity: Vector6Rows = state("late", bounded=True)
    late_joint: Vector6Rows = state("late", bounded=True)
    tree_island: IntRows = state("tree")  # root of its island
    tree_iterations: IntRows = state("tree")  # sweeps of the solver; in the row of the island's root
    tree_residual: RealRows = state("tree", may_be_nan=True)  # likewise
    tree_activity: IntRows = state("tree")  # see `codes.Activity`
    tree_wants_sleep: IntRows = state("tree")  # 1: falls asleep as soon as no tree of its island is active
    tree_idle_time: RealRows = state("tree")  # time with velocities below its sleep threshold [s]
    # Number of the last reset that moved it, negative, or of the first one since a step; see `RESETS`.
    tree_reset: IntRows = state("tree")
    # Of trees that are followed: coordinates and velocities before and after the last step, its gravity
    # [m/s²] and its duration [s], which is 0 without a step.
    position_before: RealRows = state("position", bounded=True)
    position_after: RealRows = state("position", bounded=True)
    dof_velocity_before: RealRows = state("dof", bounded=True)
    dof_velocity_after: RealRows = state("dof", bounded=True)
    tree_last_step: Vector4Rows = state("tree", bounded=True)
    # Of trees whose loads have not been found yet, see `kernels.sensors.last_loads`: gravity and duration of
    # the step, else 0; the accelerations of joints without constraints, and the forces of couplings along
    # them; the wrenches by the user, and by contacts and constraints if `tree_is_pushed`, on links.
    tree_load_step: Vector4Rows = state("tree", bounded=True)
    tree_is_pushed: IntRows = state("tree")
    dof_acceleration: RealRows = state("dof", bounded=True)
    dof_coupling: RealRows = state("dof", bounded=True)
    link_applied: Vector6Rows = state("link", bounded=True)
    link_push: Vector6Rows = state("link", bounded=True)
    # by tree: first tree of those that Bullet sweeps over together with it
    batch_tree: IntRows = cache("batch")
    batch_constraint: IntRows = cache("batch")  # constraints in the order of relaxation
    user_impulse: Vector6Rows = state("user")  # of the last substep, by row of the user constraint
    node_position: Vector3Rows = state("node", bounded=True)  # nodes of soft bodies, see `layouts.soft`
    node_velocity: Vector3Rows = state("node", bounded=True)
    node_force: Vector3Rows = state("node")
    node_push: Vector3Rows = state("node")  # contact force by shapes in the last substep [N]
    actuator_control: RealRows = state("actuator", bounded=True)
    actuator_activation: RealRows = state("actuator", bounded=True)
    actuator_force: RealRows = state("actuator", bounded=True)  # in the last substep
    sensor_memory: RealRows = state("sensor", bounded=True)  # see `scene.sensors.memory`
    status_entry: IntRows = cache("status")  # result of the last step: see `layouts.status`


@struct
class LinkScratch:
    """Motion, inertia and forces of one link.

    Spatial quantities are in world axes, with the base's centre of mass as reference point: velocities and
    accelerations are those of the link's point there, moments are about it.
    """

    offset: Vector3  # from the reference point to the centre of mass
    rotation: Matrix3
    com_inertia: Matrix3  # about the centre of mass, world axes
    omega: Vector3
    velocity: Vector3
    alpha: Vector3
    acceleration: Vector3
    force: Vector3
    moment: Vector3
    composite_mass: real
    composite_first: Vector3
    composite_inertia: Matrix3
    constraint_force: Vector3
    constraint_torque: Vector3
    slide_torque: Vector3  # what Bullet leaves out of it, see `kernels.dynamics.feedback`
    # What the links up to a leaf need for free motion without accelerations of joints, and for these.
    free_force: Vector3
    free_moment: Vector3
    inertial_force: Vector3
    inertial_moment: Vector3
    # The part of `State.link_wrench` that adhesion applies in this substep.
    pull: Vector3
    pull_torque: Vector3


@struct
class TreeScratch:
    """Island, results of the solver and sleep state of a tree at the start of the step."""

    start_island: Int32
    start_iterations: Int32
    start_residual: real
    start_activity: Int32
    start_wants_sleep: Int32
    start_idle_time: real
    is_pushed: Int32  # 1: `LinkScratch.constraint_force` has forces of contacts or user constraints


@struct
class DofScratch:
    """Motion subspace and force of one dof."""

    start_velocity: real  # at the start of the step
    # Of the last substep, without constraints: `force` is working memory, which sensors use once more.
    free_acceleration: real
    start_torque: real
    start_motor_impulse: real
    start_joint_impulse: real
    start_limit_impulse: real
    coupling: real  # force or torque of couplings of joints, of trees with sensors
    angular: Vector3  # motion subspace
    linear: Vector3
    force: real
    inverse_pivot: real


@struct
class RowScratch:
    """One constraint row that acts on a single dof."""

    constraint: Int32
    entry: Int32  # its dof's place in `entry_delta_velocity`
    delta: Int32  # first block of its tree in `delta_velocity`
    response: Int32  # first block of `block_response`
    blocks: Int32
    soft: Int32  # 1: `Scratch.row_share` and `Scratch.row_softness` count
    change: real  # requested change of the dof's rate
    effective_mass: real
    lower: real  # bounds of the impulse
    upper: real
    impulse: real


@struct
class Scratch:
    """Intermediate results of one step."""

    tree: Rows[TreeScratch]
    link: Rows[LinkScratch]
    link_pose: TransformRows  # like `State.link_pose`, but for other coordinates or of the last substep
    # like `State.link_pose`: by `lane_motion_kernel`, until the substep takes it
    link_pose_free: TransformRows
    dof: Rows[DofScratch]
    position_start: RealRows  # at the start of the step, like the next three
    link_pose_start: TransformRows
    link_reaction_start: Vector6Rows
    link_load_start: Vector6Rows
    late_velocity_start: Vector6Rows
    late_joint_start: Vector6Rows
    user_impulse_start: Vector6Rows

    # Matrices and vectors over the active dofs of a tree; rows are padded to whole blocks of four
    # columns. The `entry_` arrays are views of the same memory, entry by entry.
    block_factor: Vector4Rows
    block_inverse_mass: Vector4Rows
    # Joint-space inertia of a substep, laid out as `block_factor`, where something asks for room for it: the
    # converged solver, and integrators that count damping at the end.
    mass_block: Vector4Rows
    block_response: Vector4Rows  # response to the impulse that changes the rate of a row's dof by 1
    delta_velocity: Vector4Rows
    # Equations of rows that are solved for at once, see `kernels.convergence.active_set`; response
    # to one of them.
    equation_block: Vector4Rows
    delta_column: Vector4Rows
    entry_factor: RealRows
    entry_inverse_mass: RealRows
    entry_delta_velocity: RealRows
    entry_system: RealRows
    entry_column: RealRows

    row: Rows[RowScratch]
    # Of rows that are soft: share of its rate that a row corrects at once, and of that the part for each
    # unit of its impulse.
    row_share: RealRows
    row_softness: RealRows
    actuator_start: RealRows  # activation at the start of the step
    actuator_force_start: RealRows


# Scratch arrays that are views of another array's blocks, entry by entry.
ENTRY_VIEWS = {
    "entry_factor": "block_factor",
    "entry_inverse_mass": "block_inverse_mass",
    "entry_delta_velocity": "delta_velocity",
    "entry_system": "equation_block",
    "entry_column": "delta_column",
}
