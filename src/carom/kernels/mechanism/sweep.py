"""Motion of a mechanism as spatial vectors in one frame, for derivatives of its dynamics.

All vectors are about the origin of the base's frame and along its present axes; this frame counts as at rest.
A dof's subspace is S; with the spatial velocity v and acceleration a of the parent of its node, its *turn* is
v x S, and its *swing* a x S + v x (v x S). Every joint has subspaces that are constant in its node's frame,
so the same formulas hold for all of them. Notation and formulas: S. Singh, R. P. Russell, P. M. Wensing,
Efficient analytical derivatives of rigid-body dynamics using spatial vector algebra, RA-L 2022, after
J. Carpentier, N. Mansard, Analytical derivatives of rigid body dynamics algorithms, RSS 2018.

The motion of a free base is that of `inverse_dynamics`: the derivative of its velocity, as a vector, in its
own axes. Forces and accelerations then do not depend on its linear velocity, which counts as 0 here unless
noted; `derivatives.py` and the other users of this module add what it contributes.
"""

import warp as wp

from carom.kernels.joints.coordinates import quaternion_at, vector_at
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.mechanism.dynamics import place_in_base, place_nodes, shift
from carom.kernels.structs import MechanismSizes, MechanismTable, SweepTable
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, real
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import BASE_MOTION, POSE


@func
def question_length(sizes: MechanismSizes) -> Int32:
    """Length of a question: gravity, pose of the base, joint positions, rates, accelerations or forces."""
    return POSE + BASE_POSITIONS + sizes.coordinates + 2 * sizes.dofs


@func
def rates_of(sizes: MechanismSizes, first: Int32) -> Int32:
    """Index of the rates in a question that begins at `first`; those of a free base are the first six."""
    return first + POSE + BASE_POSITIONS + sizes.coordinates


@func
def base_rotation(question: Reals, first: Int32) -> Matrix3:
    """Rotation from the axes of the base to the world's."""
    return rotation_matrix(wp.normalize(quaternion_at(question, first + POSE + 3)))


@func
def cross_matrix(v: Vector3) -> Matrix3:
    """The matrix of the cross product with `v`."""
    return Matrix3(0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0)


@func
def vector_of(m: Matrix3) -> Vector3:
    """The vector w with [w]x = m - transposed m."""
    return Vector3(m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1])


@func
def sweep_positions(sizes: MechanismSizes, mechanism: MechanismTable, question: Reals, first: Int32):
    """Place all nodes, at the joint positions of the question that begins at `first`."""
    for i in range(sizes.coordinates):
        mechanism.input[BASE_MOTION + i] = question[first + POSE + BASE_POSITIONS + i]
    place_nodes(mechanism, sizes.nodes)
    for node in range(sizes.nodes):
        place_in_base(mechanism, node)


@func
def base_velocity(sizes: MechanismSizes, question: Reals, first: Int32) -> Vector3:
    """Linear velocity of the base, in its own axes."""
    if sizes.base_dofs > 0:
        return vector_at(question, rates_of(sizes, first) + 3)
    return Vector3(0.0, 0.0, 0.0)


@func
def sweep_motion(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    question: Reals,
    first: Int32,
    changes: Reals,
    first_change: Int32,
    velocity: Vector3,
    lift: Vector3,
):
    """Compute motions of nodes, and subspaces of dofs with their changes; `sweep_positions` was called.

    Args:
        sizes: Sizes of the mechanism.
        mechanism: The mechanism.
        sweep: What is computed.
        question: Positions and rates.
        first: Where the question begins.
        changes: The derivatives of the rates.
        first_change: Where they begin.
        velocity: Linear velocity of the base. Unless it is 0, the acceleration of the base is the derivative
            of the components of its velocity in its own axes.
        lift: Acceleration of the world: minus gravity, or 0.
    """
    rates = rates_of(sizes, first)
    omega = Vector3(0.0, 0.0, 0.0)
    alpha = Vector3(0.0, 0.0, 0.0)
    acceleration = lift
    if sizes.base_dofs > 0:
        omega = vector_at(question, rates)
        alpha = vector_at(changes, first_change)
        acceleration += vector_at(changes, first_change + 3)
        still = Vector3(0.0, 0.0, 0.0)
        for dof in range(6):
            angular = mechanism.axis[dof].angular
            linear = mechanism.axis[dof].linear
            sweep.dof[dof].angular = angular
            sweep.dof[dof].linear = linear
            sweep.dof[dof].turn_angular = still
            sweep.dof[dof].turn_linear = still
            sweep.dof[dof].swing_angular = still
            sweep.dof[dof].swing_linear = wp.cross(lift, angular)
            sweep.dof[dof].rate_angular = wp.cross(omega, angular)
            # The change of a linear subspace is what the derivative as a vector already contains.
            sweep.dof[dof].rate_linear = wp.cross(velocity, angular)
    sweep.subtree[0].omega = omega
    sweep.subtree[0].velocity = velocity
    sweep.subtree[0].alpha = alpha
    sweep.subtree[0].acceleration = acceleration
    for node in range(1, sizes.nodes):
        parent = mechanism.node[node].parent
        # The parent of most nodes is the node before, whose motion is still in the variables.
        if parent != node - 1:
            omega = sweep.subtree[parent].omega
            velocity = sweep.subtree[parent].velocity
            alpha = sweep.subtree[parent].alpha
            acceleration = sweep.subtree[parent].acceleration
        own_omega = Vector3(0.0, 0.0, 0.0)
        own_velocity = Vector3(0.0, 0.0, 0.0)
        more_alpha = Vector3(0.0, 0.0, 0.0)
        more_acceleration = Vector3(0.0, 0.0, 0.0)
        dof = mechanism.node[node].first_dof
        behind = dof + mechanism.node[node].dof_count
        for other in range(dof, behind):
            angular = mechanism.axis[other].angular
            linear = mechanism.axis[other].linear
            turn_angular = wp.cross(omega, angular)
            turn_linear = wp.cross(omega, linear) + wp.cross(velocity, angular)
            rate = question[rates + other]
            change = changes[first_change + other]
            own_omega += rate * angular
            own_velocity += rate * linear
            more_alpha += change * angular + rate * turn_angular
            more_acceleration += change * linear + rate * turn_linear
            sweep.dof[other].angular = angular
            sweep.dof[other].linear = linear
            sweep.dof[other].turn_angular = turn_angular
            sweep.dof[other].turn_linear = turn_linear
            sweep.dof[other].swing_angular = wp.cross(alpha, angular) + wp.cross(omega, turn_angular)
            sweep.dof[other].swing_linear = (
                wp.cross(alpha, linear)
                + wp.cross(acceleration, angular)
                + wp.cross(omega, turn_linear)
                + wp.cross(velocity, turn_angular)
            )
        for other in range(dof, behind):
            angular = sweep.dof[other].angular
            linear = sweep.dof[other].linear
            sweep.dof[other].rate_angular = 2.0 * sweep.dof[other].turn_angular + wp.cross(own_omega, angular)
            sweep.dof[other].rate_linear = (
                2.0 * sweep.dof[other].turn_linear
                + wp.cross(own_omega, linear)
                + wp.cross(own_velocity, angular)
            )
        omega += own_omega
        velocity += own_velocity
        alpha += more_alpha
        acceleration += more_acceleration
        sweep.subtree[node].omega = omega
        sweep.subtree[node].velocity = velocity
        sweep.subtree[node].alpha = alpha
        sweep.subtree[node].acceleration = acceleration


@func
def sweep_inertias(sizes: MechanismSizes, mechanism: MechanismTable, sweep: SweepTable):
    """Start inertia, flow, momentum and force of each subtree with those of its node."""
    for node in range(sizes.nodes):
        rotation = mechanism.motion[node].rotation
        c = mechanism.motion[node].position
        mass = mechanism.node[node].mass
        own = rotation * mechanism.node[node].moment
        moment = own + mass * c
        inertia = (
            rotation * mechanism.node[node].inertia * wp.transpose(rotation)
            + shift(c, own)
            + shift(c, 0.5 * mass * c)
        )
        omega = sweep.subtree[node].omega
        velocity = sweep.subtree[node].velocity
        alpha = sweep.subtree[node].alpha
        acceleration = sweep.subtree[node].acceleration
        momentum = mass * velocity + wp.cross(omega, moment)
        spin = inertia * omega + wp.cross(moment, velocity)
        half = 0.5 * (inertia[0, 0] + inertia[1, 1] + inertia[2, 2])
        spread = half * wp.identity(3, dtype=real) - inertia
        sweep.subtree[node].mass = mass
        sweep.subtree[node].moment = moment
        sweep.subtree[node].inertia = inertia
        sweep.subtree[node].flow = wp.outer(velocity, moment) + cross_matrix(omega) * spread
        sweep.subtree[node].momentum = momentum
        sweep.subtree[node].force = mass * acceleration + wp.cross(alpha, moment) + wp.cross(omega, momentum)
        sweep.subtree[node].torque = (
            inertia * alpha
            + wp.cross(moment, acceleration)
            + wp.cross(omega, spin)
            + wp.cross(velocity, momentum)
        )


@func
def add_to_parent(mechanism: MechanismTable, sweep: SweepTable, node: Int32):
    """Add inertia, flow, momentum and force of a node's subtree to those of its parent, if it has one."""
    if node > 0:
        parent = mechanism.node[node].parent
        sweep.subtree[parent].mass += sweep.subtree[node].mass
        sweep.subtree[parent].moment += sweep.subtree[node].moment
        sweep.subtree[parent].inertia += sweep.subtree[node].inertia
        sweep.subtree[parent].flow += sweep.subtree[node].flow
        sweep.subtree[parent].momentum += sweep.subtree[node].momentum
        sweep.subtree[parent].torque += sweep.subtree[node].torque
        sweep.subtree[parent].force += sweep.subtree[node].force


@func
def flow_matrix(flow: Matrix3) -> Matrix3:
    """The matrix A of the bias tensor B = [[A, 0], [-p x, 0]] of a subtree, with linear momentum p.

    B v is the force of velocities, and B + transposed B the rate of the spatial inertia.
    """
    return (flow[0, 0] + flow[1, 1] + flow[2, 2]) * wp.identity(3, dtype=real) - flow


@func
def inertia_torque(sweep: SweepTable, node: Int32, angular: Vector3, linear: Vector3) -> Vector3:
    """The angular part of a subtree's inertia times a motion."""
    return sweep.subtree[node].inertia * angular + wp.cross(sweep.subtree[node].moment, linear)


@func
def inertia_force(sweep: SweepTable, node: Int32, angular: Vector3, linear: Vector3) -> Vector3:
    """The linear part of a subtree's inertia times a motion."""
    return sweep.subtree[node].mass * linear + wp.cross(angular, sweep.subtree[node].moment)
