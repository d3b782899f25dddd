"""Inverse dynamics, mass matrix and Jacobian of a mechanism.

Recursive Newton-Euler and the composite rigid body algorithm in node frames; notation and methods:
R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5 and 6.
"""

import warp as wp

from carom.kernels.joints.coordinates import vector_at
from carom.kernels.joints.nodes import along, joint_forces, joint_motion, joint_origin, joint_turn
from carom.kernels.structs import MechanismSizes, MechanismTable
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, kernel, real
from carom.layouts.mechanism import BASE_MOTION


@func
def first_rate(sizes: MechanismSizes) -> Int32:
    """Index in `input` of the rate of dof 0, counted as if a free base's rates were there."""
    return BASE_MOTION + sizes.coordinates - sizes.base_dofs


@func
def turned_back(r: Matrix3, v: Vector3) -> Vector3:
    """The product rᵀ v."""
    return Vector3(
        r[0, 0] * v[0] + r[1, 0] * v[1] + r[2, 0] * v[2],
        r[0, 1] * v[0] + r[1, 1] * v[1] + r[2, 1] * v[2],
        r[0, 2] * v[0] + r[1, 2] * v[1] + r[2, 2] * v[2],
    )


@func
def place(mechanism: MechanismTable, node: Int32):
    """Compute the pose of a node's frame in its parent's."""
    mechanism.motion[node].turn = joint_turn(mechanism, node)
    mechanism.motion[node].origin = joint_origin(mechanism, node)


@func
def place_nodes(mechanism: MechanismTable, count: Int32):
    """Place the first `count` nodes: in a loop of its own, so that the processor overlaps iterations."""
    for node in range(1, count):
        place(mechanism, node)


@func
def newton_euler(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    omega: Vector3,
    alpha: Vector3,
    acceleration: Vector3,
    joints: Reals,
    rates: Int32,
    accelerations: Int32,
):
    """Compute the generalized forces in `output`, for the positions in `input` and the motion given.

    The motion of the base is its angular velocity, the derivative of that, and its linear acceleration minus
    gravity. `joints` has rates and accelerations of the dofs: `rates` and `accelerations` are the indices in
    it of those of dof 0, counted as if a free base's were there; `accelerations` is negative if all of them
    are 0. What the armature of a free base calls for is left out.
    """
    keep_motion(mechanism, 0, omega, alpha, acceleration)
    mechanism.motion[0].force = Vector3(0.0, 0.0, 0.0)
    mechanism.motion[0].torque = Vector3(0.0, 0.0, 0.0)
    # Reaction forces on a fixed base are not computed.
    if sizes.base_dofs > 0:
        keep_forces(mechanism, 0, omega, alpha, acceleration)
    place_nodes(mechanism, sizes.nodes)
    for node in range(1, sizes.nodes):
        parent = mechanism.node[node].parent
        # The parent of most nodes is the node before, whose motion is still in the variables.
        if parent != node - 1:
            omega = mechanism.motion[parent].omega
            alpha = mechanism.motion[parent].alpha
            acceleration = mechanism.motion[parent].acceleration
        omega, alpha, acceleration = moved_on(
            mechanism, node, omega, alpha, acceleration, joints, rates, accelerations
        )
        keep_motion(mechanism, node, omega, alpha, acceleration)
        keep_forces(mechanism, node, omega, alpha, acceleration)
    gather_forces(sizes, mechanism)
    if sizes.has_armature != 0 and accelerations >= 0:
        for dof in range(sizes.base_dofs, sizes.dofs):
            mechanism.output[dof] += mechanism.dof_armature[dof] * joints[accelerations + dof]


@func
def newton_euler_of_input(sizes: MechanismSizes, mechanism: MechanismTable, accelerations: Int32):
    """As `newton_euler`, for the motion of the base and the rates in `input`."""
    numbers = mechanism.input
    omega, alpha, acceleration = vector_at(numbers, 0), vector_at(numbers, 3), vector_at(numbers, 6)
    newton_euler(sizes, mechanism, omega, alpha, acceleration, numbers, first_rate(sizes), accelerations)


@func
def moved_on(
    mechanism: MechanismTable,
    node: Int32,
    omega: Vector3,
    alpha: Vector3,
    acceleration: Vector3,
    joints: Reals,
    rates: Int32,
    accelerations: Int32,
):
    """Compute the motion of a node in its own frame from that of its parent, which is given."""
    turn = mechanism.motion[node].turn
    swing = swing_matrix(omega, alpha)
    linear = turned_back(turn, acceleration + swing * mechanism.motion[node].origin)
    angular = turned_back(turn, omega)
    change = turned_back(turn, alpha)
    return joint_motion(mechanism, node, angular, change, linear, joints, rates, accelerations)


@func
def swing_matrix(omega: Vector3, alpha: Vector3) -> Matrix3:
    """The matrix [α]× + [ω]×[ω]×: times a point of a rotating frame, its acceleration about the origin."""
    xx, yy, zz = omega[0] * omega[0], omega[1] * omega[1], omega[2] * omega[2]
    xy, xz, yz = omega[0] * omega[1], omega[0] * omega[2], omega[1] * omega[2]
    return Matrix3(
        -(yy + zz), xy - alpha[2], xz + alpha[1],
        xy + alpha[2], -(xx + zz), yz - alpha[0],
        xz - alpha[1], yz + alpha[0], -(xx + yy),
    )  # fmt: skip


@func
def keep_motion(
    mechanism: MechanismTable, node: Int32, omega: Vector3, alpha: Vector3, acceleration: Vector3
):
    """Store the motion of a node, for its children."""
    mechanism.motion[node].omega = omega
    mechanism.motion[node].alpha = alpha
    mechanism.motion[node].acceleration = acceleration


@func
def keep_forces(
    mechanism: MechanismTable, node: Int32, omega: Vector3, alpha: Vector3, acceleration: Vector3
):
    """Store the force, and the torque about its origin, that a node needs for its motion."""
    swing = swing_matrix(omega, alpha)
    moment = mechanism.node[node].moment
    inertia = mechanism.node[node].inertia
    mechanism.motion[node].force = mechanism.node[node].mass * acceleration + swing * moment
    mechanism.motion[node].torque = (
        inertia * alpha + wp.cross(omega, inertia * omega) + wp.cross(moment, acceleration)
    )


@func
def gather_forces(sizes: MechanismSizes, mechanism: MechanismTable):
    """Sum up the forces of the nodes towards the base, and write the generalized forces to `output`.

    The first of these is NaN if any of the forces is not finite, so that only one number has to be checked.
    """
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        force = mechanism.motion[node].force
        torque = mechanism.motion[node].torque
        joint_forces(mechanism, node, torque, force)
        if node > 0:
            parent = mechanism.node[node].parent
            turn = mechanism.motion[node].turn
            force = turn * force
            mechanism.motion[parent].force += force
            mechanism.motion[parent].torque += turn * torque + wp.cross(mechanism.motion[node].origin, force)
        else:
            # The sums at the base are not finite if any force is not.
            zero = 0.0 * (force[0] + force[1] + force[2] + torque[0] + torque[1] + torque[2])
            mechanism.output[0] += zero


@func
def place_in_base(mechanism: MechanismTable, node: Int32):
    """Compute the pose of a node and the motion subspaces of its dofs in the base's frame.

    The node has been placed, and this function called for its parent. Linear velocities are those at the
    base's origin.
    """
    rotation = wp.identity(3, dtype=real)
    position = Vector3(0.0, 0.0, 0.0)
    if node > 0:
        parent = mechanism.node[node].parent
        rotation = mechanism.motion[parent].rotation * mechanism.motion[node].turn
        position = (
            mechanism.motion[parent].position
            + mechanism.motion[parent].rotation * mechanism.motion[node].origin
        )
    mechanism.motion[node].rotation = rotation
    mechanism.motion[node].position = position
    first = mechanism.node[node].first_dof
    for dof in range(first, first + mechanism.node[node].dof_count):
        angular = rotation * mechanism.dof[dof].angular
        mechanism.axis[dof].angular = angular
        mechanism.axis[dof].linear = rotation * mechanism.dof[dof].linear + wp.cross(position, angular)


@func
def composite_inertia(sizes: MechanismSizes, mechanism: MechanismTable):
    """Compute the mass matrix in `matrix`, row-major; `place_in_base` has been called for all nodes.

    Entries of two dofs on different branches are not written: they are 0 from the beginning.
    """
    for node in range(sizes.nodes):
        rotation = mechanism.motion[node].rotation
        c = mechanism.motion[node].position
        mass = mechanism.node[node].mass
        moment = rotation * mechanism.node[node].moment
        mechanism.motion[node].mass = mass
        mechanism.motion[node].moment = moment + mass * c
        mechanism.motion[node].inertia = (
            rotation * mechanism.node[node].inertia * wp.transpose(rotation)
            + shift(c, moment)
            + shift(c, 0.5 * mass * c)
        )
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        mass = mechanism.motion[node].mass
        moment = mechanism.motion[node].moment
        inertia = mechanism.motion[node].inertia
        first = mechanism.node[node].first_dof
        for dof in range(first, first + mechanism.node[node].dof_count):
            angular = mechanism.axis[dof].angular
            linear = mechanism.axis[dof].linear
            torque = inertia * angular + wp.cross(moment, linear)
            force = mass * linear + wp.cross(angular, moment)
            carrier = node + 0
            while carrier >= 0:
                first_other = mechanism.node[carrier].first_dof
                for other in range(first_other, first_other + mechanism.node[carrier].dof_count):
                    value = along(mechanism.axis[other], torque, force)
                    mechanism.matrix[dof * sizes.dofs + other] = value
                    mechanism.matrix[other * sizes.dofs + dof] = value
                carrier = mechanism.node[carrier].parent
        if node > 0:
            parent = mechanism.node[node].parent
            mechanism.motion[parent].mass += mass
            mechanism.motion[parent].moment += moment
            mechanism.motion[parent].inertia += inertia
    if sizes.has_armature != 0:
        for dof in range(sizes.dofs):
            mechanism.matrix[dof * sizes.dofs + dof] += mechanism.dof_armature[dof]


@func
def shift(c: Vector3, moment: Vector3) -> Matrix3:
    """A term of the inertia of a body shifted by c: 2 (c · moment) 1 - c momentᵀ - moment cᵀ."""
    xx, yy, zz = 2.0 * c[0] * moment[0], 2.0 * c[1] * moment[1], 2.0 * c[2] * moment[2]
    xy = c[0] * moment[1] + c[1] * moment[0]
    xz = c[0] * moment[2] + c[2] * moment[0]
    yz = c[1] * moment[2] + c[2] * moment[1]
    return Matrix3(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy)


@kernel
def inverse_dynamics_kernel(sizes: MechanismSizes, mechanism: MechanismTable):
    """Compute in `output` the generalized forces that cause the motion in `input`."""
    newton_euler_of_input(sizes, mechanism, first_rate(sizes) + sizes.dofs - sizes.base_dofs)


@func
def mass_matrix(sizes: MechanismSizes, mechanism: MechanismTable):
    """Compute the mass matrix in `matrix`, at the positions in `input`.

    Its first entry is NaN if any is not finite, so that only one number has to be checked.
    """
    place_nodes(mechanism, sizes.nodes)
    for node in range(sizes.nodes):
        place_in_base(mechanism, node)
    composite_inertia(sizes, mechanism)
    # No entry is greater than the greatest on the diagonal.
    zero = real(0.0)
    for dof in range(sizes.dofs):
        zero += 0.0 * mechanism.matrix[dof * sizes.dofs + dof]
    if wp.isnan(zero):
        mechanism.matrix[0] = zero


@kernel
def mass_matrix_kernel(sizes: MechanismSizes, mechanism: MechanismTable):
    """See `mass_matrix`."""
    mass_matrix(sizes, mechanism)


@func
def jacobian(sizes: MechanismSizes, mechanism: MechanismTable, end: Int32):
    """Compute the Jacobian of a point in `output`: three rows of linear, then three of angular velocity.

    Its first entry is NaN if any is not finite, so that only one number has to be checked.
    """
    last = mechanism.end[end].node
    place_nodes(mechanism, last + 1)
    for node in range(last + 1):
        place_in_base(mechanism, node)
    on_node = mechanism.end[end].origin + mechanism.end[end].turn * vector_at(mechanism.input, 0)
    point = mechanism.motion[last].position + mechanism.motion[last].rotation * on_node
    for entry in range(6 * sizes.dofs):
        mechanism.output[entry] = 0.0
    zero = real(0.0)
    node = last + 0
    while node >= 0:
        first = mechanism.node[node].first_dof
        for dof in range(first, first + mechanism.node[node].dof_count):
            angular = mechanism.axis[dof].angular
            linear = mechanism.axis[dof].linear + wp.cross(angular, point)
            zero += 0.0 * (linear[0] + linear[1] + linear[2])
            for row in range(3):
                mechanism.output[row * sizes.dofs + dof] = linear[row]
                mechanism.output[(3 + row) * sizes.dofs + dof] = angular[row]
        node = mechanism.node[node].parent
    if wp.isnan(zero):
        mechanism.output[0] = zero


@kernel
def jacobian_kernel(sizes: MechanismSizes, mechanism: MechanismTable, end: Int32):
    """See `jacobian`."""
    jacobian(sizes, mechanism, end)
