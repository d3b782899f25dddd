"""The kernel that takes the place of `solver.stages.constraints_kernel` where constraints converge."""

import warp as wp

from carom.kernels.maths.shares import next_share
from carom.kernels.newton.bounds import solve_with_bounds
from carom.kernels.newton.equations import gradient_size
from carom.kernels.newton.given import moves_by_given_forces
from carom.kernels.newton.impacts import resolve_impacts
from carom.kernels.newton.island_rows import fit_matrices, gather_rows
from carom.kernels.newton.members import add_changes, write_masses
from carom.kernels.newton.noslip import hold_by_friction
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
from carom.kernels.types import Int32, IntRows, called_func, kernel, real
from carom.layouts.newton import PLACES, REBOUNDING, ROWS, SHORT
from carom.layouts.status import OVERFLOW, STATUS


@called_func
def solve_converged_island(
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
    noslip: Int32,
):
    """Solve the rows of one island; leaves the result in `delta_velocity`, and stores all impulses."""
    joint_rows = gather_rows(
        model, settings, state, scratch, shapes, contacts, users, pair_rows, work, world, root, compliant
    )
    rows = work.count_newton[world, ROWS]
    size = 4 * work.count_newton[world, PLACES]
    iterations, residual = Int32(0), real(0.0)
    rebounds, entries = Int32(0), Int32(0)
    # With 0 iterations there are no impulses, as with sweeps.
    has_rows = rows > 0 and settings.iterations > 0
    is_plain = (
        work.count_newton[world, REBOUNDING] == 0 and work.count_newton[world, SHORT] == 0 and noslip == 0
    )
    if has_rows and is_plain and moves_by_given_forces(model, scratch, work, pair_rows, world):
        add_changes(model, scratch, work, world, rebounds)
    else:
        entries = fit_matrices(work, pair_rows, world)
    if entries > 0 and has_rows:
        write_masses(model, state, scratch, work, world, entries)
        if work.count_newton[world, REBOUNDING] > 0:
            rebounds = Int32(1)
            iterations = resolve_impacts(work, pair_rows, settings, world, entries)
        if iterations >= 0:
            more = solve_with_bounds(work, pair_rows, world, entries)
            iterations = wp.where(more < 0, more, iterations + more)
            sizes = gradient_size(work.vector_gradient, work.vector_push, work.vector_scale, world, size)
            residual = sizes[0] * sizes[0]
            if compliant == 1 and noslip > 0 and iterations >= 0:
                hold_by_friction(model, settings, scratch, work, pair_rows, world, entries, noslip)
        add_changes(model, scratch, work, world, rebounds)
    if entries < 0 or work.count_newton[world, SHORT] != 0:
        state.status_entry[world, STATUS] = OVERFLOW
        return
    keep_results(scratch, contacts, pair_rows, work, world)
    keep_row_results(
        model, settings, state, scratch, world, root, joint_rows, wp.max(iterations, 0), residual
    )
    keep_constraint_impulses(model, settings, state, users, pair_rows, world, root)


@kernel
def converged_constraints_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    newton_work: NewtonWork,
    taken: IntRows,
    first_world: Int32,
    compliant: Int32,
    noslip: Int32,
):
    """Compute the delta velocities by motors, limits, user constraints and contacts.

    If `compliant` is 1, contacts of files that state MuJoCo's law follow that; all others are rigid. Then at
    most `noslip` passes follow after which friction does not yield. A share, see `maths.shares`, is an
    island.
    """
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        newton_work.tree_place[world, tree] = -1
    island = Int32(0)
    own = next_share(taken, Int32(-1))
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            if island == own:
                solve_converged_island(
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
                    noslip,
                )
                own = next_share(taken, own)
            island += 1
