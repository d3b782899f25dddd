"""Velocities at the end of a substep where damping counts implicitly: MuJoCo's Euler, implicitfast, implicit.

Constraints are solved with explicit forces and M. The change of velocity that results, Δv = h M⁻¹ (τ − c +
Jᵀf), becomes the solution of (M − h ∂(τ − c)/∂v) Δv' = M Δv.
"""

import warp as wp

from carom.kernels.dynamics.actuators import advance_activations
from carom.kernels.dynamics.feedback import constraint_feedback
from carom.kernels.dynamics.integration import integrate_positions
from carom.kernels.dynamics.lane_motion import accelerate_tree, place_links
from carom.kernels.dynamics.mass_matrix import composite_inertia
from carom.kernels.dynamics.matrix_rows import write_full_rows
from carom.kernels.dynamics.quarantine import report_fault
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.integrators.frames import integrate_by_frame, is_off_frame
from carom.kernels.integrators.stages import end_of_dofs, to_world_axes
from carom.kernels.integrators.velocity_terms import (
    add_carried_terms,
    add_joint_dampings,
    add_rotation_terms,
    add_user_terms,
)
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.maths.runs import copy_run
from carom.kernels.solver.activity import is_absent, is_left_out, stop_with_base
from carom.kernels.solver.joint_solver import apply_delta_velocities
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.structs import (
    Contacts,
    DofRows,
    Model,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    StageWork,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, RealRows, Vector4Rows, called_func, func, kernel, real
from carom.layouts.newton import EULER, IMPLICIT


@func
def write_full_mass(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
):
    """Write M with armature, of joints and tendons, in all entries of `entry_inverse_mass`."""
    n = model.tree[tree].dof_count
    matrix = model.tree[tree].first_block
    if is_single_body(model, tree):
        # Its free motion needs no matrix.
        place_links(model, state, scratch, world, tree)
        composite_inertia(model, scratch, world, tree)
        write_full_rows(scratch.block_inverse_mass, scratch.block_factor, matrix, world, n)
        first = model.tree[tree].first_dof
        blocks = (n + 3) // 4
        for i in range(n):
            scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + i] += model.dof_armature[
                world, first + i
            ]
    else:
        write_full_rows(scratch.block_inverse_mass, scratch.mass_block, matrix, world, n)
    add_user_terms(model, settings, state, scratch, users, pair_rows, world, tree, real(1.0), real(0.0))


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const int blocks = (count + 3) / 4;
    const four* rows = &wp::index(matrix, world, block);
    const auto* x = &wp::index(vector, world, first);
    auto* y = &wp::index(result, world, first);
    for (int i = 0; i < count; ++i)
        y[i] = 0.0;
    for (int i = 0; i < count; ++i) {
        const double* own = (const double*)(rows + i * blocks);
        const double along = x[i];
        four sum = {};
        int j = 0;
        for (; j + 4 <= i; j += 4)
            for (int q = 0; q < 4; ++q) {
                sum[q] += own[j + q] * x[j + q];
                y[j + q] += own[j + q] * along;
            }
        double total = y[i] + ((sum[0] + sum[2]) + (sum[1] + sum[3]));
        for (; j < i; ++j) {
            total += own[j] * x[j];
            y[j] += own[j] * along;
        }
        y[i] = total + own[i] * along;
    }
""")
def multiply_dense(
    matrix: Vector4Rows, vector: RealRows, result: RealRows, world: Int32, block: Int32, first: Int32,
    count: Int32,
):  # fmt: skip
    """Write the product of a symmetric matrix, of whose rows the entries up to the diagonal count."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const int blocks = (count + 3) / 4;
    four* rows = &wp::index(matrix, world, block);
    auto* x = &wp::index(dofs, world, first);
    // Lᵀ D L, from the last dof on, as the inertia of a tree; where branches are coupled, entries fill in.
    for (int k = count - 1; k >= 0; --k) {
        four* own = rows + k * blocks;
        double* entries = (double*)own;
        const double inverse = entries[k] != 0.0 ? 1.0 / entries[k] : 0.0;
        const double force = x[k].force;
        for (int i = 0; i < k; ++i) {
            if (entries[i] == 0.0)
                continue;
            const double factor = entries[i] * inverse;
            four* row = rows + i * blocks;
            #pragma clang loop vectorize(disable)
            for (int b = 0; b <= i / 4; ++b)
                row[b] = wp::sub(row[b], wp::mul(own[b], factor));
            x[i].force -= factor * force;
        }
        for (int b = 0; b <= k / 4; ++b)
            own[b] = wp::mul(own[b], inverse);
        x[k].force = force * inverse;
    }
    for (int k = 1; k < count; ++k) {
        const double* entries = (const double*)(rows + k * blocks);
        double total = x[k].force;
        for (int i = 0; i < k; ++i)
            total -= entries[i] * x[i].force;
        x[k].force = total;
    }
""")
def solve_symmetric(
    matrix: Vector4Rows, dofs: DofRows, world: Int32, block: Int32, first: Int32, count: Int32
):
    """As `solve_dense`, of a symmetric matrix, of whose rows the entries up to the diagonal count."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const int blocks = (count + 3) / 4;
    four* rows = &wp::index(matrix, world, block);
    auto* x = &wp::index(dofs, world, first);
    // Trees cause no fill-in where elimination begins at the last dof.
    for (int k = count - 1; k > 0; --k) {
        const four* own = rows + k * blocks;
        const double pivot = own[k / 4][k % 4];
        const double inverse = pivot != 0.0 ? 1.0 / pivot : 0.0;
        for (int i = 0; i < k; ++i) {
            four* row = rows + i * blocks;
            const double factor = row[k / 4][k % 4] * inverse;
            if (factor == 0.0)
                continue;
            #pragma clang loop vectorize(disable)
            for (int j = 0; j <= (k - 1) / 4; ++j)
                row[j] = wp::sub(row[j], wp::mul(own[j], factor));
            x[i].force -= factor * x[k].force;
        }
    }
    for (int k = 0; k < count; ++k) {
        const four* own = rows + k * blocks;
        double total = x[k].force;
        for (int j = 0; j < k; ++j)
            total -= own[j / 4][j % 4] * x[j].force;
        const double pivot = own[k / 4][k % 4];
        x[k].force = pivot != 0.0 ? total / pivot : 0.0;
    }
""")
def solve_dense(matrix: Vector4Rows, dofs: DofRows, world: Int32, block: Int32, first: Int32, count: Int32):
    """Replace the forces of dofs by the solution of equations with these forces on their right side.

    The matrix has all its entries, in rows of ceil(count / 4) blocks from `block` on, and is overwritten. It
    need not be symmetric. Dofs without a pivot get 0.
    """
    ...


@called_func
def count_damping(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    work: StageWork,
    world: Int32,
    tree: Int32,
    kind: Int32,
    by_frame: Int32,
):
    """Correct the velocities of a tree, which explicit forces have led to."""
    h = settings.time_step
    first = model.tree[tree].first_dof
    n = model.tree[tree].dof_count
    block = model.tree[tree].first_block
    base = model.tree[tree].first_velocity
    count = end_of_dofs(model, tree) - base
    copy_run(work.dof_rate, state.dof_velocity, base, world, count)
    copy_run(state.dof_velocity, work.dof_first, base, world, count)
    to_world_axes(model, state, world, tree)
    for i in range(n):
        work.dof_change[world, first + i] = (
            work.dof_rate[world, first + i] - state.dof_velocity[world, first + i]
        )
    write_full_mass(model, settings, state, scratch, users, pair_rows, world, tree)
    multiply_dense(scratch.block_inverse_mass, work.dof_change, work.dof_rate, world, block, first, n)
    # As in MuJoCo, rotations of a lone free body are implicit in any case.
    turns = kind == IMPLICIT or (kind != EULER and is_single_body(model, tree))
    if turns and by_frame != 0 and is_off_frame(model, tree):
        # Without the armature of tendons, whose bias forces are explicit.
        add_user_terms(model, settings, state, scratch, users, pair_rows, world, tree, real(-1.0), real(0.0))
        add_carried_terms(model, state, scratch, world, tree, h)
        add_user_terms(model, settings, state, scratch, users, pair_rows, world, tree, real(1.0), real(0.0))
    add_joint_dampings(model, settings, state, scratch, world, tree, kind != EULER, h)
    if kind != EULER:
        add_user_terms(model, settings, state, scratch, users, pair_rows, world, tree, real(0.0), h)
    if turns:
        place_links(model, state, scratch, world, tree)
        add_rotation_terms(model, state, scratch, world, tree, h)
    for i in range(n):
        momentum = work.dof_rate[world, first + i] + 0.0
        work.dof_rate[world, first + i] = scratch.dof[world, first + i].force
        scratch.dof[world, first + i].force = momentum
    if turns:
        solve_dense(scratch.block_inverse_mass, scratch.dof, world, block, first, n)
    else:
        solve_symmetric(scratch.block_inverse_mass, scratch.dof, world, block, first, n)
    for i in range(n):
        work.dof_change[world, first + i] = scratch.dof[world, first + i].force
        scratch.dof[world, first + i].force = work.dof_rate[world, first + i]
    if model.tree[tree].sensor_count > 0 and (kind == IMPLICIT or is_single_body(model, tree)):
        # Loads are found from the forces and factors of free motion, which are overwritten.
        accelerate_tree(model, real(0.0), state, scratch, world, tree)
    bound = model.tree_max_velocity[world, tree]
    sum_of_velocities = real(0.0)
    for i in range(n):
        velocity = state.dof_velocity[world, first + i] + work.dof_change[world, first + i]
        state.dof_velocity[world, first + i] = within_bounds(velocity, -bound, bound)
        sum_of_velocities += velocity
    # What a base without dofs was given moves it as ever.
    for dof in range(base, first):
        state.dof_velocity[world, dof] = work.dof_rate[world, dof]
    report_fault(state, world, tree, sum_of_velocities)


@kernel
def implicit_integration_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    stage_work: StageWork,
    first_world: Int32,
    kind: Int32,
    by_frame: Int32,
):
    """Add delta velocities to the velocities, count damping, and integrate positions.

    `kind` is `EXPLICIT`, `EULER`, `IMPLICIT_FAST` or `IMPLICIT` of `layouts.newton`, `by_frame` is 1 if bases
    move by the origins of their frames.
    """
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
        if is_left_out(state, world, tree):
            if not is_absent(state, world, tree):
                stop_with_base(model, state, world, tree)
        else:
            if model.tree[tree].sensed_count > 0:
                constraint_feedback(model, settings, state, scratch, world, tree)
            apply_delta_velocities(model, state, scratch, world, tree)
            if model.tree[tree].dof_count > 0 and (
                kind > EULER or (kind == EULER and model.tree_joint_terms[world, tree] != 0.0)
            ):
                count_damping(
                    model, settings, state, scratch, users, pair_rows, stage_work, world, tree, kind,
                    by_frame,
                )  # fmt: skip
            if model.tree[tree].actuator_count > 0:
                advance_activations(model, settings, state, world, tree)
            if by_frame != 0 and is_off_frame(model, tree):
                integrate_by_frame(model, state, world, tree, settings.time_step)
            else:
                integrate_positions(model, state, world, tree, settings.time_step)
