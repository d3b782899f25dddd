"""Centre of mass, centroidal momentum and energies of a mechanism, and their derivatives.

See `sweep` for notation, frames and sources. A free base's linear velocity is added at the end: it changes
neither forces nor the angular momentum about the centre of mass.
"""

import warp as wp

from carom.kernels.mechanism.derivative_rows import note_overflow
from carom.kernels.mechanism.dynamics import vector_at
from carom.kernels.mechanism.many_bodies import take_parameters
from carom.kernels.mechanism.sweep import (
    add_to_parent,
    base_rotation,
    base_velocity,
    flow_matrix,
    inertia_force,
    inertia_torque,
    question_length,
    rates_of,
    sweep_inertias,
    sweep_motion,
    sweep_positions,
    vector_of,
)
from carom.kernels.structs import MechanismBatch, MechanismSizes, MechanismTable, SweepTable
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, kernel, real
from carom.layouts.mechanism import CENTROIDAL_COLUMNS, CENTROIDAL_NUMBERS, POSE

# Numbers of a column of a matrix of momenta: linear, then angular.
_ROWS = wp.constant(6)


@func
def put_vector(answer: Reals, place: Int32, value: Vector3):
    """Write a vector."""
    for axis in range(3):
        answer[place + axis] = value[axis]


@func
def put_column(
    answer: Reals, start: Int32, width: Int32, column: Int32, turn: Matrix3, linear: Vector3, angular: Vector3
):
    """Write a column of a row-major matrix of six rows, turned to other axes."""
    upper = turn * linear
    lower = turn * angular
    for axis in range(3):
        answer[start + axis * width + column] = upper[axis]
        answer[start + (3 + axis) * width + column] = lower[axis]


@kernel
def centroidal_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """Mass, centre, momentum, its rate, energies; then the momentum's map, its and the rate's derivatives.

    Mass (1) and centre of mass (3), linear and angular momentum (6), their rates (6), kinetic and potential
    energy (2). Then matrices (6, dofs): momentum by rates, momentum by positions, rate by positions, rate by
    rates. Axes are the world's, and angular momentum is about the centre of mass. A fixed base has no mass.
    """
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    first = world * question_length(sizes)
    start = world * (CENTROIDAL_NUMBERS + CENTROIDAL_COLUMNS * _ROWS * count)
    rates = rates_of(sizes, first)
    turn = base_rotation(batch.question, first)
    drift = base_velocity(sizes, batch.question, first)
    still = Vector3(0.0, 0.0, 0.0)
    sweep_positions(sizes, mechanism, batch.question, first)
    sweep_motion(sizes, mechanism, sweep, batch.question, first, batch.question, rates + count, still, still)
    sweep_inertias(sizes, mechanism, sweep)
    if sizes.base_dofs == 0:
        sweep.subtree[0].mass = real(0.0)
        sweep.subtree[0].moment = still
    for behind in range(sizes.nodes - 1):
        add_to_parent(mechanism, sweep, sizes.nodes - 1 - behind)

    mass = sweep.subtree[0].mass
    moment = sweep.subtree[0].moment
    momentum = sweep.subtree[0].momentum
    force = sweep.subtree[0].force
    inverse = 1.0 / mass if mass > 0.0 else 0.0
    centre = inverse * moment
    spin = vector_of(sweep.subtree[0].flow) - wp.cross(centre, momentum)
    torque = sweep.subtree[0].torque - wp.cross(centre, force)
    in_world = vector_at(batch.question, first + POSE) + turn * centre
    kinetic = wp.dot(drift, momentum) + 0.5 * mass * wp.dot(drift, drift)

    maps = start + CENTROIDAL_NUMBERS
    by_position = maps + _ROWS * count
    force_by_position = maps + 2 * _ROWS * count
    force_by_rate = maps + 3 * _ROWS * count
    for node in range(sizes.nodes):
        bias = flow_matrix(sweep.subtree[node].flow)
        own_momentum = sweep.subtree[node].momentum
        own_spin = vector_of(sweep.subtree[node].flow)
        own_torque = sweep.subtree[node].torque
        own_force = sweep.subtree[node].force
        dof = mechanism.node[node].first_dof
        for other in range(dof, dof + mechanism.node[node].dof_count):
            angular = sweep.dof[other].angular
            linear = sweep.dof[other].linear
            a = sweep.dof[other].turn_angular
            b = sweep.dof[other].turn_linear
            push = inertia_force(sweep, node, angular, linear)
            twist = inertia_torque(sweep, node, angular, linear)
            shift = inverse * push
            put_column(batch.answer, maps, count, other, turn, push, twist - wp.cross(centre, push))
            rate = batch.question[rates + other]
            # The linear velocity of a free base is not in these momenta.
            if other < 3 or other >= sizes.base_dofs:
                kinetic += 0.5 * rate * (wp.dot(angular, own_spin) + wp.dot(linear, own_momentum))

            push = inertia_force(sweep, node, a, b) + wp.cross(angular, own_momentum)
            twist = (
                inertia_torque(sweep, node, a, b)
                + wp.cross(angular, own_spin)
                + wp.cross(linear, own_momentum)
            )
            twist -= wp.cross(shift, momentum) + wp.cross(centre, push)
            if other < sizes.base_dofs:
                push += mass * wp.cross(angular, drift)
            put_column(batch.answer, by_position, count, other, turn, push, twist)

            c = sweep.dof[other].swing_angular
            d = sweep.dof[other].swing_linear
            push = (
                inertia_force(sweep, node, c, d)
                + 2.0 * wp.cross(a, own_momentum)
                + wp.cross(angular, own_force)
            )
            twist = (
                inertia_torque(sweep, node, c, d)
                + 2.0 * (bias * a)
                + wp.cross(angular, own_torque)
                + wp.cross(linear, own_force)
            )
            twist -= wp.cross(shift, force) + wp.cross(centre, push)
            put_column(batch.answer, force_by_position, count, other, turn, push, twist)

            c = sweep.dof[other].rate_angular
            d = sweep.dof[other].rate_linear
            push = inertia_force(sweep, node, c, d) + 2.0 * wp.cross(angular, own_momentum)
            twist = inertia_torque(sweep, node, c, d) + 2.0 * (bias * angular)
            twist -= wp.cross(centre, push)
            put_column(batch.answer, force_by_rate, count, other, turn, push, twist)

    for dof in range(count):
        rate = batch.question[rates + dof]
        kinetic += 0.5 * mechanism.dof_armature[dof] * rate * rate
    batch.answer[start] = mass
    put_vector(batch.answer, start + 1, in_world)
    put_vector(batch.answer, start + 4, turn * (momentum + mass * drift))
    put_vector(batch.answer, start + 7, turn * spin)
    put_vector(batch.answer, start + 10, turn * force)
    put_vector(batch.answer, start + 13, turn * torque)
    batch.answer[start + 16] = kinetic
    batch.answer[start + 17] = -mass * wp.dot(vector_at(batch.question, first), in_world)
    note_overflow(batch.answer, start, CENTROIDAL_NUMBERS + CENTROIDAL_COLUMNS * _ROWS * count)
