"""Stages of a step over trees and worlds, and those over worlds alone between them."""

import warp as wp

from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Int32, IntRows, func, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.activity import is_asleep, stop
from carom.physics.islands import build_islands, may_be_pushed
from carom.physics.kinematics import forward_kinematics
from carom.physics.parallel.layout import lay_out_islands
from carom.physics.parallel.workspace import IslandWork, state_of_tree
from carom.physics.step import begin_tree, end_tree, free_motion, move_on


@kernel
def tree_poses_kernel(model: Model, state: State):
    """Bring the link poses of each tree up to date with its coordinates."""
    tree, world = wp.tid()
    forward_kinematics(model, state, state.link_pose, world, tree)


@kernel
def begin_kernel(model: Model, state: State, scratch: Scratch):
    """Keep the start of the step; see `step.begin_step`."""
    tree, world = wp.tid()
    if tree == 0:
        state.fault_tree[world, 0] = 0
    begin_tree(model, state, scratch, world, tree)


@kernel
def world_islands_kernel(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    work: IslandWork,
):
    """Group the trees of each world into islands, and give each of these its part of the workspace."""
    world = wp.tid()
    build_islands(settings, model, state, shapes, contacts, users, couplings, world)
    lay_out_islands(settings, model, state, shapes, contacts, users, couplings, work, world)


@kernel
def tree_free_motion_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, couplings: Couplings, work: IslandWork
):
    """Velocities of each tree after a substep if there were no constraints."""
    tree, world = wp.tid()
    work.tree_free_fault[world, tree] = 0
    pushed = may_be_pushed(model, couplings, world, tree)
    own_state = state_of_tree(state, work.tree_free_fault, tree)
    free_motion(model, settings, own_state, scratch, world, tree, pushed)


@func
def move_or_stop(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """New velocities and positions of a tree; see `step.constrained_motion`."""
    if is_asleep(state, world, tree):
        stop(model, state, world, tree)
        return
    move_on(settings, model, state, scratch, world, tree)


@kernel
def tree_motion_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, work: IslandWork):
    """New velocities and positions of each tree."""
    tree, world = wp.tid()
    work.tree_motion_fault[world, tree] = 0
    own_state = state_of_tree(state, work.tree_motion_fault, tree)
    move_or_stop(settings, model, own_state, scratch, world, tree)


@func
def note_first_fault(settings: Settings, state: State, faults: IntRows, world: Int32):
    """Let the world know of the first of its trees that has a fault, if it knows of none."""
    for tree in range(settings.tree_count):
        if state.fault_tree[world, 0] == 0:
            state.fault_tree[world, 0] = faults[world, tree]


@kernel
def faults_kernel(settings: Settings, state: State, work: IslandWork):
    """Whether a world has to go back to where the step began, and because of which tree."""
    world = wp.tid()
    note_first_fault(settings, state, work.tree_free_fault, world)
    note_first_fault(settings, state, work.tree_motion_fault, world)


@kernel
def end_kernel(model: Model, state: State, scratch: Scratch, ends: Int32):
    """Go back to the start if something went wrong; see `step.end_step`."""
    tree, world = wp.tid()
    end_tree(model, state, scratch, world, tree, state.fault_tree[world, 0], ends)
