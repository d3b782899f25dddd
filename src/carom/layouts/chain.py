"""Data of the kernels of inverse kinematics: the moving part of a body, and a search for a pose.

A *chain* holds the joints between the base and the ends that are to reach their targets; what is fixed
together is folded into constant frames, so that placing the ends costs as little as possible. It may
branch. Frames have their origins at the joints; those of hinges and sliders have their z axis along that of
the joint, others have the axes of the inertial frame. Everything is measured in the inertial frame of the
base.

A *column* is a freedom of a joint of the chain, and a column of the Jacobian. A *dof* is any freedom of
the body's joints, a *coordinate* any of their positions; the two differ for spherical joints, which have
three dofs and a quaternion. A field's axis is the first word of its name.
"""

from typing import TYPE_CHECKING, Any

from carom.layouts.types import (
    ArrayType,
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

if TYPE_CHECKING:
    Matrices3 = Any
else:
    Matrices3 = ArrayType(Matrix3)

# What follows PyBullet's iteration: `step_kind` of the kernel.
DAMPED, NULL_SPACE, SELECTIVE = 0, 1, 2


@struct
class ChainSizes:
    """The numbers of links, joints and so on."""

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
    origin: Vector3  # of the joint frame in that of the parent, at position 0
    turn: Quaternion
    slide: real  # motion of a prismatic joint per unit of its position
    axis: Vector3  # of a planar joint's turn; those of hinges and sliders are the z axes
    planar_axis1: Vector3
    planar_axis2: Vector3


@struct
class ColumnModel:
    """A degree of freedom of a joint of the chain."""

    dof: Int32
    low: real  # where new starts are drawn from
    high: real


@struct
class JointPlace:
    """Where the frame of a joint is."""

    position: Vector3
    rotation: Quaternion


@struct
class DofChoice:
    """The options of a dof, and its next step."""

    damping: real
    lower: real
    upper: real
    range: real
    rest: real
    step: real


@struct
class ColumnChoice:
    """The options of a column."""

    weight: real
    held: Int32  # 1 at a bound that its step would pass


if TYPE_CHECKING:
    JointModels = Any
    ColumnModels = Any
    JointPlaces = Any
    DofChoices = Any
    ColumnChoices = Any
else:
    JointModels = ArrayType(JointModel)
    ColumnModels = ArrayType(ColumnModel)
    JointPlaces = ArrayType(JointPlace)
    DofChoices = ArrayType(DofChoice)
    ColumnChoices = ArrayType(ColumnChoice)


@struct
class Chain:
    """The joints that move the ends; parents before children."""

    joint: JointModels
    end_joint: Ints  # the joint that carries it, -1 if none does
    end_offset: Vectors3  # in the frame of that joint
    end_turn: Quaternions
    column: ColumnModels
    dof_coordinate: Ints  # -1 for the dofs of spherical joints


@struct
class Search:
    """A question, and the memory that answering it needs.

    Errors come in *blocks* of three rows: the way of an end and, where it is to be turned, its turn.
    The Jacobian is stored column by column, matrices over blocks row by row.
    """

    base_pose: Reals  # position, quaternion: the targets are given in axes that have the base there
    end_given_position: Vectors3
    end_given_rotation: Quaternions
    end_target_position: Vectors3
    end_target_rotation: Quaternions
    dof: DofChoices

    coordinate_start: Reals
    coordinate_now: Reals
    coordinate_trial: Reals
    coordinate_best: Reals  # what the answer is in the end

    joint: JointPlaces
    column: ColumnChoices
    block_error: Vectors3
    block_solution: Vectors3
    entry_jacobian: Vectors3
    square_matrix: Matrices3
    spectrum_matrix: Reals  # of the selective step, number by number
    spectrum_vectors: Reals
