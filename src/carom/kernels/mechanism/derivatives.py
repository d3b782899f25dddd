"""Derivatives of inverse and forward dynamics, forward dynamics, and the Coriolis matrix.

See `sweep` for notation, frames and sources; the Coriolis matrix is that of S. Echeandia, P. M. Wensing,
Numerical methods to compute the Coriolis matrix and Christoffel symbols for rigid-body systems, 2021. Forces
are in the order of the rates: of a free base the torque, then the force.
"""

import warp as wp

from carom.kernels.joints.coordinates import vector_at
from carom.kernels.joints.nodes import along
from carom.kernels.mechanism.derivative_rows import (
    factorise,
    note_overflow,
    solve,
    write_coriolis,
    write_derivatives,
)
from carom.kernels.mechanism.dynamics import turned_back
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
)
from carom.kernels.structs import MechanismBatch, MechanismSizes, MechanismTable, SweepTable
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, kernel, real


@func
def opposite_gravity(question: Reals, first: Int32) -> Vector3:
    """Minus gravity, in the axes of the base."""
    return -turned_back(base_rotation(question, first), vector_at(question, first))


@func
def inverse_derivatives(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    question: Reals,
    first: Int32,
    changes: Reals,
    first_change: Int32,
    answer: Reals,
    start: Int32,
):
    """Write derivatives of forces by positions, rates and their derivatives; `sweep_positions` was called."""
    count = sizes.dofs
    still = Vector3(0.0, 0.0, 0.0)
    sweep_motion(
        sizes, mechanism, sweep, question, first, changes, first_change, still,
        opposite_gravity(question, first),
    )  # fmt: skip
    sweep_inertias(sizes, mechanism, sweep)
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        first_dof = mechanism.node[node].first_dof
        last = first_dof + mechanism.node[node].dof_count
        bias = flow_matrix(sweep.subtree[node].flow)
        twice = wp.transpose(bias)
        momentum = sweep.subtree[node].momentum
        torque = sweep.subtree[node].torque
        force = sweep.subtree[node].force
        for dof in range(first_dof, last):
            angular = sweep.dof[dof].angular
            linear = sweep.dof[dof].linear
            turn = sweep.dof[dof].turn_angular
            swing_angular = sweep.dof[dof].swing_angular
            swing_linear = sweep.dof[dof].swing_linear
            rate_angular = sweep.dof[dof].rate_angular
            rate_linear = sweep.dof[dof].rate_linear
            write_derivatives(
                sweep, answer, start, count, dof, first_dof, last,
                2.0 * (twice * angular + wp.cross(momentum, linear)),
                inertia_torque(sweep, node, angular, linear),
                inertia_force(sweep, node, angular, linear),
                2.0 * (bias * turn)
                + inertia_torque(sweep, node, swing_angular, swing_linear)
                + wp.cross(angular, torque)
                + wp.cross(linear, force),
                2.0 * wp.cross(turn, momentum)
                + inertia_force(sweep, node, swing_angular, swing_linear)
                + wp.cross(angular, force),
                2.0 * (bias * angular) + inertia_torque(sweep, node, rate_angular, rate_linear),
                2.0 * wp.cross(angular, momentum) + inertia_force(sweep, node, rate_angular, rate_linear),
            )  # fmt: skip
        add_to_parent(mechanism, sweep, node)
    for dof in range(count):
        answer[start + (2 * count + dof) * count + dof] += mechanism.dof_armature[dof]


@kernel
def inverse_derivatives_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """Derivatives of forces by positions, rates and their derivatives: three matrices for each question."""
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    first = world * question_length(sizes)
    start = world * 3 * count * count
    changes = rates_of(sizes, first) + count
    sweep_positions(sizes, mechanism, batch.question, first)
    inverse_derivatives(
        sizes, mechanism, sweep, batch.question, first, batch.question, changes, batch.answer, start
    )
    note_overflow(batch.answer, start, 3 * count * count)


@func
def put_vector(numbers: Reals, first: Int32, v: Vector3):
    """Write a vector from `first` on."""
    numbers[first] = v[0]
    numbers[first + 1] = v[1]
    numbers[first + 2] = v[2]


@func
def turn_base(count: Int32, turn: Matrix3, answer: Reals, start: Int32):
    """Turn what a matrix has of a free base, rows and columns, from the axes of the base to the world's."""
    for row in range(count):
        for part in range(2):
            place = start + row * count + 3 * part
            put_vector(answer, place, turn * vector_at(answer, place))
    for part in range(2):
        first = start + 3 * part * count
        for column in range(count):
            turned = turn * Vector3(
                answer[first + column], answer[first + count + column], answer[first + 2 * count + column]
            )
            answer[first + column] = turned[0]
            answer[first + count + column] = turned[1]
            answer[first + 2 * count + column] = turned[2]


@func
def put_in_world_axes(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    question: Reals,
    first: Int32,
    answer: Reals,
    start: Int32,
):
    """Give a free base coordinates along the axes of the world; `inverse_derivatives` was called."""
    count = sizes.dofs
    size = count * count
    rates = rates_of(sizes, first)
    changes = rates + count
    for row in range(count):
        place = start + row * count
        # Vectors of the world turn the other way for a base that turns.
        moved = vector_at(answer, place)
        for part in range(2):
            own = place + 3 * part
            moved += wp.cross(vector_at(answer, own + size), vector_at(question, rates + 3 * part))
            moved += wp.cross(vector_at(answer, own + 2 * size), vector_at(question, changes + 3 * part))
        put_vector(answer, place, moved)
    for part in range(2):
        pushed = sweep.subtree[0].torque
        if part == 1:
            pushed = sweep.subtree[0].force
        # That of a base is the same along all axes.
        pushed += mechanism.dof_armature[3 * part] * vector_at(question, changes + 3 * part)
        place = start + 3 * part * count
        answer[place + 1] += pushed[2]
        answer[place + 2] -= pushed[1]
        answer[place + count] -= pushed[2]
        answer[place + count + 2] += pushed[0]
        answer[place + 2 * count] += pushed[1]
        answer[place + 2 * count + 1] -= pushed[0]
    turn = base_rotation(question, first)
    for matrix in range(3):
        turn_base(count, turn, answer, start + matrix * size)


@func
def step_derivatives(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    number: Int32,
):
    """Answer a question by its number: as `inverse_derivatives_kernel`, along the axes of the world.

    Rates and accelerations of a free base in questions are along the axes of the base.
    """
    count = sizes.dofs
    first = number * question_length(sizes)
    start = number * 3 * count * count
    changes = rates_of(sizes, first) + count
    sweep_positions(sizes, mechanism, batch.question, first)
    inverse_derivatives(
        sizes, mechanism, sweep, batch.question, first, batch.question, changes, batch.answer, start
    )
    if sizes.base_dofs > 0:
        put_in_world_axes(sizes, mechanism, sweep, batch.question, first, batch.answer, start)
    note_overflow(batch.answer, start, 3 * count * count)


@func
def write_subtree_forces(
    sizes: MechanismSizes, mechanism: MechanismTable, sweep: SweepTable, answer: Reals, start: Int32
):
    """Write mass matrix and forces for the motions of the nodes: matrix from `start` on, then forces."""
    count = sizes.dofs
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        first_dof = mechanism.node[node].first_dof
        for dof in range(first_dof, first_dof + mechanism.node[node].dof_count):
            axis = mechanism.axis[dof]
            torque = inertia_torque(sweep, node, axis.angular, axis.linear)
            force = inertia_force(sweep, node, axis.angular, axis.linear)
            other = dof + 0
            while other >= 0:
                answer[start + dof * count + other] = along(mechanism.axis[other], torque, force)
                other = sweep.dof_parent[other]
            answer[start + count * count + dof] = along(
                axis, sweep.subtree[node].torque, sweep.subtree[node].force
            )
        add_to_parent(mechanism, sweep, node)
    for dof in range(count):
        answer[start + dof * count + dof] += mechanism.dof_armature[dof]


@func
def forward_dynamics(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    first: Int32,
    start: Int32,
):
    """Write accelerations from `start` on, and factorise the mass matrix.

    The answer has room for a matrix behind them, whose lower triangle is overwritten, and for as many more
    numbers as there are dofs.
    """
    count = sizes.dofs
    given = rates_of(sizes, first) + count
    matrix = start + count
    still = Vector3(0.0, 0.0, 0.0)
    sweep_positions(sizes, mechanism, batch.question, first)
    # The motion without accelerations of dofs: the answer there is still 0.
    sweep_motion(
        sizes, mechanism, sweep, batch.question, first, batch.answer, start, still,
        opposite_gravity(batch.question, first),
    )  # fmt: skip
    sweep_inertias(sizes, mechanism, sweep)
    write_subtree_forces(sizes, mechanism, sweep, batch.answer, matrix)
    factorise(sweep, batch.answer, matrix, count)
    for dof in range(count):
        batch.answer[start + dof] = batch.question[given + dof] - batch.answer[matrix + count * count + dof]
    solve(sweep, batch.answer, start, count, 1)


@kernel
def forward_dynamics_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """Accelerations, then what `forward_dynamics` leaves behind them; the answer is 0 before."""
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    start = world * count * (count + 2)
    forward_dynamics(sizes, mechanism, sweep, batch, world * question_length(sizes), start)
    note_overflow(batch.answer, start, count)


@kernel
def forward_derivatives_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """Accelerations, and minus their derivatives by positions and rates, and those by forces."""
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    first = world * question_length(sizes)
    start = world * count * (3 * count + 1)
    forward_dynamics(sizes, mechanism, sweep, batch, first, start)
    matrix = start + count
    # The mass matrix comes to lie in the last of the three; the numbers that were in the others are not read.
    for entry in range(count * (count + 1)):
        batch.answer[matrix + entry] = 0.0
    inverse_derivatives(
        sizes, mechanism, sweep, batch.question, first, batch.answer, start, batch.answer, matrix
    )
    inverse = matrix + 2 * count * count
    for entry in range(count * count):
        batch.answer[inverse + entry] = 0.0
    for dof in range(count):
        batch.answer[inverse + dof * count + dof] = 1.0
    solve(sweep, batch.answer, matrix, count, count)
    solve(sweep, batch.answer, matrix + count * count, count, count)
    solve(sweep, batch.answer, inverse, count, count)
    note_overflow(batch.answer, start, count * (3 * count + 1))


@kernel
def coriolis_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    varied: Int32,
    first_world: Int32,
):
    """Coriolis matrix, forces against gravity, and these with those of velocities.

    Accelerations in the question are not read.
    """
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    first = world * question_length(sizes)
    start = world * count * (count + 2)
    lift = opposite_gravity(batch.question, first)
    sweep_positions(sizes, mechanism, batch.question, first)
    # No acceleration is needed: the answer is still 0.
    sweep_motion(
        sizes, mechanism, sweep, batch.question, first, batch.answer, start,
        base_velocity(sizes, batch.question, first), Vector3(0.0, 0.0, 0.0),
    )  # fmt: skip
    for dof in range(sizes.base_dofs):
        # Here derivatives of components count, not of vectors.
        sweep.dof[dof].rate_linear += wp.cross(sweep.subtree[0].omega, sweep.dof[dof].linear)
    sweep_inertias(sizes, mechanism, sweep)
    for behind in range(sizes.nodes):
        node = sizes.nodes - 1 - behind
        first_dof = mechanism.node[node].first_dof
        last = first_dof + mechanism.node[node].dof_count
        bias = flow_matrix(sweep.subtree[node].flow)
        back = wp.transpose(bias)
        momentum = sweep.subtree[node].momentum
        for dof in range(first_dof, last):
            angular = sweep.dof[dof].angular
            linear = sweep.dof[dof].linear
            change_angular = sweep.dof[dof].rate_angular - sweep.dof[dof].turn_angular
            change_linear = sweep.dof[dof].rate_linear - sweep.dof[dof].turn_linear
            force = inertia_force(sweep, node, angular, linear)
            write_coriolis(
                sweep, batch.answer, start, count, dof, first_dof, last,
                back * angular + wp.cross(momentum, linear),
                inertia_torque(sweep, node, angular, linear), force,
                bias * angular + inertia_torque(sweep, node, change_angular, change_linear),
                wp.cross(angular, momentum) + inertia_force(sweep, node, change_angular, change_linear),
            )  # fmt: skip
            batch.answer[start + count * count + dof] = wp.dot(force, lift)
        add_to_parent(mechanism, sweep, node)
    weights = start + count * count
    rates = rates_of(sizes, first)
    for dof in range(count):
        total = real(0.0)
        for other in range(count):
            total += batch.answer[start + dof * count + other] * batch.question[rates + other]
        batch.answer[weights + count + dof] = total + batch.answer[weights + dof]
    note_overflow(batch.answer, start, count * (count + 2))
