"""Inverse dynamics, mass matrices and Jacobians of one body in many worlds.

A thread goes through its worlds with one mechanism: the row of a world is copied into it, and the result out
of it.
"""

import warp as wp

from carom.kernels.mechanism.dynamics import jacobian, mass_matrix
from carom.kernels.mechanism.motion import forces_of_motion
from carom.kernels.structs import MechanismBatch, MechanismSizes, MechanismTable
from carom.kernels.types import Int32, Reals, func, kernel
from carom.layouts.mechanism import BASE_MOTION

# Rows of a Jacobian: linear and angular velocity.
_ROWS = wp.constant(6)


@func
def take_parameters(sizes: MechanismSizes, mechanism: MechanismTable, batch: MechanismBatch, world: Int32):
    """Give the mechanism the masses, inertias and armature of a world."""
    for node in range(sizes.nodes):
        row = world * sizes.nodes + node
        mechanism.node[node].mass = batch.mass[row]
        mechanism.node[node].moment = batch.moment[row]
        mechanism.node[node].inertia = batch.inertia[row]
    for dof in range(sizes.dofs):
        mechanism.dof_armature[dof] = batch.armature[world * sizes.dofs + dof]


@func
def copy_row(source: Reals, first: Int32, target: Reals, first_target: Int32, count: Int32):
    """Copy `count` numbers."""
    for index in range(count):
        target[first_target + index] = source[first + index]


@kernel
def forces_in_worlds_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    batch: MechanismBatch,
    length: Int32,
    varied: Int32,
    first_world: Int32,
):
    """Answer questions of `motion_kernel`, `length` numbers for each world; answers have one for each dof.

    If `varied` is 1, masses, inertias and armature differ between worlds.
    """
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    forces_of_motion(sizes, mechanism, batch.question, world * length, 0)
    copy_row(mechanism.output, 0, batch.answer, world * sizes.dofs, sizes.dofs)


@kernel
def mass_matrices_in_worlds_kernel(
    sizes: MechanismSizes, mechanism: MechanismTable, batch: MechanismBatch, varied: Int32, first_world: Int32
):
    """Compute mass matrices, row-major; the question is the joint positions."""
    world = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.coordinates
    copy_row(batch.question, world * count, mechanism.input, BASE_MOTION, count)
    mass_matrix(sizes, mechanism)
    entries = sizes.dofs * sizes.dofs
    copy_row(mechanism.matrix, 0, batch.answer, world * entries, entries)


@kernel
def jacobians_in_worlds_kernel(
    sizes: MechanismSizes, mechanism: MechanismTable, batch: MechanismBatch, end: Int32, first_world: Int32
):
    """Compute Jacobians of a link as `jacobian_kernel`; the question is a point and the joint positions."""
    world = first_world + wp.tid()
    count = sizes.coordinates
    first = world * (3 + count)
    copy_row(batch.question, first, mechanism.input, 0, 3)
    copy_row(batch.question, first + 3, mechanism.input, BASE_MOTION, count)
    jacobian(sizes, mechanism, end)
    entries = _ROWS * sizes.dofs
    copy_row(mechanism.output, 0, batch.answer, world * entries, entries)
