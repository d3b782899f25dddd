"""Inverse dynamics, mass matrix and Jacobian of a tree.

Recursive Newton-Euler and the composite rigid body algorithm in node frames; notation and methods:
R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5 and 6.
"""

import warp as wp

from carom.kernels.maths.rotation import axis_rotation, rotation_matrix
from carom.kernels.structs import Tree, TreeSizes
from carom.kernels.types import Int32, Matrix3, Quaternion, Reals, Vector3, func, kernel, real
from carom.layouts.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL
from carom.layouts.moving_tree import BASE_MOTION


@func
def vector_at(numbers: Reals, first: Int32) -> Vector3:
    """Three numbers of an array."""
    return Vector3(numbers[first], numbers[first + 1], numbers[first + 2])


@func
def first_rate(sizes: TreeSizes) -> Int32:
    """Where in `input` the rate of dof 0 would be: those of a free base are not there."""
    return BASE_MOTION + sizes.coordinates - sizes.base_dofs


@func
def turned_about_z(r: Matrix3, angle: real) -> Matrix3:
    """A rotation after a turn about its own z axis."""
    s = wp.sin(angle)
    c = wp.cos(angle)
    return Matrix3(
        r[0, 0] * c + r[0, 1] * s, r[0, 1] * c - r[0, 0] * s, r[0, 2],
        r[1, 0] * c + r[1, 1] * s, r[1, 1] * c - r[1, 0] * s, r[1, 2],
        r[2, 0] * c + r[2, 1] * s, r[2, 1] * c - r[2, 0] * s, r[2, 2],
    )  # fmt: skip


@func
def turned_back(r: Matrix3, v: Vector3) -> Vector3:
    """The product rᵀ v."""
    return Vector3(
        r[0, 0] * v[0] + r[1, 0] * v[1] + r[2, 0] * v[2],
        r[0, 1] * v[0] + r[1, 1] * v[1] + r[2, 1] * v[2],
        r[0, 2] * v[0] + r[1, 2] * v[1] + r[2, 2] * v[2],
    )


@func
def joint_turn(tree: Tree, node: Int32) -> Matrix3:
    """The rotation from the frame of a node to its parent's, from the positions of its joint."""
    turn = tree.node[node].turn
    kind = tree.node[node].joint_type
    q = BASE_MOTION + tree.node[node].first_position
    if kind == REVOLUTE:
        return turned_about_z(turn, tree.input[q])
    if kind == SPHERICAL:
        rotation = Quaternion(tree.input[q], tree.input[q + 1], tree.input[q + 2], tree.input[q + 3])
        return turn * rotation_matrix(wp.normalize(rotation))
    if kind == PLANAR:
        axis = wp.normalize(tree.dof[tree.node[node].first_dof].angular)
        return turn * rotation_matrix(axis_rotation(axis, tree.input[q]))
    return turn


@func
def joint_origin(tree: Tree, node: Int32) -> Vector3:
    """The origin of a node in the frame of its parent, from the positions of its joint."""
    origin = tree.node[node].origin
    kind = tree.node[node].joint_type
    q = BASE_MOTION + tree.node[node].first_position
    dof = tree.node[node].first_dof
    if kind == PRISMATIC:
        return origin + tree.node[node].turn * (tree.dof[dof].linear * tree.input[q])
    if kind == PLANAR:
        # The translations are measured along axes that do not turn with the joint.
        slide = tree.dof[dof + 1].linear * tree.input[q + 1] + tree.dof[dof + 2].linear * tree.input[q + 2]
        return origin + tree.node[node].turn * slide
    return origin


@func
def place(tree: Tree, node: Int32):
    """Find the frame of a node in its parent's."""
    tree.motion[node].turn = joint_turn(tree, node)
    tree.motion[node].origin = joint_origin(tree, node)


@func
def place_nodes(tree: Tree, count: Int32):
    """Find the frames of the first nodes but the base: in one loop, so that several are under way at once."""
    for node in range(1, count):
        place(tree, node)


@func
def newton_euler(
    sizes: TreeSizes,
    tree: Tree,
    omega: Vector3,
    alpha: Vector3,
    acceleration: Vector3,
    joints: Reals,
    rates: Int32,
    accelerations: Int32,
):
    """Leave the forces of the dofs in `output`, from the positions in `input` and what is given.

    Args:
        sizes: Sizes of the tree.
        tree: The tree.
        omega: Angular velocity of the base.
        alpha: Its derivative.
        acceleration: Acceleration of the base less gravity.
        joints: Numbers about the dofs.
        rates: Where among them the rate of dof 0 is, or would be.
        accelerations: The same for accelerations; negative where all of them are 0.
    """
    keep_motion(tree, 0, omega, alpha, acceleration)
    tree.motion[0].force = Vector3(0.0, 0.0, 0.0)
    tree.motion[0].torque = Vector3(0.0, 0.0, 0.0)
    # What holds a fixed base is not asked for.
    if sizes.base_dofs > 0:
        keep_forces(tree, 0, omega, alpha, acceleration, swing_matrix(omega, alpha))
    place_nodes(tree, sizes.nodes)
    for node in range(1, sizes.nodes):
        parent = tree.node[node].parent
        # Most nodes hang on the one before, whose motion is still at hand.
        if parent != node - 1:
            omega = tree.motion[parent].omega
            alpha = tree.motion[parent].alpha
            acceleration = tree.motion[parent].acceleration
        omega, alpha, acceleration = moved_on(
            tree, node, omega, alpha, acceleration, joints, rates, accelerations
        )
        keep_motion(tree, node, omega, alpha, acceleration)
        keep_forces(tree, node, omega, alpha, acceleration, swing_matrix(omega, alpha))
    gather_forces(sizes, tree)


@func
def moved_on(
    tree: Tree,
    node: Int32,
    omega: Vector3,
    alpha: Vector3,
    acceleration: Vector3,
    joints: Reals,
    rates: Int32,
    accelerations: Int32,
):
    """The motion of a node, in its own frame, by that of its parent."""
    turn = tree.motion[node].turn
    swing = swing_matrix(omega, alpha)
    linear = turned_back(turn, acceleration + swing * tree.motion[node].origin)
    angular = turned_back(turn, omega)
    change = turned_back(turn, alpha)
    dof = tree.node[node].first_dof
    if tree.node[node].joint_type == REVOLUTE:
        per_rate = tree.dof[dof].angular[2]
        spin = per_rate * joints[rates + dof]
        spin_up = real(0.0)
        if accelerations >= 0:
            spin_up = per_rate * joints[accelerations + dof]
        return (
            Vector3(angular[0], angular[1], angular[2] + spin),
            Vector3(change[0] + angular[1] * spin, change[1] - angular[0] * spin, change[2] + spin_up),
            linear,
        )
    if tree.node[node].joint_type == PRISMATIC:
        axis = tree.dof[dof].linear
        linear += wp.cross(2.0 * angular, axis * joints[rates + dof])
        if accelerations >= 0:
            linear += axis * joints[accelerations + dof]
        return angular, change, linear
    if tree.node[node].joint_type == SPHERICAL:
        own = vector_at(joints, rates + dof)
        if accelerations >= 0:
            change += vector_at(joints, accelerations + dof)
        return angular + own, change + wp.cross(angular, own), linear
    joint_omega = Vector3(0.0, 0.0, 0.0)
    joint_velocity = Vector3(0.0, 0.0, 0.0)
    for other in range(dof, dof + tree.node[node].dof_count):
        rate = joints[rates + other]
        joint_omega += tree.dof[other].angular * rate
        joint_velocity += tree.dof[other].linear * rate
        if accelerations >= 0:
            change += tree.dof[other].angular * joints[accelerations + other]
            linear += tree.dof[other].linear * joints[accelerations + other]
    return (
        angular + joint_omega,
        change + wp.cross(angular, joint_omega),
        linear + wp.cross(2.0 * angular + joint_omega, joint_velocity),
    )


@func
def swing_matrix(omega: Vector3, alpha: Vector3) -> Matrix3:
    """What takes a place in a turning frame to its acceleration against the origin of the frame."""
    xx, yy, zz = omega[0] * omega[0], omega[1] * omega[1], omega[2] * omega[2]
    xy, xz, yz = omega[0] * omega[1], omega[0] * omega[2], omega[1] * omega[2]
    return Matrix3(
        -(yy + zz), xy - alpha[2], xz + alpha[1],
        xy + alpha[2], -(xx + zz), yz - alpha[0],
        xz - alpha[1], yz + alpha[0], -(xx + yy),
    )  # fmt: skip


@func
def keep_motion(tree: Tree, node: Int32, omega: Vector3, alpha: Vector3, acceleration: Vector3):
    """Keep the motion of a node, for the nodes that hang on it."""
    tree.motion[node].omega = omega
    tree.motion[node].alpha = alpha
    tree.motion[node].acceleration = acceleration


@func
def keep_forces(
    tree: Tree, node: Int32, omega: Vector3, alpha: Vector3, acceleration: Vector3, swing: Matrix3
):
    """Keep the force and the torque about its origin that the motion of a node takes."""
    moment = tree.node[node].moment
    inertia = tree.node[node].inertia
    tree.motion[node].force = tree.node[node].mass * acceleration + swing * moment
    tree.motion[node].torque = (
        inertia * alpha + wp.cross(omega, inertia * omega) + wp.cross(moment, acceleration)
    )


@func
def gather_forces(sizes: TreeSizes, tree: Tree):
    """Pass the forces of the nodes on to their parents, and leave what the dofs have of them in `output`.

    The first of them is NaN if not everything is finite: so a look at one number is enough.
    """
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        force = tree.motion[node].force
        torque = tree.motion[node].torque
        dof = tree.node[node].first_dof
        if tree.node[node].joint_type == REVOLUTE:
            tree.output[dof] = tree.dof[dof].angular[2] * torque[2]
        elif tree.node[node].joint_type == PRISMATIC:
            tree.output[dof] = wp.dot(tree.dof[dof].linear, force)
        elif tree.node[node].joint_type == SPHERICAL:
            for k in range(3):
                tree.output[dof + k] = torque[k]
        else:
            for other in range(dof, dof + tree.node[node].dof_count):
                tree.output[other] = wp.dot(tree.dof[other].angular, torque) + wp.dot(
                    tree.dof[other].linear, force
                )
        if node > 0:
            parent = tree.node[node].parent
            turn = tree.motion[node].turn
            force = turn * force
            tree.motion[parent].force += force
            tree.motion[parent].torque += turn * torque + wp.cross(tree.motion[node].origin, force)
        else:
            # Everything arrives at the base.
            zero = 0.0 * (force[0] + force[1] + force[2] + torque[0] + torque[1] + torque[2])
            tree.output[0] += zero


@func
def place_in_base(tree: Tree, node: Int32):
    """Find where a node is in the frame of the base, and what its dofs do there.

    The node is placed, and its parent has been here. Linear velocities are those at the origin of the base.
    """
    rotation = wp.identity(3, dtype=real)
    position = Vector3(0.0, 0.0, 0.0)
    if node > 0:
        parent = tree.node[node].parent
        rotation = tree.motion[parent].rotation * tree.motion[node].turn
        position = tree.motion[parent].position + tree.motion[parent].rotation * tree.motion[node].origin
    tree.motion[node].rotation = rotation
    tree.motion[node].position = position
    first = tree.node[node].first_dof
    for dof in range(first, first + tree.node[node].dof_count):
        angular = rotation * tree.dof[dof].angular
        tree.axis[dof].angular = angular
        tree.axis[dof].linear = rotation * tree.dof[dof].linear + wp.cross(position, angular)


@func
def composite_inertia(sizes: TreeSizes, tree: Tree):
    """Leave the mass matrix in `matrix`, row after row; the nodes are placed in the base.

    Entries of dofs of which neither moves the other are left alone: they are 0 from the beginning.
    """
    for node in range(sizes.nodes):
        rotation = tree.motion[node].rotation
        c = tree.motion[node].position
        mass = tree.node[node].mass
        moment = rotation * tree.node[node].moment
        tree.motion[node].mass = mass
        tree.motion[node].moment = moment + mass * c
        tree.motion[node].inertia = (
            rotation * tree.node[node].inertia * wp.transpose(rotation)
            + shift(c, moment)
            + shift(c, 0.5 * mass * c)
        )
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        mass = tree.motion[node].mass
        moment = tree.motion[node].moment
        inertia = tree.motion[node].inertia
        first = tree.node[node].first_dof
        for dof in range(first, first + tree.node[node].dof_count):
            angular = tree.axis[dof].angular
            linear = tree.axis[dof].linear
            torque = inertia * angular + wp.cross(moment, linear)
            force = mass * linear + wp.cross(angular, moment)
            carrier = node + 0
            while carrier >= 0:
                first_other = tree.node[carrier].first_dof
                for other in range(first_other, first_other + tree.node[carrier].dof_count):
                    value = wp.dot(tree.axis[other].angular, torque) + wp.dot(tree.axis[other].linear, force)
                    tree.matrix[dof * sizes.dofs + other] = value
                    tree.matrix[other * sizes.dofs + dof] = value
                carrier = tree.node[carrier].parent
        if node > 0:
            parent = tree.node[node].parent
            tree.motion[parent].mass += mass
            tree.motion[parent].moment += moment
            tree.motion[parent].inertia += inertia


@func
def shift(c: Vector3, moment: Vector3) -> Matrix3:
    """What a body's inertia gains when its moment lies at c: 2 (c · moment) 1 - c momentᵀ - moment cᵀ."""
    xx, yy, zz = 2.0 * c[0] * moment[0], 2.0 * c[1] * moment[1], 2.0 * c[2] * moment[2]
    xy = c[0] * moment[1] + c[1] * moment[0]
    xz = c[0] * moment[2] + c[2] * moment[0]
    yz = c[1] * moment[2] + c[2] * moment[1]
    return Matrix3(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy)


@kernel
def inverse_dynamics_kernel(sizes: TreeSizes, tree: Tree):
    """Leave in `output` the forces that cause the motion in `input`."""
    rates = first_rate(sizes)
    motion = tree.input
    newton_euler(
        sizes,
        tree,
        vector_at(motion, 0),
        vector_at(motion, 3),
        vector_at(motion, 6),
        motion,
        rates,
        rates + sizes.dofs - sizes.base_dofs,
    )


@kernel
def mass_matrix_kernel(sizes: TreeSizes, tree: Tree):
    """Leave the mass matrix at the positions in `input` in `matrix`."""
    place_nodes(tree, sizes.nodes)
    for node in range(sizes.nodes):
        place_in_base(tree, node)
    composite_inertia(sizes, tree)


@kernel
def jacobian_kernel(sizes: TreeSizes, tree: Tree, end: Int32):
    """Leave the Jacobian of a point in `output`: three rows of velocity, three of angular velocity."""
    last = tree.end[end].node
    place_nodes(tree, last + 1)
    for node in range(last + 1):
        place_in_base(tree, node)
    on_node = tree.end[end].origin + tree.end[end].turn * vector_at(tree.input, 0)
    point = tree.motion[last].position + tree.motion[last].rotation * on_node
    for entry in range(6 * sizes.dofs):
        tree.output[entry] = 0.0
    node = last + 0
    while node >= 0:
        first = tree.node[node].first_dof
        for dof in range(first, first + tree.node[node].dof_count):
            angular = tree.axis[dof].angular
            linear = tree.axis[dof].linear + wp.cross(angular, point)
            for row in range(3):
                tree.output[row * sizes.dofs + dof] = linear[row]
                tree.output[(3 + row) * sizes.dofs + dof] = angular[row]
        node = tree.node[node].parent
