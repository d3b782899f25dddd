"""Rows of motors, limits and user constraints, and the results of all rows, over islands and worlds."""

import warp as wp

from carom.kernels.parallel.workspace import (
    UNWRITTEN,
    WRITTEN,
    is_at_stage,
    is_called_off,
    pair_rows_of_island,
    scratch_of_island,
)
from carom.kernels.solver.joint_solver import keep_row_results
from carom.kernels.solver.solver import island_rows, keep_constraint_impulses
from carom.kernels.solver.units import keep_unit_impulses
from carom.kernels.solver.warm_starting import NOT_RESTING
from carom.kernels.structs import (
    Contacts,
    IslandProgress,
    IslandWork,
    Model,
    PairRows,
    Scratch,
    Settings,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, kernel


@kernel
def island_rows_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    work: IslandWork,
):
    """Begin to solve each island: write its rows of motors, limits and user constraints."""
    root, world = wp.tid()
    if is_called_off(state, world) or state.tree_island[world, root] != root:
        return
    own_scratch = scratch_of_island(scratch, work, world, root)
    own_pair_rows = pair_rows_of_island(pair_rows, work, world, root)
    rows, pair_row, block, visits = island_rows(
        model, settings, state, own_scratch, users, own_pair_rows, world, root
    )
    progress = IslandProgress()
    progress.rows = rows
    progress.pair_row = pair_row
    progress.block = block
    progress.visits = visits
    progress.resting = wp.min(pair_rows.tree_rest[world, root], 1)
    progress.outcome = Int32(NOT_RESTING)
    progress.stage = Int32(UNWRITTEN)
    work.tree_progress[world, root] = progress


@kernel
def island_impulses_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    work: IslandWork,
):
    """Store the impulses of each island, and its numbers of rows and sweeps and its residual."""
    root, world = wp.tid()
    if not is_at_stage(state, work, world, root, WRITTEN):
        return
    own_scratch = scratch_of_island(scratch, work, world, root)
    own_pair_rows = pair_rows_of_island(pair_rows, work, world, root)
    done = work.tree_progress[world, root]
    keep_row_results(model, settings, state, own_scratch, world, root, done.rows, done.sweeps, done.residual)
    keep_unit_impulses(contacts, own_pair_rows, world, done.units, done.outcome)
    keep_constraint_impulses(model, settings, state, users, own_pair_rows, world, root)
