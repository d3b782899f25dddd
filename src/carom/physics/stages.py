"""The stages of a step as kernels of their own, so that each can be timed.

One after the other they do what `coupled_step_kernel` does in one launch.
"""

import warp as wp

from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Int32, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.coupled_step import solve_islands
from carom.physics.islands import build_islands, may_be_pushed
from carom.physics.step import begin_step, constrained_motion, end_step, free_motion


@kernel
def islands_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    begins: Int32,
):
    """Begin a step, if `begins` is not 0, and group trees into islands."""
    world = wp.tid()
    if begins != 0:
        begin_step(settings, model, state, scratch, world)
    build_islands(settings, model, state, shapes, contacts, users, couplings, world)


@kernel
def free_motion_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, couplings: Couplings
):
    """Velocities after a substep if there were no constraints."""
    world = wp.tid()
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
):
    """Changes of velocity that motors, limits, user constraints and contacts ask for."""
    solve_islands(model, settings, state, scratch, shapes, contacts, users, couplings, wp.tid())


@kernel
def motion_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, ends: Int32):
    """New velocities and positions; the end of a step if `ends` is not 0."""
    world = wp.tid()
    constrained_motion(settings, model, state, scratch, world)
    end_step(settings, model, state, scratch, world, ends)
