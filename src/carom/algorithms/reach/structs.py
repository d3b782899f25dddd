"""What the kernels of inverse kinematics work on: the moving part of a body, and a search for a pose.

A *chain* holds the joints between the base and the ends that are to reach their targets; what is fixed
together is folded into constant frames, so that placing the ends costs as little as possible. It may
branch. Frames have their origins at the joints; those of hinges and sliders have their z axis along that of
the joint, others have the axes of the inertial frame. Everything is measured in the inertial frame of the
base.

A *column* is a freedom of a joint of the chain, and a column of the Jacobian. A *dof* is any freedom of
the body's joints, a *coordinate* any of their positions; the two differ for spherical joints, which have
three dofs and a quaternion. A field's axis is the first word of its name.
"""

import warp as wp

from carom.model.real import Int32, Ints, Matrix3, Quaternions, Reals, Vectors3

Matrices3 = wp.array(dtype=Matrix3)


@wp.struct
class ChainSizes:
    """How many of everything there are."""

    joints: Int32
    ends: Int32
    columns: Int32
    dofs: Int32
    coordinates: Int32


@wp.struct
class Chain:
    """The joints that move the ends; parents before children."""

    joint_kind: Ints
    joint_parent: Ints  # -1 is the base
    joint_first_coordinate: Ints
    joint_first_dof: Ints
    joint_first_column: Ints
    joint_origin: Vectors3  # of the joint frame in that of the parent, at position 0
    joint_turn: Quaternions
    joint_slide: Reals  # motion of a prismatic joint per unit of its position
    joint_axis: Vectors3  # of a planar joint's turn; those of hinges and sliders are the z axes
    joint_planar_axis1: Vectors3
    joint_planar_axis2: Vectors3

    end_joint: Ints  # the joint that carries it, -1 if none does
    end_offset: Vectors3  # in the frame of that joint
    end_turn: Quaternions

    column_dof: Ints
    column_low: Reals  # where new starts are drawn from
    column_high: Reals
    dof_coordinate: Ints  # -1 for the dofs of spherical joints


@wp.struct
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
    dof_damping: Reals
    dof_lower: Reals
    dof_upper: Reals
    dof_range: Reals
    dof_rest: Reals

    coordinate_start: Reals
    coordinate_now: Reals
    coordinate_trial: Reals
    coordinate_best: Reals  # what the answer is in the end

    joint_position: Vectors3
    joint_rotation: Quaternions
    dof_step: Reals
    column_weight: Reals
    column_held: Ints  # 1 at a bound that its step would pass
    block_error: Vectors3
    block_solution: Vectors3
    entry_jacobian: Vectors3
    square_matrix: Matrices3
    spectrum_matrix: Reals  # of the selective step, number by number
    spectrum_vectors: Reals
