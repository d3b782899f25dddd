"""The stages of a substep of worlds whose bodies touch or are tied together, a kernel for each."""

import warp as wp

from carom.kernels.dynamics.step import free_motion, move_or_stop
from carom.kernels.solver.islands import build_islands, may_be_pushed
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.solver.solver import solve_island
from carom.kernels.structs import (
    Contacts,
    Model,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, kernel


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
    """Group trees into islands."""
    world = first_world + wp.tid()
    build_islands(settings, model, state, shapes, contacts, users, pair_rows, world)


@kernel
def free_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    first_world: Int32,
):
    """Velocities after a substep if there were no constraints."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
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
    first_world: Int32,
):
    """Changes of velocity that motors, limits, user constraints and contacts ask for."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            solve_island(model, settings, state, scratch, shapes, contacts, users, pair_rows, world, tree)


@kernel
def integration_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    first_world: Int32,
):
    """New velocities and positions."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
        move_or_stop(settings, model, state, scratch, world, tree)
