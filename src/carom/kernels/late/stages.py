"""Kernels of a step, in place of others and beside them, where a tree has late velocities of links.

Worlds without such trees never launch them, so they cost these nothing.
"""

import warp as wp

from carom.kernels.late.trees import any_free_motion, move_or_stop_any
from carom.kernels.late.velocities import keep_late_start, return_to_late_start
from carom.kernels.solver.activity import is_absent
from carom.kernels.solver.islands import may_be_pushed
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.structs import Contacts, Model, PairRows, Scratch, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, kernel


@kernel
def begin_late_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, first_world: Int32):
    """Save the late velocities at the start of a step."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if not is_absent(state, world, tree):
            keep_late_start(model, state, scratch, world, tree)


@kernel
def abandon_late_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, first_world: Int32):
    """Restore the late velocities at the start of a step that failed."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if not is_absent(state, world, tree):
            return_to_late_start(model, state, scratch, world, tree)


@kernel
def late_free_motion_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, pair_rows: PairRows, first_world: Int32
):
    """As `free_motion_kernel`."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        any_free_motion(
            model, settings, state, scratch, world, tree, may_be_pushed(model, pair_rows, world, tree)
        )


@kernel
def late_integration_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    first_world: Int32,
):
    """As `integration_kernel`."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
        move_or_stop_any(settings, model, state, scratch, world, tree)
