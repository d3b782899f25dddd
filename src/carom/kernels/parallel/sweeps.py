"""The sweeps over the rows of islands, parallel over islands and worlds."""

import warp as wp

from carom.kernels.parallel.workspace import (
    UNWRITTEN,
    WRITTEN,
    is_at_stage,
    pair_rows_of_island,
    scratch_of_island,
)
from carom.kernels.solver.solver import forget_changes, sweep_island
from carom.kernels.solver.warm_starting import SOLVED, UNSOLVED
from carom.kernels.structs import Contacts, IslandWork, Model, PairRows, Scratch, Settings, State
from carom.kernels.types import Int32, func, kernel, real


@func
def sweep(
    model: Model,
    settings: Settings,
    scratch: Scratch,
    contacts: Contacts,
    pair_rows: PairRows,
    work: IslandWork,
    world: Int32,
    root: Int32,
    rows: Int32,
    visits: Int32,
    resting: Int32,
) -> real:
    """Relax the rows of an island until they hardly change; returns the residual, see `sweep_island`."""
    progress = work.tree_progress[world, root]
    residual, sweeps = sweep_island(
        model, settings, scratch_of_island(scratch, work, world, root), contacts,
        pair_rows_of_island(pair_rows, work, world, root), world, root, rows, visits,
        progress.units, progress.manifold_blocks, progress.character, resting,
    )  # fmt: skip
    work.tree_progress[world, root].residual = residual
    work.tree_progress[world, root].sweeps = sweeps
    return residual


@kernel
def resting_sweeps_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    pair_rows: PairRows,
    work: IslandWork,
):
    """Solve each island at rest; if it does not converge, its contacts are rewritten with zero impulses."""
    root, world = wp.tid()
    if not is_at_stage(state, work, world, root, WRITTEN) or work.tree_progress[world, root].resting == 0:
        return
    # An island at rest has no motors, limits or user constraints to visit.
    residual = sweep(model, settings, scratch, contacts, pair_rows, work, world, root, 0, 0, 1)
    work.tree_progress[world, root].outcome = Int32(SOLVED)
    if residual > settings.residual_threshold:
        work.tree_progress[world, root].outcome = Int32(UNSOLVED)
        work.tree_progress[world, root].resting = 0
        work.tree_progress[world, root].stage = Int32(UNWRITTEN)
        forget_changes(settings, model, state, scratch, world, root)
