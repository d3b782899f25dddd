"""Centre of mass, centroidal momentum and energies of a mechanism, and their derivatives.

See `sweep` for notation, frames and sources. A free base's linear velocity is added at the end: it changes
neither forces nor the angular momentum about the centre of mass.
"""

import warp as wp

from carom.kernels.joints.coordinates import vector_at
from carom.kernels.mechanism.derivative_rows import note_overflow
from carom.kernels.mechanism.derivatives import opposite_gravity
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
from carom.layouts.mechanism import (
    CENTER_NUMBERS,
    CENTROIDAL_COLUMNS,
    CENTROIDAL_NUMBERS,
    MOMENTUM_NUMBERS,
    POSE,
)

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


@func
def gather_momenta(
    sizes: MechanismSizes, mechanism: MechanismTable, sweep: SweepTable, question: Reals, first: Int32
):
    """Compute inertia, momentum and force of all subtrees; a fixed base has no mass."""
    still = Vector3(0.0, 0.0, 0.0)
    changes = rates_of(sizes, first) + sizes.dofs
    sweep_positions(sizes, mechanism, question, first)
    sweep_motion(sizes, mechanism, sweep, question, first, question, changes, still, still)
    sweep_inertias(sizes, mechanism, sweep)
    if sizes.base_dofs == 0:
        sweep.subtree[0].mass = real(0.0)
        sweep.subtree[0].moment = still
    for behind in range(sizes.nodes - 1):
        add_to_parent(mechanism, sweep, sizes.nodes - 1 - behind)


@func
def rate_energy(sweep: SweepTable, node: Int32, dof: Int32, rate: real) -> real:
    """Kinetic energy of a rate, with half of what it shares with those of other dofs."""
    own_spin = vector_of(sweep.subtree[node].flow)
    own_momentum = sweep.subtree[node].momentum
    angular = sweep.dof[dof].angular
    linear = sweep.dof[dof].linear
    return 0.5 * rate * (wp.dot(angular, own_spin) + wp.dot(linear, own_momentum))


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
    gather_momenta(sizes, mechanism, sweep, batch.question, first)

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
                kinetic += rate_energy(sweep, node, other, rate)

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


@kernel
def momentum_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """The numbers and the map of `centroidal_kernel` that need no derivatives, bit for bit.

    Linear and angular momentum (6), kinetic energy (1), and momentum by rates (6, dofs).
    """
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    first = world * question_length(sizes)
    length = MOMENTUM_NUMBERS + _ROWS * count
    start = world * length
    rates = rates_of(sizes, first)
    turn = base_rotation(batch.question, first)
    drift = base_velocity(sizes, batch.question, first)
    gather_momenta(sizes, mechanism, sweep, batch.question, first)

    mass = sweep.subtree[0].mass
    momentum = sweep.subtree[0].momentum
    inverse = 1.0 / mass if mass > 0.0 else 0.0
    centre = inverse * sweep.subtree[0].moment
    spin = vector_of(sweep.subtree[0].flow) - wp.cross(centre, momentum)
    kinetic = wp.dot(drift, momentum) + 0.5 * mass * wp.dot(drift, drift)
    maps = start + MOMENTUM_NUMBERS
    for node in range(sizes.nodes):
        dof = mechanism.node[node].first_dof
        for other in range(dof, dof + mechanism.node[node].dof_count):
            angular = sweep.dof[other].angular
            linear = sweep.dof[other].linear
            push = inertia_force(sweep, node, angular, linear)
            twist = inertia_torque(sweep, node, angular, linear)
            put_column(batch.answer, maps, count, other, turn, push, twist - wp.cross(centre, push))
            if other < 3 or other >= sizes.base_dofs:
                kinetic += rate_energy(sweep, node, other, batch.question[rates + other])
    for dof in range(count):
        rate = batch.question[rates + dof]
        kinetic += 0.5 * mechanism.dof_armature[dof] * rate * rate
    put_vector(batch.answer, start, turn * (momentum + mass * drift))
    put_vector(batch.answer, start + 3, turn * spin)
    batch.answer[start + 6] = kinetic
    note_overflow(batch.answer, start, length)


@kernel
def center_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """What masses and centres of mass determine, as other kernels have it, bit for bit.

    Centre of mass (3) and potential energy (1), as `centroidal_kernel`; velocity of the centre of mass by
    rates (3, dofs); forces against gravity (dofs), as `coriolis_kernel`.
    """
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    first = world * question_length(sizes)
    length = CENTER_NUMBERS + 4 * count
    start = world * length
    speeds = start + CENTER_NUMBERS
    weights = speeds + 3 * count
    lift = opposite_gravity(batch.question, first)
    turn = base_rotation(batch.question, first)
    sweep_positions(sizes, mechanism, batch.question, first)
    for node in range(sizes.nodes):
        mass = mechanism.node[node].mass
        own = mechanism.motion[node].rotation * mechanism.node[node].moment
        sweep.subtree[node].mass = mass
        sweep.subtree[node].moment = own + mass * mechanism.motion[node].position
    if sizes.base_dofs == 0:
        sweep.subtree[0].mass = real(0.0)
        sweep.subtree[0].moment = Vector3(0.0, 0.0, 0.0)
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        mass = sweep.subtree[node].mass
        moment = sweep.subtree[node].moment
        dof = mechanism.node[node].first_dof
        for other in range(dof, dof + mechanism.node[node].dof_count):
            force = inertia_force(sweep, node, mechanism.axis[other].angular, mechanism.axis[other].linear)
            batch.answer[weights + other] = wp.dot(force, lift)
            push = turn * force
            for axis in range(3):
                batch.answer[speeds + axis * count + other] = push[axis]
        if node > 0:
            parent = mechanism.node[node].parent
            sweep.subtree[parent].mass += mass
            sweep.subtree[parent].moment += moment
    mass = sweep.subtree[0].mass
    inverse = 1.0 / mass if mass > 0.0 else 0.0
    centre = inverse * sweep.subtree[0].moment
    divisor = mass if mass > 0.0 else 1.0
    for place in range(3 * count):
        batch.answer[speeds + place] = batch.answer[speeds + place] / divisor
    in_world = vector_at(batch.question, first + POSE) + turn * centre
    put_vector(batch.answer, start, in_world)
    batch.answer[start + 3] = -mass * wp.dot(vector_at(batch.question, first), in_world)
    note_overflow(batch.answer, start, length)
