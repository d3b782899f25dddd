"""Control of a point on a link of a body with a fixed base: operational space and impedance control.

After O. Khatib, "A unified approach for motion and force control of robot manipulators: the operational space
formulation" (1987), and N. Hogan, "Impedance control" (1985). A task has six coordinates, or only the three
of the position, which come first.
"""

import math

import warp as wp

from carom.kernels.joints.coordinates import quaternion_at, vector_at
from carom.kernels.maths.jacobi import diagonalise, rotate_all
from carom.kernels.maths.rotation import rotation_vector
from carom.kernels.mechanism.dynamics import (
    composite_inertia,
    first_rate,
    newton_euler,
    place_in_base,
    swing_matrix,
    turned_back,
)
from carom.kernels.mechanism.sweep import base_rotation
from carom.kernels.structs import MechanismSizes, MechanismTable, SweepTable, TaskControl
from carom.kernels.types import Int32, Reals, Vector3, func, kernel, real

# Directions of less mobility than this share of the greatest are not controlled.
SINGULAR = real(1e-6)
NOT_A_NUMBER = real(math.nan)
# Places in `question`.
WANTED_POSE = wp.constant(10)
HAS_ORIENTATION = wp.constant(17)
WANTED_VELOCITY = wp.constant(18)
WANTED_ACCELERATION = wp.constant(24)
WANTED_FORCE = wp.constant(30)


@func
def find_task(
    sizes: MechanismSizes, mechanism: MechanismTable, sweep: SweepTable, task: TaskControl, link: Int32
):
    """Compute error, Jacobian, velocity and bias of the task, for all six coordinates."""
    last = sweep.link[link].node
    to_world = base_rotation(task.question, 0)
    of_node = to_world * mechanism.motion[last].rotation
    on_node = sweep.link[link].origin + sweep.link[link].turn * vector_at(task.axis_point, 0)
    point = mechanism.motion[last].position + mechanism.motion[last].rotation * on_node
    present = vector_at(task.question, 3) + to_world * point
    shift = vector_at(task.question, WANTED_POSE) - present
    turn = Vector3(0.0, 0.0, 0.0)
    if task.question[HAS_ORIENTATION] != 0.0:
        wanted = quaternion_at(task.question, WANTED_POSE + 3)
        norm = wp.length(wanted)
        if norm > 0.0:
            here = wp.normalize(wp.quat_from_matrix(of_node * sweep.link[link].turn))
            turn = rotation_vector((wanted / norm) * wp.quat_inverse(here))
        else:
            turn = Vector3(NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER)
    swing = swing_matrix(mechanism.motion[last].omega, mechanism.motion[last].alpha)
    drift = of_node * (mechanism.motion[last].acceleration + swing * on_node) + vector_at(task.question, 0)
    spin = of_node * mechanism.motion[last].alpha
    for k in range(3):
        task.axis_error[k] = shift[k]
        task.axis_error[3 + k] = turn[k]
        task.axis_bias[k] = drift[k]
        task.axis_bias[3 + k] = spin[k]
        task.axis_velocity[k] = 0.0
        task.axis_velocity[3 + k] = 0.0
    for entry in range(6 * sizes.dofs):
        task.column_jacobian[entry] = 0.0
    rates = first_rate(sizes)
    node = last + 0
    while node >= 0:
        first = mechanism.node[node].first_dof
        for dof in range(first, first + mechanism.node[node].dof_count):
            angular = to_world * mechanism.axis[dof].angular
            linear = to_world * (mechanism.axis[dof].linear + wp.cross(mechanism.axis[dof].angular, point))
            rate = mechanism.input[rates + dof]
            for k in range(3):
                task.column_jacobian[k * sizes.dofs + dof] = linear[k]
                task.column_jacobian[(3 + k) * sizes.dofs + dof] = angular[k]
                task.axis_velocity[k] += linear[k] * rate
                task.axis_velocity[3 + k] += angular[k] * rate
        node = mechanism.node[node].parent


@func
def factorise(mechanism: MechanismTable, task: TaskControl, dofs: Int32):
    """Compute the lower Cholesky factor of the mass matrix; it is NaN if the matrix is not positive."""
    for i in range(dofs):
        for j in range(i + 1):
            value = mechanism.matrix[i * dofs + j]
            for k in range(j):
                value -= task.entry_factor[i * dofs + k] * task.entry_factor[j * dofs + k]
            if i == j:
                task.entry_factor[i * dofs + i] = wp.sqrt(value) if value > 0.0 else NOT_A_NUMBER
            else:
                task.entry_factor[i * dofs + j] = value / task.entry_factor[j * dofs + j]


@func
def find_mobility(task: TaskControl, rows: Int32, dofs: Int32):
    """Compute J M⁻¹ Jᵀ, (rows, rows), in `axis_mobility`."""
    for row in range(rows):
        start = row * dofs
        for i in range(dofs):
            value = task.column_jacobian[start + i]
            for k in range(i):
                value -= task.entry_factor[i * dofs + k] * task.column_solved[start + k]
            task.column_solved[start + i] = value / task.entry_factor[i * dofs + i]
        for other in range(row + 1):
            total = real(0.0)
            for i in range(dofs):
                total += task.column_solved[start + i] * task.column_solved[other * dofs + i]
            task.axis_mobility[row * rows + other] = total
            task.axis_mobility[other * rows + row] = total


@func
def diagonalise_task(matrix: Reals, vectors: Reals, rows: Int32):
    """Diagonalise a matrix in place; eigenvectors become the columns of `vectors`."""
    for entry in range(rows * rows):
        vectors[entry] = 1.0 if entry % (rows + 1) == 0 else 0.0
    diagonalise(matrix, vectors, rows)
    # Eigenvectors converge after entries beside the diagonal are small.
    rotate_all(matrix, vectors, rows)


@func
def greatest(matrix: Reals, rows: Int32) -> real:
    """The greatest entry on the diagonal, at least 0."""
    most = real(0.0)
    for k in range(rows):
        most = wp.max(most, matrix[k * rows + k])
    return most


@func
def put_power(values: Reals, vectors: Reals, least: real, exponent: real, power: Reals, rows: Int32):
    """Write a power of a diagonalised matrix, without directions of eigenvalues up to `least`."""
    for row in range(rows):
        for other in range(row + 1):
            total = real(0.0)
            for k in range(rows):
                value = values[k * rows + k]
                if value > least:
                    total += vectors[row * rows + k] * vectors[other * rows + k] * wp.pow(value, exponent)
            power[row * rows + other] = total
            power[other * rows + row] = total


@func
def put_product(left: Reals, right: Reals, scale: real, answer: Reals, rows: Int32):
    """Write the product of two matrices and a number."""
    for row in range(rows):
        for column in range(rows):
            total = real(0.0)
            for k in range(rows):
                total += left[row * rows + k] * right[k * rows + column]
            answer[row * rows + column] = scale * total


@func
def find_damping(task: TaskControl, least: real, rows: Int32):
    """Compute D = 2 ζ √Λ √(√Λ⁻¹ K √Λ⁻¹) √Λ, from the diagonalised mobility."""
    put_power(task.axis_mobility, task.axis_vectors, least, -0.5, task.axis_root, rows)
    put_power(task.axis_mobility, task.axis_vectors, least, 0.5, task.axis_inverse, rows)
    put_product(task.axis_inverse, task.axis_stiffness, 1.0, task.axis_product, rows)
    put_product(task.axis_product, task.axis_inverse, 1.0, task.axis_damping, rows)
    diagonalise_task(task.axis_damping, task.axis_vectors, rows)
    put_power(task.axis_damping, task.axis_vectors, 0.0, 0.5, task.axis_product, rows)
    put_product(task.axis_root, task.axis_product, 2.0 * task.axis_ratio[0], task.axis_inverse, rows)
    put_product(task.axis_inverse, task.axis_root, 1.0, task.axis_damping, rows)


@func
def find_force(sizes: MechanismSizes, task: TaskControl, rows: Int32, spring: Int32):
    """Compute the force on the task, without what undoes the motion that the posture gives the task."""
    for row in range(rows):
        force = real(0.0)
        if spring == 1:
            force = task.question[WANTED_FORCE + row]
        for k in range(rows):
            entry = row * rows + k
            # What the task gains from accelerations of the posture.
            pushed = real(0.0)
            for dof in range(sizes.dofs):
                pushed += task.column_jacobian[k * sizes.dofs + dof] * task.dof_posture[dof]
            motion = task.question[WANTED_ACCELERATION + k] - task.axis_bias[k] - pushed
            late = task.question[WANTED_VELOCITY + k] - task.axis_velocity[k]
            if spring == 1:
                force += task.axis_stiffness[entry] * task.axis_error[k] + task.axis_damping[entry] * late
            else:
                omega = task.axis_frequency[k]
                motion += omega * (2.0 * task.axis_ratio[k] * late + omega * task.axis_error[k])
            force += task.axis_inertia[entry] * motion
        task.axis_force[row] = force


@func
def find_torques(sizes: MechanismSizes, mechanism: MechanismTable, task: TaskControl, rows: Int32):
    """Compute the torques; the first is NaN if any is not finite, so that only one has to be checked."""
    zero = real(0.0)
    for dof in range(sizes.dofs):
        torque = mechanism.output[dof]
        for row in range(rows):
            torque += task.column_jacobian[row * sizes.dofs + dof] * task.axis_force[row]
        for k in range(sizes.dofs):
            torque += mechanism.matrix[dof * sizes.dofs + k] * task.dof_posture[k]
        task.dof_torque[dof] = torque
        # Powers leave out what is not a number.
        zero += 0.0 * (torque + task.entry_factor[dof * sizes.dofs + dof])
    if wp.isnan(zero):
        task.dof_torque[0] = zero


@kernel
def task_control_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    task: TaskControl,
    link: Int32,
    rows: Int32,
    spring: Int32,
):
    """Compute the torques of a task in `dof_torque`: of impedance control if `spring` is 1.

    The base is fixed; links count from 0, the base.
    """
    still = Vector3(0.0, 0.0, 0.0)
    lift = -turned_back(base_rotation(task.question, 0), vector_at(task.question, 0))
    newton_euler(sizes, mechanism, still, still, lift, mechanism.input, first_rate(sizes), -1)
    for node in range(sizes.nodes):
        place_in_base(mechanism, node)
    composite_inertia(sizes, mechanism)
    find_task(sizes, mechanism, sweep, task, link)
    factorise(mechanism, task, sizes.dofs)
    find_mobility(task, rows, sizes.dofs)
    diagonalise_task(task.axis_mobility, task.axis_vectors, rows)
    least = SINGULAR * greatest(task.axis_mobility, rows)
    put_power(task.axis_mobility, task.axis_vectors, least, -1.0, task.axis_inertia, rows)
    if spring == 1:
        find_damping(task, least, rows)
    rates = first_rate(sizes)
    for dof in range(sizes.dofs):
        pull = task.dof_frequency[dof]
        task.dof_posture[dof] = pull * (pull * task.dof_pull[dof] - 2.0 * mechanism.input[rates + dof])
    find_force(sizes, task, rows, spring)
    find_torques(sizes, mechanism, task, rows)
