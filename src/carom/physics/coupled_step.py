"""One substep of worlds whose bodies touch or are tied together."""

import warp as wp

from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Int32, func, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.islands import build_islands, may_be_pushed
from carom.physics.solver import solve_island
from carom.physics.step import constrained_motion, free_motion


@func
def solve_islands(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    world: Int32,
):
    """Solve one island after the other."""
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            solve_island(model, settings, state, scratch, shapes, contacts, users, couplings, world, tree)


@kernel
def coupled_step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    first_world: Int32,
):
    """Advance each world by one substep, its contacts being those of the present coordinates."""
    world = first_world + wp.tid()
    build_islands(settings, model, state, shapes, contacts, users, couplings, world)
    for tree in range(settings.tree_count):
        free_motion(
            model, settings, state, scratch, world, tree, may_be_pushed(model, couplings, world, tree)
        )
    solve_islands(model, settings, state, scratch, shapes, contacts, users, couplings, world)
    constrained_motion(settings, model, state, scratch, world)
