"""The stages of a step as kernels of their own, so that each can be timed.

One after the other they do what `coupled_step_kernel` does in one launch.
"""

import warp as wp

from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Int32, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.coupled_step import solve_islands
from carom.physics.islands import build_islands, may_be_pushed
from carom.physics.step import constrained_motion, free_motion


@kernel
def islands_kernel(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    first_world: Int32,
):
    """Group trees into islands."""
    world = first_world + wp.tid()
    build_islands(settings, model, state, shapes, contacts, users, couplings, world)


@kernel
def free_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    couplings: Couplings,
    first_world: Int32,
):
    """Velocities after a substep if there were no constraints."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        free_motion(
            model, settings, state, scratch, world, tree, may_be_pushed(model, couplings, world, tree)
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
    couplings: Couplings,
    first_world: Int32,
):
    """Changes of velocity that motors, limits, user constraints and contacts ask for."""
    world = first_world + wp.tid()
    solve_islands(model, settings, state, scratch, shapes, contacts, users, couplings, world)


@kernel
def motion_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, first_world: Int32):
    """New velocities and positions."""
    constrained_motion(settings, model, state, scratch, first_world + wp.tid())
