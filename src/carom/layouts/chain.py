"""Data of the kernels of inverse kinematics: a kinematic chain, and the search for a pose.

A *chain* holds the joints between the base and the *ends*, the points on links that are to reach targets; it
may branch. Links that are fixed to each other are merged into constant frames, so that computing the poses of
the ends costs as little as possible. Frames have their origins at the joints; those of revolute and prismatic
joints have their z axis along the joint's, others have the axes of the inertial frame. All quantities are
measured in the inertial frame of the base.

A *dof* is a degree of freedom of any joint of the body, a *column* one of a joint of the chain: it has a
column of the Jacobian. A *coordinate* is a number of a joint's position; spherical joints have three dofs and
four coordinates, a quaternion. A field's axis is the first word of its name.
"""

from carom.layouts.types import (
    Array,
    Int32,
    Ints,
    Matrix3,
    Quaternion,
    Quaternions,
    Reals,
    Vector3,
    Vectors3,
    real,
    struct,
)

# Methods of a step of PyBullet's iteration: `step_kind` of the kernel.
DAMPED, NULL_SPACE, SELECTIVE = 0, 1, 2


@struct
class ChainSizes:
    """Sizes of a chain."""

    joints: Int32
    ends: Int32
    columns: Int32
    dofs: Int32
    coordinates: Int32


@struct
class JointModel:
    """A joint of the chain."""

    kind: Int32
    parent: Int32  # -1 is the base
    first_coordinate: Int32
    first_dof: Int32
    first_column: Int32
    origin: Vector3  # of the joint frame in the parent joint's, at position 0
    turn: Quaternion
    slide: real  # translation along z per unit of the position of a slider or screw
    axis: Vector3  # rotation axis of a planar joint; hinges, sliders and screws have z
    planar_axis1: Vector3
    planar_axis2: Vector3


@struct
class ColumnModel:
    """A degree of freedom of a joint of the chain."""

    dof: Int32
    low: real  # range of random start positions
    high: real


@struct
class JointPlace:
    """Pose of a joint's frame in the base's."""

    position: Vector3
    rotation: Quaternion


@struct
class DofChoice:
    """Options of a dof for the search, and its next step."""

    damping: real
    lower: real
    upper: real
    range: real
    rest: real
    step: real


@struct
class ColumnChoice:
    """Options of a column for the search."""

    weight: real
    held: Int32  # 1: at a bound that its step would pass


@struct
class Chain:
    """The joints that move the ends, parents before children; and the ends."""

    joint: Array[JointModel]
    end_joint: Ints  # the joint whose child link carries the end, -1 for none
    end_offset: Vectors3  # in the frame of that joint
    end_turn: Quaternions
    column: Array[ColumnModel]
    dof_coordinate: Ints  # -1 for the dofs of spherical joints


@struct
class Search:
    """Targets and options of a search for a pose, and its workspace.

    Errors are in *blocks* of three rows: the position error of an end and, if its orientation has a target,
    its rotation error. The Jacobian is stored column by column, matrices over blocks row by row.
    """

    base_pose: Reals  # position, quaternion, in the frame of the given targets
    end_given_position: Vectors3
    end_given_rotation: Quaternions
    end_target_position: Vectors3
    end_target_rotation: Quaternions
    dof: Array[DofChoice]

    coordinate_start: Reals
    coordinate_now: Reals
    coordinate_trial: Reals
    coordinate_best: Reals  # the result

    joint: Array[JointPlace]
    column: Array[ColumnChoice]
    block_error: Vectors3
    block_solution: Vectors3
    entry_jacobian: Vectors3
    square_matrix: Array[Matrix3]
    spectrum_matrix: Reals  # eigenvalue problem of the selective step, entry by entry
    spectrum_vectors: Reals
    normal_matrix: Reals  # (columns, columns + 1): normal equations, the right side last


@struct
class SearchBatch:
    """Searches for poses of a body in many worlds: the fields of `Search` that differ, and the results."""

    base_pose: Reals  # by world, then number
    end_position: Vectors3  # given targets, by world, then end
    end_rotation: Quaternions
    start: Reals  # by world, then coordinate
    best: Reals
    damping: Reals  # by world, then dof
    lower: Reals
    upper: Reals
    range: Reals
    rest: Reals
    residual: Reals  # by world: the largest distance [m] and angle [rad] that are left
