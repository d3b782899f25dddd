"""Matrices over pairs of dofs of which one is an ancestor of the other, and equations with the mass matrix.

Written in C++ for the reason given in `maths.blocks`. Entries of other pairs are 0, and are not written.
"""

import warp as wp

from carom.kernels.structs import SweepTable
from carom.kernels.types import Int32, Reals, Vector3

__all__ = ["factorise", "note_overflow", "solve", "write_coriolis", "write_derivatives"]


@wp.func_native("""
    const auto* dofs = &wp::index(sweep.dof, 0);
    const auto* parents = &wp::index(sweep.dof_parent, 0);
    auto* by_position = &wp::index(answer, start);
    auto* by_velocity = by_position + count * count;
    auto* inertia = by_velocity + count * count;
    auto write_row = [&](int other) {
        const auto& it = dofs[other];
        by_position[dof * count + other] = wp::dot(bias, it.turn_angular)
            + wp::dot(torque, it.swing_angular) + wp::dot(force, it.swing_linear);
        by_velocity[dof * count + other] = wp::dot(bias, it.angular)
            + wp::dot(torque, it.rate_angular) + wp::dot(force, it.rate_linear);
        const auto entry = wp::dot(torque, it.angular) + wp::dot(force, it.linear);
        inertia[dof * count + other] = entry;
        return entry;
    };
    for (int other = first; other < last; ++other) {
        const auto entry = write_row(other);
        if (other < dof)
            inertia[other * count + dof] = entry;
    }
    for (int other = parents[first]; other >= 0; other = parents[other]) {
        const auto& it = dofs[other];
        inertia[other * count + dof] = write_row(other);
        by_position[other * count + dof] = wp::dot(position_torque, it.angular)
            + wp::dot(position_force, it.linear);
        by_velocity[other * count + dof] = wp::dot(velocity_torque, it.angular)
            + wp::dot(velocity_force, it.linear);
    }
""")
def write_derivatives(
    sweep: SweepTable,
    answer: Reals,
    start: Int32,
    count: Int32,
    dof: Int32,
    first: Int32,
    last: Int32,
    bias: Vector3,
    torque: Vector3,
    force: Vector3,
    position_torque: Vector3,
    position_force: Vector3,
    velocity_torque: Vector3,
    velocity_force: Vector3,
):
    """Write row and column of a dof into three matrices: derivatives of forces by positions, rates, changes.

    Args:
        sweep: Subspaces of all dofs.
        answer: The matrices, one after the other, row-major, from `start` on.
        start: See there.
        count: Number of dofs.
        dof: The dof.
        first: The first dof of its joint.
        last: The dof behind those of its joint.
        bias: Twice the subtree's transposed bias tensor times the subspace of the dof; its linear part is 0.
        torque: Inertia of the subtree times the subspace, the angular part.
        force: The linear part.
        position_torque: Change of the subtree's force with the position of the dof, the angular part.
        position_force: The linear part.
        velocity_torque: The same with its rate.
        velocity_force: The linear part.
    """
    ...


@wp.func_native("""
    const auto* dofs = &wp::index(sweep.dof, 0);
    const auto* parents = &wp::index(sweep.dof_parent, 0);
    auto* matrix = &wp::index(answer, start);
    auto write_row = [&](int other) {
        const auto& it = dofs[other];
        matrix[dof * count + other] = wp::dot(bias, it.angular)
            + wp::dot(torque, wp::sub(it.rate_angular, it.turn_angular))
            + wp::dot(force, wp::sub(it.rate_linear, it.turn_linear));
    };
    for (int other = first; other < last; ++other)
        write_row(other);
    for (int other = parents[first]; other >= 0; other = parents[other]) {
        write_row(other);
        matrix[other * count + dof] = wp::dot(rate_torque, dofs[other].angular)
            + wp::dot(rate_force, dofs[other].linear);
    }
""")
def write_coriolis(
    sweep: SweepTable,
    answer: Reals,
    start: Int32,
    count: Int32,
    dof: Int32,
    first: Int32,
    last: Int32,
    bias: Vector3,
    torque: Vector3,
    force: Vector3,
    rate_torque: Vector3,
    rate_force: Vector3,
):
    """Write row and column of a dof of the Coriolis matrix, row-major in `answer` from `start` on.

    The arguments up to `force` are those of `write_derivatives`, but that `bias` is not doubled. The others
    are the force of the subtree per rate of the dof, from its bias tensor and the change of the subspace.
    """
    ...


@wp.func_native("""
    const auto* parents = &wp::index(sweep.dof_parent, 0);
    auto* rows = &wp::index(sweep.matrix, 0);
    const auto* given = &wp::index(answer, start);
    for (int entry = 0; entry < count * count; ++entry)
        rows[entry] = given[entry];
    for (int k = count - 1; k >= 0; --k) {
        auto* row = rows + k * count;
        const auto inverse = 1.0 / row[k];
        for (int i = parents[k]; i >= 0; i = parents[i]) {
            const auto factor = row[i] * inverse;
            for (int j = i; j >= 0; j = parents[j])
                rows[i * count + j] -= factor * row[j];
            row[i] = factor;
        }
        row[k] = inverse;
    }
""")
def factorise(sweep: SweepTable, answer: Reals, start: Int32, count: Int32):
    """Factorise the mass matrix in `answer` as transposed L times D times L: into `matrix`.

    Its lower triangle becomes L, its diagonal the inverse of D; see `dynamics.mass_matrix` for the method.
    """
    ...


@wp.func_native("""
    const auto* parents = &wp::index(sweep.dof_parent, 0);
    const auto* rows = &wp::index(sweep.matrix, 0);
    auto* values = &wp::index(answer, start);
    for (int i = count - 1; i >= 0; --i) {
        const auto* own = values + i * width;
        for (int j = parents[i]; j >= 0; j = parents[j]) {
            const auto factor = rows[i * count + j];
            auto* __restrict__ other = values + j * width;
            for (int k = 0; k < width; ++k)
                other[k] -= factor * own[k];
        }
    }
    for (int i = 0; i < count; ++i) {
        auto* __restrict__ own = values + i * width;
        const auto inverse = rows[i * count + i];
        for (int k = 0; k < width; ++k)
            own[k] *= inverse;
        for (int j = parents[i]; j >= 0; j = parents[j]) {
            const auto factor = rows[i * count + j];
            const auto* other = values + j * width;
            for (int k = 0; k < width; ++k)
                own[k] -= factor * other[k];
        }
    }
""")
def solve(sweep: SweepTable, answer: Reals, start: Int32, count: Int32, width: Int32):
    """Replace forces by accelerations: `width` columns, row-major in `answer` from `start` on."""
    ...


@wp.func_native("""
    auto* values = &wp::index(answer, start);
    auto zero = 0.0 * values[0];
    for (int entry = 1; entry < length; ++entry)
        zero += 0.0 * values[entry];
    values[0] += zero;
""")
def note_overflow(answer: Reals, start: Int32, length: Int32):
    """Make the first number NaN if any is not finite, so that only one number has to be checked."""
    ...
