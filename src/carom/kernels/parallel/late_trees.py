"""Stages as those of `trees`, in place of these and beside them, for late velocities of links.

Steps of worlds without such links never launch them.
"""

import warp as wp

from carom.kernels.late.trees import any_free_motion, move_or_stop_any
from carom.kernels.late.velocities import keep_late_start, return_to_late_start
from carom.kernels.parallel.workspace import is_called_off, state_of_tree, went_wrong
from carom.kernels.solver.islands import may_be_pushed
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.structs import (
    Contacts,
    IslandWork,
    Model,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
    UserConstraints,
)
from carom.kernels.types import kernel


@kernel
def late_begin_kernel(model: Model, state: State, scratch: Scratch):
    """Save the late velocities of each tree at the start of a step."""
    tree, world = wp.tid()
    if not is_called_off(state, world):
        keep_late_start(model, state, scratch, world, tree)


@kernel
def late_tree_free_motion_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, pair_rows: PairRows, work: IslandWork
):
    """As `tree_free_motion_kernel`."""
    tree, world = wp.tid()
    if is_called_off(state, world):
        return
    work.tree_free_fault[world, tree] = 0
    pushed = may_be_pushed(model, pair_rows, world, tree)
    own_state = state_of_tree(state, work.tree_free_fault, tree)
    any_free_motion(model, settings, own_state, scratch, world, tree, pushed)


@kernel
def late_tree_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    work: IslandWork,
):
    """As `tree_motion_kernel`."""
    tree, world = wp.tid()
    if is_called_off(state, world):
        return
    work.tree_motion_fault[world, tree] = 0
    own_state = state_of_tree(state, work.tree_motion_fault, tree)
    gather_link_forces(settings, model, own_state, scratch, shapes, contacts, users, world, tree)
    move_or_stop_any(settings, model, own_state, scratch, world, tree)


@kernel
def late_end_kernel(model: Model, state: State, scratch: Scratch):
    """Restore the late velocities of each tree in worlds whose step failed."""
    tree, world = wp.tid()
    if went_wrong(state, world):
        return_to_late_start(model, state, scratch, world, tree)
