"""Kernels of the stages of a substep, for worlds with contacts or user constraints.

Those that have an argument `taken` can be performed by several threads, see `maths.shares`.
"""

import warp as wp

from carom.kernels.dynamics.step import continue_free_motion, free_motion, is_continued, move_or_stop
from carom.kernels.maths.shares import TREES_PER_SHARE, next_share
from carom.kernels.solver.islands import build_islands, may_be_pushed
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.solver.solver import solve_island
from carom.kernels.structs import Contacts, Model, PairRows, Scratch, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, IntRows, kernel


@kernel
def islands_kernel(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    first_world: Int32,
):
    """Find the islands of each world."""
    world = first_world + wp.tid()
    build_islands(settings, model, state, shapes, contacts, users, pair_rows, world)


@kernel
def free_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    taken: IntRows,
    first_world: Int32,
):
    """Update velocities for a substep without constraints."""
    world = first_world + wp.tid()
    share = next_share(taken, Int32(-1))
    while TREES_PER_SHARE * share < settings.tree_count:
        first = TREES_PER_SHARE * share
        for tree in range(first, wp.min(first + TREES_PER_SHARE, settings.tree_count)):
            free_motion(
                model, settings, state, scratch, world, tree, may_be_pushed(model, pair_rows, world, tree)
            )
        share = next_share(taken, share)


@kernel
def continued_motion_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, pair_rows: PairRows, first_world: Int32
):
    """As `free_motion_kernel`, after `lane_motion_kernel` has accelerated the trees of more than one link."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if is_continued(model, tree):
            continue_free_motion(model, settings, state, scratch, world, tree)
        else:
            free_motion(
                model, settings, state, scratch, world, tree, may_be_pushed(model, pair_rows, world, tree)
            )


@kernel
def constraints_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    taken: IntRows,
    first_world: Int32,
):
    """Compute the delta velocities by motors, limits, user constraints and contacts.

    A share is an island.
    """
    world = first_world + wp.tid()
    island = Int32(0)
    own = next_share(taken, Int32(-1))
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            if island == own:
                solve_island(model, settings, state, scratch, shapes, contacts, users, pair_rows, world, tree)
                own = next_share(taken, own)
            island += 1


@kernel
def integration_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    taken: IntRows,
    first_world: Int32,
):
    """Add delta velocities to the velocities, and integrate positions."""
    world = first_world + wp.tid()
    share = next_share(taken, Int32(-1))
    while TREES_PER_SHARE * share < settings.tree_count:
        first = TREES_PER_SHARE * share
        for tree in range(first, wp.min(first + TREES_PER_SHARE, settings.tree_count)):
            gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
            move_or_stop(settings, model, state, scratch, world, tree)
        share = next_share(taken, share)
