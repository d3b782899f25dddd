"""What kernels work on: `Settings`, `Model`, `State` and `Scratch`.

`Model` is topology and parameters, shared by all worlds; `State` and `Scratch` have a leading world
axis. A field's axis is the first word of its name: `link_mass` has one entry per link.

A *tree* is one body: a base and its links. A *dof* is one velocity coordinate; the six of the base
come first, angular before linear. *Active* dofs are those that dynamics may change: all of a
floating tree, all but the base's six of a fixed one; `tree_first_dof` is the first of them.
"""

import warp as wp

from carom.model.real import (
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Matrix3Rows,
    Quaternions,
    RealRows,
    Reals,
    TransformRows,
    Vector3,
    Vector3Rows,
    Vector4Rows,
    Vector6Rows,
    Vector8Rows,
    Vectors3,
    real,
)


@wp.struct
class Settings:
    """Engine parameters, passed to kernels by value."""

    time_step: real  # of one substep [s]
    gravity: Vector3
    iterations: Int32
    inner_iterations: Int32
    residual_threshold: real
    joint_erp: real
    contact_erp: real
    friction_erp: real
    contact_softness: real
    contact_slop: real
    restitution_threshold: real
    cone_friction: Int32
    split_impulse: Int32
    split_threshold: real
    feedback_in_world: Int32
    feedback_in_joint: Int32
    tree_count: Int32
    user_count: Int32
    constraint_count: Int32
    shape_count: Int32
    filter_count: Int32  # entries of `Shapes.filter_link_a`
    filter_both: Int32  # 1: both masks must let the other's group pass; 0: one is enough


@wp.struct
class Model:
    """Topology and parameters of every body.

    Link rows include the base of each tree, its first; `link_parent` is -1 there. Indices of links,
    dofs and positions count over all trees.
    """

    tree_first_link: Ints
    tree_link_count: Ints
    tree_first_position: Ints
    tree_position_count: Ints
    tree_first_velocity: Ints
    tree_first_dof: Ints
    tree_dof_count: Ints
    tree_fixed: Ints
    tree_first_block: Ints  # of its matrices, in rows of four columns
    tree_first_delta: Ints  # of its vectors, in blocks of four
    tree_sensor_count: Ints
    tree_constraint_count: Ints
    tree_batch: Ints  # first tree of those solved together with it for lack of constraints
    tree_linear_damping: Reals
    tree_angular_damping: Reals
    tree_max_velocity: Reals

    link_parent: Ints
    link_joint_type: Ints
    link_first_position: Ints
    link_first_dof: Ints
    link_dof_count: Ints
    link_nearest_dof: Ints  # last of the dofs that move it, -1 if none does
    link_sensor: Ints
    link_mass: Reals
    link_inertia: Vectors3  # principal moments
    link_joint_rotation: Quaternions  # inertial frame in the parent's inertial frame at position 0
    link_pivot_in_parent: Vectors3  # joint origin in the parent's inertial frame
    link_com_from_pivot: Vectors3  # centre of mass from the joint origin, in the inertial frame
    link_axis: Vectors3  # velocity per unit rate, in the inertial frame
    link_unit_axis: Vectors3
    link_planar_axis1: Vectors3  # first translation of a planar joint, in the inertial frame
    link_planar_axis2: Vectors3

    dof_parent: Ints  # next active dof towards the root, -1 at the root
    dof_damping: Reals

    constraint_kind: Ints
    constraint_tree: Ints
    constraint_link: Ints  # of a user constraint: its row
    constraint_lower: Reals
    constraint_upper: Reals
    constraint_twist: Reals
    constraint_max_impulse: Reals


@wp.struct
class State:
    """What changes from step to step, and what users set for the next one."""

    position: RealRows
    dof_velocity: RealRows
    dof_motor: Vector8Rows
    dof_pd: Vector8Rows
    dof_torque: RealRows
    dof_motor_impulse: RealRows
    link_pose: TransformRows  # of the inertial frame
    link_twist: Vector6Rows  # velocity of the centre of mass, angular velocity
    link_wrench: Vector6Rows  # force, torque about the centre of mass
    link_reaction: Vector6Rows  # force, torque of the force-torque sensor
    tree_island: IntRows  # root of its island; the next two are those of roots
    tree_iterations: IntRows
    tree_residual: RealRows
    fault_tree: IntRows  # its first entry: 1 + the tree whose velocities were not finite, 0, or OVERFLOW


@wp.struct
class Scratch:
    """Intermediate results of one step.

    Spatial quantities are in world axes and refer to the base's centre of mass: velocities and
    accelerations are those of the point of the link that is there, moments are about it.
    """

    link_pose: TransformRows
    link_offset: Vector3Rows  # centre of mass from the reference point
    link_rotation: Matrix3Rows
    link_com_inertia: Matrix3Rows  # about the centre of mass, world axes
    link_omega: Vector3Rows
    link_velocity: Vector3Rows
    link_alpha: Vector3Rows
    link_acceleration: Vector3Rows
    link_force: Vector3Rows
    link_moment: Vector3Rows
    link_composite_mass: RealRows
    link_composite_first: Vector3Rows
    link_composite_inertia: Matrix3Rows
    link_constraint_force: Vector3Rows
    link_constraint_torque: Vector3Rows

    position_start: RealRows
    dof_start_velocity: RealRows
    dof_start_torque: RealRows
    dof_angular: Vector3Rows  # motion subspace
    dof_linear: Vector3Rows
    dof_force: RealRows
    dof_acceleration: RealRows  # what inverse dynamics is asked for
    dof_inverse_pivot: RealRows

    # Matrices and vectors over the active dofs of a tree; rows are padded to whole blocks of four
    # columns, and the `entry_` arrays show the same memory column by column.
    block_factor: Vector4Rows
    block_inverse_mass: Vector4Rows
    delta_velocity: Vector4Rows
    entry_factor: RealRows
    entry_inverse_mass: RealRows
    entry_delta_velocity: RealRows

    row_constraint: IntRows
    row_place: Index4Rows  # see the PLACE_ columns in `codes`
    row_terms: Vector8Rows  # see the ROW_ columns in `codes`


@wp.struct
class Query:
    """Questions about one body that need no step, and their answers."""

    point_on_link: Vector3Rows  # its first entry: offset from the link frame, axes of the inertial frame
    dof_linear: Vector3Rows  # columns of a point's Jacobian
    dof_angular: Vector3Rows


# Scratch arrays that show another array's blocks entry by entry.
ENTRY_VIEWS = {
    "entry_factor": "block_factor",
    "entry_inverse_mass": "block_inverse_mass",
    "entry_delta_velocity": "delta_velocity",
}
