"""The worlds that take part in a run of steps, and the result of each step."""

import warp as wp

from carom.kernels.contact.manifold import restore_contacts
from carom.kernels.parallel.workspace import went_wrong
from carom.kernels.structs import Contacts, Pairs, RunWork, State
from carom.kernels.types import Int32, kernel
from carom.layouts.parallel import BEGIN, RESUME, STAY
from carom.layouts.status import CONTACTS_WANTED, LEFT_OUT, PAIRS_WANTED, STATUS, STEPS_DONE, WELL


@kernel
def ask_kernel(state: State, run: RunWork):
    """Let each world begin a run of steps, continue one, or do nothing."""
    world = wp.tid()
    part = run.world_part[world]
    if part == STAY:
        state.status_entry[world, STATUS] = LEFT_OUT
    if part == BEGIN or part == RESUME:
        state.status_entry[world, STATUS] = WELL
        state.status_entry[world, PAIRS_WANTED] = 0
        state.status_entry[world, CONTACTS_WANTED] = 0
    if part == BEGIN:
        state.status_entry[world, STEPS_DONE] = 0


@kernel
def finish_kernel(state: State, contacts: Contacts, pairs: Pairs, run: RunWork):
    """Count the step of each world, or restore its contacts from the start of the step."""
    world = wp.tid()
    if went_wrong(state, world):
        restore_contacts(contacts, pairs, world)
        # Several threads may write this; all write 1.
        run.trouble[0] = Int32(1)
    elif state.status_entry[world, STATUS] == WELL:
        state.status_entry[world, STEPS_DONE] += 1
