"""Stages of a step that are parallel over trees and worlds, and those over worlds alone between them."""

import warp as wp

from carom.kernels.dynamics.kinematics import update_link_poses
from carom.kernels.dynamics.motors import joint_damping
from carom.kernels.dynamics.quarantine import keep_start, keep_start_impulses, return_to_start_impulses
from carom.kernels.dynamics.step import free_motion, move_or_stop
from carom.kernels.dynamics.step_ends import abandon_tree, end_tree
from carom.kernels.parallel.layout import lay_out_islands
from carom.kernels.parallel.workspace import is_called_off, state_of_tree, went_wrong
from carom.kernels.solver.islands import build_islands, may_be_pushed
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.structs import (
    Contacts,
    IslandWork,
    Model,
    PairRows,
    Pairs,
    Scratch,
    Settings,
    Shapes,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, IntRows, func, kernel
from carom.layouts.contacts import NONE_KEPT, START_CONTACTS, START_OVERLAPS
from carom.layouts.status import STATUS, WELL


@func
def begin_tree(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pairs: Pairs,
    world: Int32,
    tree: Int32,
    moves: Int32,
):
    """Save the state at the start of the step; see `step_ends.begin_step_kernel`."""
    if tree == 0:
        pairs.count_pairs[world, START_CONTACTS] = NONE_KEPT
        pairs.count_pairs[world, START_OVERLAPS] = NONE_KEPT
        keep_start_impulses(settings, state, scratch, world)
    keep_start(model, state, scratch, world, tree)
    if moves != 0:
        joint_damping(model, state, world, tree)


@kernel
def begin_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, pairs: Pairs, moves: Int32
):
    """Begin the step of each tree; the thread of a world's first tree begins the step of the world.

    `moves` is 0 if only contacts are to be found. Worlds that `parallel.runs.ask_kernel` left out, and worlds
    with an error in an earlier step, are skipped.
    """
    tree, world = wp.tid()
    if not is_called_off(state, world):
        begin_tree(settings, model, state, scratch, pairs, world, tree, moves)


@kernel
def tree_poses_kernel(settings: Settings, model: Model, state: State, scratch: Scratch):
    """Update the link poses of each tree from its coordinates."""
    tree, world = wp.tid()
    if not is_called_off(state, world):
        update_link_poses(settings, model, state, scratch, world, tree)


@kernel
def world_islands_kernel(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    work: IslandWork,
):
    """Group the trees of each world into islands, and give each island its part of the workspace."""
    world = wp.tid()
    if is_called_off(state, world):
        return
    build_islands(settings, model, state, shapes, contacts, users, pair_rows, world)
    lay_out_islands(settings, model, state, shapes, contacts, users, pair_rows, work, world)


@kernel
def tree_free_motion_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, pair_rows: PairRows, work: IslandWork
):
    """Compute the velocities that each tree would have after a substep without constraints."""
    tree, world = wp.tid()
    if is_called_off(state, world):
        return
    work.tree_free_fault[world, tree] = 0
    pushed = may_be_pushed(model, pair_rows, world, tree)
    own_state = state_of_tree(state, work.tree_free_fault, tree)
    free_motion(model, settings, own_state, scratch, world, tree, pushed)


@kernel
def tree_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    work: IslandWork,
):
    """Compute the new velocities and positions of each tree."""
    tree, world = wp.tid()
    if is_called_off(state, world):
        return
    work.tree_motion_fault[world, tree] = 0
    own_state = state_of_tree(state, work.tree_motion_fault, tree)
    gather_link_forces(settings, model, own_state, scratch, shapes, contacts, users, world, tree)
    move_or_stop(settings, model, own_state, scratch, world, tree)


@func
def note_first_fault(settings: Settings, state: State, faults: IntRows, world: Int32):
    """Set the status of a world without errors to the fault of its first faulty tree."""
    for tree in range(settings.tree_count):
        if state.status_entry[world, STATUS] == WELL:
            state.status_entry[world, STATUS] = faults[world, tree]


@kernel
def faults_kernel(settings: Settings, state: State, work: IslandWork):
    """After a substep: find the worlds that have to return to the start of the step, with the faulty tree."""
    world = wp.tid()
    note_first_fault(settings, state, work.tree_free_fault, world)
    note_first_fault(settings, state, work.tree_motion_fault, world)


@kernel
def end_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, moves: Int32):
    """End the step of each tree, or return to its start; `moves` is as in `begin_kernel`."""
    tree, world = wp.tid()
    if went_wrong(state, world):
        if tree == 0:
            return_to_start_impulses(settings, state, scratch, world)
        abandon_tree(model, state, scratch, world, tree)
    elif moves != 0 and not is_called_off(state, world):
        end_tree(settings, model, state, scratch, world, tree)
