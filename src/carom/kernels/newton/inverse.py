"""Inverse dynamics with contacts: the forces that a given motion needs, in a step of the converged solver.

The impulse of each row is a function of its residual x = J Δv − b alone, and that of friction also of the
impulse of its normal. So for a given v⁺ they follow without any search, and the rest of M Δv − Jᵀ λ is what
other forces have to give.
"""

import math

import warp as wp

from carom.kernels.newton.bounds import bound_by_normal, follows_normal, set_bound
from carom.kernels.newton.envelope import clear_entries, multiply_mass
from carom.kernels.newton.island_rows import fit_matrices, gather_rows
from carom.kernels.newton.law import apply_law, push_by_impulses, row_products
from carom.kernels.newton.members import add_changes, place_of, write_masses
from carom.kernels.newton.results import keep_results
from carom.kernels.solver.joint_solver import keep_row_results
from carom.kernels.solver.solver import keep_constraint_impulses
from carom.kernels.structs import (
    Contacts,
    Model,
    NewtonWork,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, called_func, func, kernel, real
from carom.layouts.newton import MEMBERS, PLACES, REBOUNDING, ROWS
from carom.layouts.status import OVERFLOW, STATUS

_NOT_A_NUMBER = real(math.nan)


@func
def place_trees(model: Model, settings: Settings, state: State, work: NewtonWork, world: Int32, root: Int32):
    """Make all trees of an island its members, also those that no row acts on."""
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == root:
            place_of(model, work, world, tree)


@func
def take_motion(model: Model, state: State, work: NewtonWork, world: Int32):
    """Write Δv, from the free motion to the velocities that are wanted."""
    clear_entries(work.vector_change, world, 4 * work.count_newton[world, PLACES])
    for member in range(work.count_newton[world, MEMBERS]):
        tree = work.tree_member[world, member]
        place, first = 4 * work.tree_place[world, tree], model.tree[tree].first_dof
        for i in range(model.tree[tree].dof_count):
            change = work.dof_wanted[world, first + i] - state.dof_velocity[world, first + i]
            work.vector_change[world, place + i] = change


@func
def find_impulses(work: NewtonWork, pair_rows: PairRows, world: Int32):
    """Write the impulses of all rows for Δv: normals first, which bound friction."""
    rows = work.count_newton[world, ROWS]
    row_products(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, rows, Int32(0))
    apply_law(work.newton_row, world, rows)
    for row in range(rows):
        if follows_normal(work, world, row):
            set_bound(work, world, row, bound_by_normal(work, world, row))
    apply_law(work.newton_row, world, rows)


@func
def put_impulses(model: Model, work: NewtonWork, world: Int32):
    """Write M Δv − Jᵀ λ, and Jᵀ λ, by dofs; both are impulses. Not a number where bodies rebound."""
    for member in range(work.count_newton[world, MEMBERS]):
        tree = work.tree_member[world, member]
        place, first = 4 * work.tree_place[world, tree], model.tree[tree].first_dof
        for i in range(model.tree[tree].dof_count):
            pushed = work.vector_gradient[world, place + i]
            if work.count_newton[world, REBOUNDING] > 0:
                pushed = _NOT_A_NUMBER
            work.dof_asked[world, first + i] = work.vector_push[world, place + i] - pushed
            work.dof_pushed[world, first + i] = pushed


@called_func
def invert_island(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    root: Int32,
    compliant: Int32,
):
    """Find what the wanted motion of an island needs, and let the island move so."""
    joint_rows = gather_rows(
        model, settings, state, scratch, shapes, contacts, users, pair_rows, work, world, root, compliant
    )
    place_trees(model, settings, state, work, world, root)
    size = 4 * work.count_newton[world, PLACES]
    entries = fit_matrices(work, pair_rows, world)
    if entries < 0:
        state.status_entry[world, STATUS] = OVERFLOW
        return
    if entries > 0:
        write_masses(model, state, scratch, work, world, entries)
        take_motion(model, state, work, world)
        find_impulses(work, pair_rows, world)
        multiply_mass(
            work.matrix_mass, work.vector_own, work.vector_start, work.vector_change, work.vector_push, world,
            size // 4,
        )  # fmt: skip
        clear_entries(work.vector_gradient, world, size)
        push_by_impulses(
            work.newton_row, pair_rows.jacobian_row, work.vector_gradient, world,
            work.count_newton[world, ROWS], 1.0, Int32(0),
        )  # fmt: skip
        put_impulses(model, work, world)
        add_changes(model, scratch, work, world, Int32(0))
    keep_results(scratch, contacts, pair_rows, work, world)
    keep_row_results(model, settings, state, scratch, world, root, joint_rows, Int32(0), real(0.0))
    keep_constraint_impulses(model, settings, state, users, pair_rows, world, root)


@kernel
def inverse_constraints_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    newton_work: NewtonWork,
    first_world: Int32,
    compliant: Int32,
):
    """As `converged_constraints_kernel`, for velocities that are given in `dof_wanted`."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        newton_work.tree_place[world, tree] = -1
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            invert_island(
                model,
                settings,
                state,
                scratch,
                shapes,
                contacts,
                users,
                pair_rows,
                newton_work,
                world,
                tree,
                compliant,
            )
