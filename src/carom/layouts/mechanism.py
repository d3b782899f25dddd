"""Data of the kernels of inverse dynamics, mass matrices, Jacobians and stable PD control.

A *node* is a joint that moves, with all links that move as one behind it; node 0 is the base. A node's frame
has its origin at the joint. Hinges turn about z; the other axes are as convenient. Everything about a node
is constant in its frame. A *dof* is one velocity coordinate: the six of a free base, angular before linear,
then those of the joints.

`input` and `output` are all that changes from call to call, in one piece each, so that Python writes and
reads them at once. `input` begins with the motion of the base along its own axes: angular velocity, angular
acceleration, and acceleration less gravity; or for a Jacobian with the point. Then come positions, rates and
accelerations of the joints, as far as the question has them.
"""

from typing import TYPE_CHECKING, Any

from carom.layouts.types import ArrayType, Int32, Matrix3, Reals, Vector3, real, struct

BASE_MOTION = 9
"""Numbers of `input` before the positions."""
# Where a question begins to be about the mechanism; gravity comes before.
POSE = 3


@struct
class MechanismSizes:
    """The numbers of links, joints and so on."""

    nodes: Int32
    coordinates: Int32
    dofs: Int32
    base_dofs: Int32  # 6 or 0, the first of the dofs


@struct
class NodeModel:
    """A joint and the rigid body behind it."""

    parent: Int32
    joint_type: Int32
    first_position: Int32
    first_dof: Int32
    dof_count: Int32
    turn: Matrix3  # from its frame at position 0 to the parent's
    origin: Vector3  # in the parent's frame, at position 0
    mass: real
    moment: Vector3  # mass times centre of mass
    inertia: Matrix3  # about the origin


@struct
class DofAxis:
    """What one unit of a dof does to its node, at the node's origin."""

    angular: Vector3
    linear: Vector3


@struct
class EndModel:
    """A link as points on it are given: its place in the frame of its node."""

    node: Int32
    turn: Matrix3
    origin: Vector3


@struct
class NodeMotion:
    """Where a node is and how it moves; vectors and matrices in its frame where nothing else is said."""

    turn: Matrix3  # to the parent's frame
    origin: Vector3  # in the parent's frame
    rotation: Matrix3  # to the base's frame
    position: Vector3  # in the base's frame
    omega: Vector3
    alpha: Vector3
    acceleration: Vector3  # of its origin, less gravity
    torque: Vector3
    force: Vector3
    mass: real  # of the node and all behind it, in the frame of the base
    moment: Vector3
    inertia: Matrix3


if TYPE_CHECKING:
    Nodes = Any
    DofAxes = Any
    Ends = Any
    Motions = Any
else:
    Nodes = ArrayType(NodeModel)
    DofAxes = ArrayType(DofAxis)
    Ends = ArrayType(EndModel)
    Motions = ArrayType(NodeMotion)


@struct
class MechanismTable:
    """One body, and the memory of a question about it."""

    node: Nodes
    dof: DofAxes
    axis: DofAxes  # the same in the frame of the base, at its origin
    end: Ends
    motion: Motions
    input: Reals
    output: Reals
    matrix: Reals  # the mass matrix, row after row


@struct
class Control:
    """Targets of the joints, and workspace of the controller."""

    coordinate_target: Reals
    dof_target_rate: Reals
    dof_kp: Reals
    dof_kd: Reals
    dof_most: Reals  # maximum torque
    dof_torque: Reals  # the answer
    dof_acceleration: Reals
    entry_factor: Reals  # triangular factor of the mass matrix with the controller's damping, row after row
