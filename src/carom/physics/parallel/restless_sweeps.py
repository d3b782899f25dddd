"""The sweeps over the rows of islands that are not calm, over islands and worlds."""

import warp as wp

from carom.model.contact_structs import Couplings
from carom.model.real import kernel
from carom.model.structs import Scratch, Settings, State
from carom.physics.parallel.sweeps import sweep
from carom.physics.parallel.workspace import WRITTEN, IslandWork, is_called_off


@kernel
def restless_sweeps_kernel(
    settings: Settings, state: State, scratch: Scratch, couplings: Couplings, work: IslandWork
):
    """Solve each island that is not calm, or could not be solved as if it were."""
    root, world = wp.tid()
    if is_called_off(state, world):
        return
    if (
        state.tree_island[world, root] == root
        and work.tree_progress[world, root].stage == WRITTEN
        and work.tree_progress[world, root].calm == 0
    ):
        visits = work.tree_progress[world, root].made[3]
        sweep(settings, scratch, couplings, work, world, root, visits, 0)
