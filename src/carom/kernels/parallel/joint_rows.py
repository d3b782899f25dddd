"""The rows of motors, limits and user constraints, and what comes of all rows, over islands and worlds."""

import warp as wp

from carom.kernels.parallel.workspace import (
    UNWRITTEN,
    WRITTEN,
    couplings_of_island,
    is_called_off,
    scratch_of_island,
)
from carom.kernels.solver.calm import NOT_CALM
from carom.kernels.solver.joint_solver import keep_row_results
from carom.kernels.solver.solver import island_rows, keep_constraint_impulses
from carom.kernels.solver.units import keep_unit_impulses
from carom.kernels.structs import (
    Contacts,
    Couplings,
    IslandWork,
    Model,
    Scratch,
    Settings,
    State,
    UserConstraints,
)
from carom.kernels.types import Index4, Int32, kernel


@kernel
def island_rows_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    couplings: Couplings,
    work: IslandWork,
):
    """Begin the search for the impulses of each island."""
    root, world = wp.tid()
    if is_called_off(state, world) or state.tree_island[world, root] != root:
        return
    own_scratch = scratch_of_island(scratch, work, world, root)
    own_couplings = couplings_of_island(couplings, work, world, root)
    work.tree_progress[world, root].made = island_rows(
        model, settings, state, own_scratch, users, own_couplings, world, root
    )
    work.tree_progress[world, root].units = Index4(0, 0, 0, 0)
    work.tree_progress[world, root].calm = wp.min(couplings.tree_calm[world, root], 1)
    work.tree_progress[world, root].outcome = Int32(NOT_CALM)
    work.tree_progress[world, root].stage = Int32(UNWRITTEN)


@kernel
def island_impulses_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    work: IslandWork,
):
    """Report how the search went in each island, and the impulses found."""
    root, world = wp.tid()
    if is_called_off(state, world):
        return
    if state.tree_island[world, root] != root or work.tree_progress[world, root].stage != WRITTEN:
        return
    own_scratch = scratch_of_island(scratch, work, world, root)
    own_couplings = couplings_of_island(couplings, work, world, root)
    keep_row_results(
        model,
        settings,
        state,
        own_scratch,
        world,
        root,
        work.tree_progress[world, root].made[0],
        work.tree_progress[world, root].sweeps,
        work.tree_progress[world, root].residual,
    )
    keep_unit_impulses(
        contacts,
        own_couplings,
        world,
        work.tree_progress[world, root].units[0],
        work.tree_progress[world, root].outcome,
    )
    keep_constraint_impulses(model, state, users, own_couplings, world, root)
