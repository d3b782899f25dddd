"""Poses, velocities and accelerations of link frames, their derivatives, and joint torque regressors.

See `sweep` for notation, frames and sources. Velocities and accelerations of a link are those of the origin
of its frame, in world axes: linear before angular.
"""

import warp as wp

from carom.kernels.joints.coordinates import vector_at
from carom.kernels.maths.rotation import quaternion_of
from carom.kernels.mechanism.derivative_rows import note_overflow
from carom.kernels.mechanism.derivatives import opposite_gravity
from carom.kernels.mechanism.dynamics import turned_back
from carom.kernels.mechanism.momentum import put_column, put_vector
from carom.kernels.mechanism.sweep import (
    base_rotation,
    base_velocity,
    question_length,
    rates_of,
    sweep_motion,
    sweep_positions,
)
from carom.kernels.structs import MechanismBatch, MechanismSizes, MechanismTable, SweepTable
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, kernel, real
from carom.layouts.mechanism import INERTIAL_PARAMETERS, LINK_MOTION, LINK_POSE, POSE

_ROWS = wp.constant(6)


@func
def link_point(mechanism: MechanismTable, sweep: SweepTable, link: Int32) -> Vector3:
    """Origin of a link frame, in the base's frame."""
    node = sweep.link[link].node
    return mechanism.motion[node].position + mechanism.motion[node].rotation * sweep.link[link].origin


@func
def point_velocity(sweep: SweepTable, node: Int32, point: Vector3) -> Vector3:
    """Velocity of a point of a node, without what the linear velocity of a free base contributes."""
    return sweep.subtree[node].velocity + wp.cross(sweep.subtree[node].omega, point)


@func
def point_acceleration(sweep: SweepTable, node: Int32, point: Vector3) -> Vector3:
    """Acceleration of a point of a node, the derivative of its velocity."""
    return (
        sweep.subtree[node].acceleration
        + wp.cross(sweep.subtree[node].alpha, point)
        + wp.cross(sweep.subtree[node].omega, point_velocity(sweep, node, point))
    )


@func
def sweep_links(
    sizes: MechanismSizes, mechanism: MechanismTable, sweep: SweepTable, question: Reals, first: Int32
):
    """Compute the motion of all nodes."""
    still = Vector3(0.0, 0.0, 0.0)
    changes = rates_of(sizes, first) + sizes.dofs
    sweep_positions(sizes, mechanism, question, first)
    sweep_motion(sizes, mechanism, sweep, question, first, question, changes, still, still)


@kernel
def link_frames_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    links: Int32,
    first_world: Int32,
):
    """For each link, the base first: origin and quaternion of its frame in world axes."""
    world = first_world + wp.tid()
    first = world * question_length(sizes)
    start = world * links * LINK_POSE
    turn = base_rotation(batch.question, first)
    base = vector_at(batch.question, first + POSE)
    sweep_positions(sizes, mechanism, batch.question, first)
    for link in range(links):
        place = start + LINK_POSE * link
        node = sweep.link[link].node
        put_vector(batch.answer, place, base + turn * link_point(mechanism, sweep, link))
        q = quaternion_of(turn * (mechanism.motion[node].rotation * sweep.link[link].turn))
        for k in range(4):
            batch.answer[place + 3 + k] = q[k]
    note_overflow(batch.answer, start, LINK_POSE * links)


@kernel
def link_motions_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    links: Int32,
    first_world: Int32,
):
    """For each link, the base first: linear and angular velocity, linear and angular acceleration."""
    world = first_world + wp.tid()
    first = world * question_length(sizes)
    start = world * links * LINK_MOTION
    turn = base_rotation(batch.question, first)
    drift = base_velocity(sizes, batch.question, first)
    sweep_links(sizes, mechanism, sweep, batch.question, first)
    for link in range(links):
        node = sweep.link[link].node
        point = link_point(mechanism, sweep, link)
        place = start + LINK_MOTION * link
        put_vector(batch.answer, place, turn * (drift + point_velocity(sweep, node, point)))
        put_vector(batch.answer, place + 3, turn * sweep.subtree[node].omega)
        put_vector(batch.answer, place + 6, turn * point_acceleration(sweep, node, point))
        put_vector(batch.answer, place + 9, turn * sweep.subtree[node].alpha)
    note_overflow(batch.answer, start, LINK_MOTION * links)


@kernel
def link_derivatives_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    link: Int32,
    first_world: Int32,
):
    """Matrices (6, dofs) of a link: velocity by positions, by rates; acceleration by positions, by rates.

    The accelerations' derivatives by those of the rates are the velocities' by rates.
    """
    world = first_world + wp.tid()
    count = sizes.dofs
    size = _ROWS * count
    first = world * question_length(sizes)
    start = world * 4 * size
    turn = base_rotation(batch.question, first)
    drift = base_velocity(sizes, batch.question, first)
    sweep_links(sizes, mechanism, sweep, batch.question, first)
    node = sweep.link[link].node
    point = link_point(mechanism, sweep, link)
    omega = sweep.subtree[node].omega
    alpha = sweep.subtree[node].alpha
    velocity = sweep.subtree[node].velocity
    acceleration = sweep.subtree[node].acceleration
    speed = point_velocity(sweep, node, point)
    dof = mechanism.node[node].first_dof + mechanism.node[node].dof_count - 1
    while dof >= 0:
        angular = sweep.dof[dof].angular
        linear = sweep.dof[dof].linear
        a = sweep.dof[dof].turn_angular
        b = sweep.dof[dof].turn_linear
        moved = linear + wp.cross(angular, point)
        put_column(batch.answer, start + size, count, dof, turn, moved, angular)

        # The velocity and acceleration of the node move with the dof, but for what its parent has.
        own_angular = wp.cross(angular, omega) + a
        own_linear = wp.cross(angular, velocity) + wp.cross(linear, omega) + b
        by_position = own_linear + wp.cross(own_angular, point) + wp.cross(omega, moved)
        carried = Vector3(0.0, 0.0, 0.0)
        if dof < sizes.base_dofs:
            carried = wp.cross(angular, drift)
        put_column(batch.answer, start, count, dof, turn, by_position + carried, own_angular)

        change_angular = wp.cross(angular, alpha) + sweep.dof[dof].swing_angular - wp.cross(omega, a)
        change_linear = (
            wp.cross(angular, acceleration)
            + wp.cross(linear, alpha)
            + sweep.dof[dof].swing_linear
            - wp.cross(omega, b)
            - wp.cross(velocity, a)
        )
        pushed = (
            change_linear
            + wp.cross(change_angular, point)
            + wp.cross(alpha, moved)
            + wp.cross(own_angular, speed)
            + wp.cross(omega, by_position)
        )
        put_column(batch.answer, start + 2 * size, count, dof, turn, pushed, change_angular)

        change_angular = sweep.dof[dof].rate_angular - wp.cross(omega, angular)
        change_linear = sweep.dof[dof].rate_linear - wp.cross(omega, linear) - wp.cross(velocity, angular)
        pushed = (
            change_linear
            + wp.cross(change_angular, point)
            + wp.cross(angular, speed)
            + wp.cross(omega, moved)
        )
        put_column(batch.answer, start + 3 * size, count, dof, turn, pushed, change_angular)
        dof = sweep.dof_parent[dof]
    note_overflow(batch.answer, start, 4 * size)


@func
def inertia_column(omega: Vector3, alpha: Vector3, row: Int32, column: Int32) -> Vector3:
    """Torque for the motion, in link axes, of a unit entry of the inertia tensor and its mirror image."""
    unit = Matrix3(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    unit[row, column] = real(1.0)
    unit[column, row] = real(1.0)
    return unit * alpha + wp.cross(omega, unit * omega)


@func
def put_regressor(
    sweep: SweepTable,
    answer: Reals,
    start: Int32,
    width: Int32,
    column: Int32,
    last: Int32,
    turn: Matrix3,
    point: Vector3,
    force: Vector3,
    torque: Vector3,
):
    """Write a column: the joint forces for a force and a torque at the origin of a link, in its axes."""
    push = turn * force
    twist = turn * torque + wp.cross(point, push)
    dof = last + 0
    while dof >= 0:
        answer[start + dof * width + column] = wp.dot(sweep.dof[dof].angular, twist) + wp.dot(
            sweep.dof[dof].linear, push
        )
        dof = sweep.dof_parent[dof]


@kernel
def regressor_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    links: Int32,
    first_world: Int32,
):
    """Joint torque regressor (dofs, 10 links): forces per mass, first moments and inertias of each link.

    Those are about the origin of the link's frame and along its axes; inertias in the order xx, xy, yy, xz,
    yz, zz.
    """
    world = first_world + wp.tid()
    count = sizes.dofs
    width = INERTIAL_PARAMETERS * links
    first = world * question_length(sizes)
    start = world * sizes.dofs * width
    sweep_links(sizes, mechanism, sweep, batch.question, first)
    lift = opposite_gravity(batch.question, first)
    for link in range(links):
        node = sweep.link[link].node
        last = mechanism.node[node].first_dof + mechanism.node[node].dof_count - 1
        turn = mechanism.motion[node].rotation * sweep.link[link].turn
        point = link_point(mechanism, sweep, link)
        omega = turned_back(turn, sweep.subtree[node].omega)
        alpha = turned_back(turn, sweep.subtree[node].alpha)
        pull = turned_back(turn, lift + point_acceleration(sweep, node, point))
        none = Vector3(0.0, 0.0, 0.0)
        column = INERTIAL_PARAMETERS * link
        put_regressor(sweep, batch.answer, start, width, column, last, turn, point, pull, none)
        for axis in range(3):
            unit = Vector3(0.0, 0.0, 0.0)
            unit[axis] = real(1.0)
            force = wp.cross(alpha, unit) + wp.cross(omega, wp.cross(omega, unit))
            put_regressor(
                sweep, batch.answer, start, width, column + 1 + axis, last, turn, point, force,
                wp.cross(unit, pull),
            )  # fmt: skip
        column += 4
        for other in range(3):
            for row in range(other + 1):
                torque = inertia_column(omega, alpha, row, other)
                put_regressor(sweep, batch.answer, start, width, column, last, turn, point, none, torque)
                column += 1
    note_overflow(batch.answer, start, count * width)
