"""Inverse dynamics, mass matrix and Jacobian of a tree.

Recursive Newton-Euler and the composite rigid body algorithm in node frames; notation and methods:
R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5 and 6.
"""

import warp as wp

from carom.algorithms.tree.structs import BASE_MOTION, Tree, TreeSizes
from carom.model.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL
from carom.model.real import Int32, Matrix3, Quaternion, Vector3, func, fuse_multiply_add, kernel, real
from carom.physics.rotation import axis_rotation, rotation_matrix

fuse_multiply_add(__name__)


@func
def input_vector(tree: Tree, first: Int32) -> Vector3:
    """Three numbers of the question."""
    return Vector3(tree.input[first], tree.input[first + 1], tree.input[first + 2])


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
def place(tree: Tree, node: Int32):
    """Find the frame of a node in its parent's, from the positions of its joint."""
    turn = tree.node[node].turn
    origin = tree.node[node].origin
    kind = tree.node[node].joint_type
    q = BASE_MOTION + tree.node[node].first_position
    dof = tree.node[node].first_dof
    if kind == REVOLUTE:
        turn = turned_about_z(turn, tree.input[q])
    elif kind == PRISMATIC:
        origin += turn * (tree.dof[dof].linear * tree.input[q])
    elif kind == SPHERICAL:
        rotation = Quaternion(tree.input[q], tree.input[q + 1], tree.input[q + 2], tree.input[q + 3])
        turn = turn * rotation_matrix(wp.normalize(rotation))
    elif kind == PLANAR:
        # The translations are measured along axes that do not turn with the joint.
        slide = tree.dof[dof + 1].linear * tree.input[q + 1] + tree.dof[dof + 2].linear * tree.input[q + 2]
        origin += turn * slide
        turn = turn * rotation_matrix(axis_rotation(wp.normalize(tree.dof[dof].angular), tree.input[q]))
    tree.motion[node].turn = turn
    tree.motion[node].origin = origin


@func
def newton_euler(sizes: TreeSizes, tree: Tree, accelerated: Int32):
    """Leave the forces of the dofs in `output`: of the motion of the base and the positions and rates.

    Args:
        sizes: Sizes of the tree.
        tree: The tree.
        accelerated: 1: accelerations are given as well; 0: they are 0.
    """
    rates = BASE_MOTION + sizes.coordinates - sizes.base_dofs
    accelerations = rates + sizes.dofs - sizes.base_dofs
    omega = input_vector(tree, 0)
    alpha = input_vector(tree, 3)
    acceleration = input_vector(tree, 6)
    swing = swing_matrix(omega, alpha)
    keep_motion(tree, 0, omega, alpha, acceleration, swing)
    for node in range(1, sizes.nodes):
        place(tree, node)
        parent = tree.node[node].parent
        # Most nodes hang on the one before, whose motion is still at hand.
        if parent != node - 1:
            omega = tree.motion[parent].omega
            alpha = tree.motion[parent].alpha
            acceleration = tree.motion[parent].acceleration
            swing = tree.motion[parent].swing
        turn = tree.motion[node].turn
        acceleration = turned_back(turn, acceleration + swing * tree.motion[node].origin)
        omega = turned_back(turn, omega)
        alpha = turned_back(turn, alpha)
        dof = tree.node[node].first_dof
        if tree.node[node].joint_type == REVOLUTE:
            spin = tree.dof[dof].angular[2] * tree.input[rates + dof]
            alpha += Vector3(omega[1] * spin, -omega[0] * spin, 0.0)
            omega += Vector3(0.0, 0.0, spin)
            if accelerated == 1:
                alpha += Vector3(0.0, 0.0, tree.dof[dof].angular[2] * tree.input[accelerations + dof])
        else:
            joint_omega = Vector3(0.0, 0.0, 0.0)
            joint_velocity = Vector3(0.0, 0.0, 0.0)
            for k in range(tree.node[node].dof_count):
                rate = tree.input[rates + dof + k]
                joint_omega += tree.dof[dof + k].angular * rate
                joint_velocity += tree.dof[dof + k].linear * rate
                if accelerated == 1:
                    change = tree.input[accelerations + dof + k]
                    alpha += tree.dof[dof + k].angular * change
                    acceleration += tree.dof[dof + k].linear * change
            alpha += wp.cross(omega, joint_omega)
            acceleration += wp.cross(2.0 * omega + joint_omega, joint_velocity)
            omega += joint_omega
        swing = swing_matrix(omega, alpha)
        keep_motion(tree, node, omega, alpha, acceleration, swing)
    gather_forces(sizes, tree)


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
def keep_motion(
    tree: Tree, node: Int32, omega: Vector3, alpha: Vector3, acceleration: Vector3, swing: Matrix3
):
    """Keep the motion of a node, and the force and the torque about its origin that it takes."""
    tree.motion[node].omega = omega
    tree.motion[node].alpha = alpha
    tree.motion[node].acceleration = acceleration
    tree.motion[node].swing = swing
    moment = tree.node[node].moment
    inertia = tree.node[node].inertia
    tree.motion[node].force = tree.node[node].mass * acceleration + swing * moment
    tree.motion[node].torque = (
        inertia * alpha + wp.cross(omega, inertia * omega) + wp.cross(moment, acceleration)
    )


@func
def gather_forces(sizes: TreeSizes, tree: Tree):
    """Pass the forces of the nodes on to their parents, and leave what the dofs have of them in `output`.

    Behind them goes a number that is finite if everything is: the sum of what arrives at the base.
    """
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        force = tree.motion[node].force
        torque = tree.motion[node].torque
        dof = tree.node[node].first_dof
        if tree.node[node].joint_type == REVOLUTE:
            tree.output[dof] = tree.dof[dof].angular[2] * torque[2]
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
            tree.output[sizes.dofs] = force[0] + force[1] + force[2] + torque[0] + torque[1] + torque[2]


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
    newton_euler(sizes, tree, 1)


@kernel
def mass_matrix_kernel(sizes: TreeSizes, tree: Tree):
    """Leave the mass matrix at the positions in `input` in `matrix`."""
    for node in range(sizes.nodes):
        place(tree, node)
        place_in_base(tree, node)
    composite_inertia(sizes, tree)


@kernel
def jacobian_kernel(sizes: TreeSizes, tree: Tree, end: Int32):
    """Leave the Jacobian of a point in `output`: three rows of velocity, three of angular velocity."""
    last = tree.end[end].node
    for node in range(last + 1):
        place(tree, node)
        place_in_base(tree, node)
    on_node = tree.end[end].origin + tree.end[end].turn * input_vector(tree, 0)
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
