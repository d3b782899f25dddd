"""Inverse dynamics, mass matrix and Jacobian of a tree.

Recursive Newton-Euler and the composite rigid body algorithm in node frames; notation and methods:
R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5 and 6.
"""

import warp as wp

from carom.algorithms.tree.structs import BASE_MOTION, Tree, TreeSizes
from carom.model.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL
from carom.model.real import Int32, Matrix3, Quaternion, Vector3, func, kernel, real
from carom.physics.rotation import axis_rotation, rotation_matrix


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
    for node in range(sizes.nodes):
        omega = input_vector(tree, 0)
        velocity = input_vector(tree, 3)
        alpha = input_vector(tree, 6)
        acceleration = input_vector(tree, 9)
        if node > 0:
            place(tree, node)
            parent = tree.node[node].parent
            turn = tree.motion[node].turn
            origin = tree.motion[node].origin
            omega = tree.motion[parent].omega
            alpha = tree.motion[parent].alpha
            velocity = turned_back(turn, tree.motion[parent].velocity + wp.cross(omega, origin))
            acceleration = turned_back(turn, tree.motion[parent].acceleration + wp.cross(alpha, origin))
            omega = turned_back(turn, omega)
            alpha = turned_back(turn, alpha)
            joint_omega = Vector3(0.0, 0.0, 0.0)
            joint_velocity = Vector3(0.0, 0.0, 0.0)
            first = tree.node[node].first_dof
            for dof in range(first, first + tree.node[node].dof_count):
                rate = tree.input[rates + dof]
                joint_omega += tree.dof[dof].angular * rate
                joint_velocity += tree.dof[dof].linear * rate
                if accelerated == 1:
                    change = tree.input[accelerations + dof]
                    alpha += tree.dof[dof].angular * change
                    acceleration += tree.dof[dof].linear * change
            omega += joint_omega
            velocity += joint_velocity
            alpha += wp.cross(omega, joint_omega)
            acceleration += wp.cross(omega, joint_velocity) + wp.cross(velocity, joint_omega)
        tree.motion[node].omega = omega
        tree.motion[node].velocity = velocity
        tree.motion[node].alpha = alpha
        tree.motion[node].acceleration = acceleration

        mass = tree.node[node].mass
        moment = tree.node[node].moment
        inertia = tree.node[node].inertia
        momentum = mass * velocity + wp.cross(omega, moment)
        spin = inertia * omega + wp.cross(moment, velocity)
        tree.motion[node].force = mass * acceleration + wp.cross(alpha, moment) + wp.cross(omega, momentum)
        tree.motion[node].torque = (
            inertia * alpha
            + wp.cross(moment, acceleration)
            + wp.cross(omega, spin)
            + wp.cross(velocity, momentum)
        )

    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        force = tree.motion[node].force
        torque = tree.motion[node].torque
        first = tree.node[node].first_dof
        for dof in range(first, first + tree.node[node].dof_count):
            tree.output[dof] = wp.dot(tree.dof[dof].angular, torque) + wp.dot(tree.dof[dof].linear, force)
        if node > 0:
            parent = tree.node[node].parent
            turn = tree.motion[node].turn
            force = turn * force
            tree.motion[parent].force += force
            tree.motion[parent].torque += turn * torque + wp.cross(tree.motion[node].origin, force)


@func
def composite_inertia(sizes: TreeSizes, tree: Tree):
    """Leave the mass matrix in `matrix`, row after row; the nodes are placed.

    Entries of dofs of which neither moves the other are left alone: they are 0 from the beginning.
    """
    for node in range(sizes.nodes):
        tree.motion[node].mass = tree.node[node].mass
        tree.motion[node].moment = tree.node[node].moment
        tree.motion[node].inertia = tree.node[node].inertia
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        mass = tree.motion[node].mass
        moment = tree.motion[node].moment
        inertia = tree.motion[node].inertia
        first = tree.node[node].first_dof
        for dof in range(first, first + tree.node[node].dof_count):
            angular = tree.dof[dof].angular
            linear = tree.dof[dof].linear
            torque = inertia * angular + wp.cross(moment, linear)
            force = mass * linear + wp.cross(angular, moment)
            carrier = node + 0
            while carrier >= 0:
                first_other = tree.node[carrier].first_dof
                for other in range(first_other, first_other + tree.node[carrier].dof_count):
                    value = wp.dot(tree.dof[other].angular, torque) + wp.dot(tree.dof[other].linear, force)
                    tree.matrix[dof * sizes.dofs + other] = value
                    tree.matrix[other * sizes.dofs + dof] = value
                if carrier > 0:
                    force = tree.motion[carrier].turn * force
                    torque = tree.motion[carrier].turn * torque + wp.cross(
                        tree.motion[carrier].origin, force
                    )
                carrier = tree.node[carrier].parent
        if node > 0:
            parent = tree.node[node].parent
            turn = tree.motion[node].turn
            c = tree.motion[node].origin
            moved = turn * moment
            tree.motion[parent].mass += mass
            tree.motion[parent].moment += moved + mass * c
            tree.motion[parent].inertia += (
                turn * inertia * wp.transpose(turn) + shift(c, moved) + shift(c, 0.5 * mass * c)
            )


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
    for node in range(1, sizes.nodes):
        place(tree, node)
    composite_inertia(sizes, tree)


@kernel
def jacobian_kernel(sizes: TreeSizes, tree: Tree, end: Int32):
    """Leave the Jacobian of a point in `output`: three rows of velocity, three of angular velocity."""
    last = tree.end[end].node
    tree.motion[0].rotation = wp.identity(3, dtype=real)
    tree.motion[0].position = Vector3(0.0, 0.0, 0.0)
    for node in range(1, last + 1):
        place(tree, node)
        parent = tree.node[node].parent
        rotation = tree.motion[parent].rotation
        tree.motion[node].position = tree.motion[parent].position + rotation * tree.motion[node].origin
        tree.motion[node].rotation = rotation * tree.motion[node].turn
    on_node = tree.end[end].origin + tree.end[end].turn * input_vector(tree, 0)
    point = tree.motion[last].position + tree.motion[last].rotation * on_node
    for entry in range(6 * sizes.dofs):
        tree.output[entry] = 0.0
    node = last + 0
    while node >= 0:
        arm = point - tree.motion[node].position
        first = tree.node[node].first_dof
        for dof in range(first, first + tree.node[node].dof_count):
            angular = tree.motion[node].rotation * tree.dof[dof].angular
            linear = tree.motion[node].rotation * tree.dof[dof].linear + wp.cross(angular, arm)
            for row in range(3):
                tree.output[row * sizes.dofs + dof] = linear[row]
                tree.output[(3 + row) * sizes.dofs + dof] = angular[row]
        node = tree.node[node].parent
