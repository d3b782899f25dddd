"""The sweeps over the rows of moving islands, parallel over islands and worlds."""

import warp as wp

from carom.kernels.parallel.sweeps import sweep
from carom.kernels.parallel.workspace import WRITTEN, is_at_stage
from carom.kernels.structs import Contacts, IslandWork, Model, PairRows, Scratch, Settings, State
from carom.kernels.types import kernel


@kernel
def restless_sweeps_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    pair_rows: PairRows,
    work: IslandWork,
):
    """Solve each island that moves, or that did not converge as one at rest."""
    root, world = wp.tid()
    if is_at_stage(state, work, world, root, WRITTEN) and work.tree_progress[world, root].resting == 0:
        rows = work.tree_progress[world, root].rows
        visits = work.tree_progress[world, root].visits
        sweep(model, settings, scratch, contacts, pair_rows, work, world, root, rows, visits, 0)
