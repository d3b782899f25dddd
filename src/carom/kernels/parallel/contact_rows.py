"""The rows of contacts, over islands and worlds."""

import warp as wp

from carom.kernels.parallel.workspace import GIVEN_UP, UNWRITTEN, WRITTEN, is_at_stage, pair_rows_of_island
from carom.kernels.solver.units import write_units
from carom.kernels.structs import Contacts, IslandWork, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, kernel, real
from carom.layouts.status import OVERFLOW, STATUS


@kernel
def island_contacts_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    work: IslandWork,
):
    """Write the contacts of each island whose contacts are not written yet.

    An island whose rows do not fit is given up, and with it the step of its world.
    """
    root, world = wp.tid()
    if not is_at_stage(state, work, world, root, UNWRITTEN):
        return
    units, manifold_blocks, character = Int32(0), Int32(0), Int32(0)
    first_contact = pair_rows.tree_first_contact[world, root]
    if first_contact >= 0:
        units, manifold_blocks, character = write_units(
            model, settings, state, scratch, shapes, contacts,
            pair_rows_of_island(pair_rows, work, world, root), world, first_contact,
            work.tree_progress[world, root].pair_row, work.tree_progress[world, root].block,
            settings.contact_warm_starting * real(work.tree_progress[world, root].resting),
        )  # fmt: skip
    work.tree_progress[world, root].units = units
    work.tree_progress[world, root].manifold_blocks = manifold_blocks
    work.tree_progress[world, root].character = character
    work.tree_progress[world, root].stage = Int32(WRITTEN)
    if work.tree_progress[world, root].visits < 0 or units < 0:
        state.status_entry[world, STATUS] = OVERFLOW
        work.tree_progress[world, root].stage = Int32(GIVEN_UP)
