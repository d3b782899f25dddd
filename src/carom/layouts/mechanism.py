"""Data of the kernels of inverse dynamics, mass matrices, Jacobians and stable PD control.

A *node* is a moving joint with its rigid body: the joint's child link and all links fixed to that. Node 0 is
the base. A node's frame has its origin at the joint. Revolute joints turn about z; the directions of other
axes do not matter. All parameters of a node are constant in its frame. A *dof* is one velocity coordinate:
the six of a free base, angular before linear, then those of the joints.

Only `input` and `output` change between calls. Each is one array, which Python writes or reads as a whole.
`input` begins with the motion of the base in its own axes: angular velocity, angular acceleration, and
linear acceleration minus gravity; for a Jacobian it begins with the point. Positions, rates and accelerations
of the joints follow, as far as the kernel needs them.
"""

from carom.layouts.types import Array, Int32, Ints, Matrix3, Reals, Vector3, Vectors3, real, struct

BASE_MOTION = 9
"""Count of numbers in `input` before the positions."""
# Index in a question of `motion_kernel` where the positions begin; gravity comes first.
POSE = 3
CENTROIDAL_NUMBERS = 18
"""Count of numbers in an answer of `centroidal_kernel` before the matrices."""
CENTROIDAL_COLUMNS = 4
"""Count of its matrices."""
MOMENTUM_NUMBERS = 7
"""Count of numbers in an answer of `momentum_kernel` before the matrix."""
CENTER_NUMBERS = 4
"""Count of numbers in an answer of `center_kernel` before the velocities."""
LINK_POSE = 7
"""Count of numbers of the pose of a link frame."""
LINK_MOTION = 12
"""Count of numbers of the velocity and acceleration of a link."""
INERTIAL_PARAMETERS = 10
"""Count of the inertial parameters of a link."""


@struct
class MechanismSizes:
    """Sizes of a mechanism."""

    nodes: Int32
    coordinates: Int32
    dofs: Int32
    base_dofs: Int32  # 6 or 0; they come before those of the joints
    has_armature: Int32  # 1: some `dof_armature` is not 0


@struct
class NodeModel:
    """A joint and the rigid body it carries."""

    parent: Int32
    joint_type: Int32
    first_position: Int32
    first_dof: Int32
    dof_count: Int32
    turn: Matrix3  # rotation from its frame at position 0 to the parent's
    origin: Vector3  # in the parent's frame, at position 0
    mass: real
    moment: Vector3  # first moment of mass: mass times centre of mass
    inertia: Matrix3  # about the origin


@struct
class DofAxis:
    """Velocity of a node per unit rate of one of its dofs, at the node's origin."""

    angular: Vector3
    linear: Vector3


@struct
class EndModel:
    """Pose of a link's frame in the frame of its node; points on the link are given in it."""

    node: Int32
    turn: Matrix3
    origin: Vector3


@struct
class NodeMotion:
    """Pose, motion, forces and composite inertia of a node, in its own frame unless noted."""

    turn: Matrix3  # rotation to the parent's frame
    origin: Vector3  # in the parent's frame
    rotation: Matrix3  # rotation to the base's frame
    position: Vector3  # in the base's frame
    omega: Vector3
    alpha: Vector3
    acceleration: Vector3  # of its origin, minus gravity
    torque: Vector3
    force: Vector3
    mass: real  # of the node and all its descendants, in the base's frame; like the next two
    moment: Vector3
    inertia: Matrix3


@struct
class MechanismTable:
    """One body, and the workspace of a call."""

    node: Array[NodeModel]
    dof: Array[DofAxis]
    dof_armature: Reals  # inertia of the drive, seen at the joint
    axis: Array[DofAxis]  # the same in the base's frame, at its origin
    end: Array[EndModel]
    motion: Array[NodeMotion]
    input: Reals
    output: Reals
    matrix: Reals  # mass matrix, row-major


@struct
class MechanismBatch:
    """Questions about a mechanism in many worlds, one row for each world, and the answers.

    The parameters of nodes and dofs are used only if they differ between worlds.
    """

    question: Reals
    answer: Reals
    mass: Reals  # by world, then node; as in `NodeModel`
    moment: Vectors3
    inertia: Array[Matrix3]
    armature: Reals  # by world, then dof


@struct
class SubtreeMotion:
    """Motion of a node, and inertia, momentum and force of the node and all its descendants.

    Everything is a spatial vector or tensor about the origin of the base's frame, in its present axes.
    """

    omega: Vector3
    velocity: Vector3
    alpha: Vector3
    acceleration: Vector3  # minus gravity, for inverse dynamics
    mass: real
    moment: Vector3
    inertia: Matrix3
    flow: Matrix3  # sum of mass times velocity times position transposed
    momentum: Vector3  # linear
    torque: Vector3
    force: Vector3


@struct
class DofSweep:
    """Motion subspace of a dof and its changes, as spatial vectors like those of `SubtreeMotion`."""

    angular: Vector3
    linear: Vector3
    turn_angular: Vector3  # velocity of the parent x subspace
    turn_linear: Vector3
    swing_angular: Vector3  # acceleration of the parent x subspace + velocity of the parent x turn
    swing_linear: Vector3
    rate_angular: Vector3  # turn + velocity of the node x subspace
    rate_linear: Vector3


@struct
class SweepTable:
    """Workspace of the derivatives of a mechanism, and its link frames."""

    subtree: Array[SubtreeMotion]  # by node
    dof: Array[DofSweep]
    dof_parent: Ints  # the dof before it on the way to the base; -1 if there is none
    link: Array[EndModel]  # frames of links, the base first
    matrix: Reals  # factors of the mass matrix, row-major


@struct
class Control:
    """Targets of the joints, and workspace of the controller."""

    coordinate_target: Reals
    dof_target_rate: Reals
    dof_kp: Reals
    dof_kd: Reals
    dof_most: Reals  # maximum torque
    dof_torque: Reals  # result
    dof_acceleration: Reals
    entry_factor: Reals  # Cholesky factor of the mass matrix with the controller's damping, row-major


TASK_TARGETS = 36
"""Count of numbers in `TaskControl.question`."""


@struct
class TaskControl:
    """Targets and gains of the control of a point on a link, its workspace, and what it computes.

    Coordinates of the task are linear before angular, in world axes. `question` has gravity, pose of the
    base, wanted position, orientation, and whether there is one; wanted velocity and acceleration, and a
    force.
    """

    question: Reals
    axis_point: Reals  # in the link frame, (3,)
    axis_frequency: Reals
    axis_ratio: Reals  # damping ratio
    axis_stiffness: Reals  # row-major
    axis_error: Reals
    axis_velocity: Reals
    axis_bias: Reals
    axis_force: Reals
    axis_inertia: Reals  # row-major, like the rest
    axis_mobility: Reals
    axis_vectors: Reals
    axis_root: Reals  # of the inertia
    axis_inverse: Reals  # of the root
    axis_damping: Reals
    axis_product: Reals
    dof_pull: Reals  # error of the posture
    dof_frequency: Reals
    dof_posture: Reals
    dof_torque: Reals
    entry_factor: Reals  # lower Cholesky factor of the mass matrix
    column_jacobian: Reals  # by row of the task, then dof, like the next
    column_solved: Reals
