"""Beginning, ending and abandoning a step."""

import warp as wp

from carom.kernels.contact.manifold import restore_contacts
from carom.kernels.dynamics.loads import keep_loads
from carom.kernels.dynamics.motors import joint_damping
from carom.kernels.dynamics.quarantine import (
    keep_start,
    keep_start_impulses,
    return_to_start,
    return_to_start_impulses,
)
from carom.kernels.maths.runs import clear_run, copy_run
from carom.kernels.sensors.last_loads import settle_loads
from carom.kernels.solver.activity import is_absent, is_left_out
from carom.kernels.structs import Contacts, Model, Pairs, Scratch, Settings, State
from carom.kernels.types import Int32, Vector4, Vector6, func, kernel
from carom.layouts.contacts import NONE_KEPT, START_CONTACTS, START_OVERLAPS
from carom.layouts.status import CONTACTS_WANTED, PAIRS_WANTED, STATUS, WELL


@func
def clear_forces(model: Model, state: State, world: Int32, tree: Int32):
    """Clear the forces and torques applied to a tree; they act for one step."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        state.link_wrench[world, link] = Vector6()
    clear_run(state.dof_torque, model.tree[tree].first_dof, world, model.tree[tree].dof_count)


@func
def begin_world(state: State, pairs: Pairs, world: Int32):
    """Reset the status of a world at the start of a step, and mark its contacts as not saved."""
    state.status_entry[world, STATUS] = WELL
    state.status_entry[world, PAIRS_WANTED] = 0
    state.status_entry[world, CONTACTS_WANTED] = 0
    pairs.count_pairs[world, START_CONTACTS] = NONE_KEPT
    pairs.count_pairs[world, START_OVERLAPS] = NONE_KEPT


@func
def abandon_tree(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Restore the state of a tree at the start of the step.

    Applied forces are cleared if velocities were not finite; a step that is to be repeated needs them.
    """
    return_to_start(model, state, scratch, world, tree)
    if state.status_entry[world, STATUS] > WELL:
        clear_forces(model, state, world, tree)


@func
def begin_step(
    settings: Settings, model: Model, state: State, scratch: Scratch, pairs: Pairs, world: Int32, moves: Int32
):
    """Save the state at the start of a step; add joint damping, unless `moves` is 0."""
    begin_world(state, pairs, world)
    keep_start_impulses(settings, state, scratch, world)
    for tree in range(settings.tree_count):
        if is_absent(state, world, tree):
            continue
        keep_start(model, state, scratch, world, tree)
        if moves != 0:
            joint_damping(model, state, world, tree)


@func
def keep_motion(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Keep the motion of a tree before and after the step that ends, and what else its accelerations need."""
    first = model.tree[tree].first_position
    count = model.tree[tree].position_count
    copy_run(state.position_after, state.position, first, world, count)
    first_dof = model.tree[tree].first_velocity
    last_dof = model.tree[tree].first_dof + model.tree[tree].dof_count
    copy_run(state.dof_velocity_after, state.dof_velocity, first_dof, world, last_dof - first_dof)
    # An absent tree has no start in the workspace: it does not move.
    if is_absent(state, world, tree):
        copy_run(state.position_before, state.position, first, world, count)
        copy_run(state.dof_velocity_before, state.dof_velocity, first_dof, world, last_dof - first_dof)
    else:
        copy_run(state.position_before, scratch.position_start, first, world, count)
        for dof in range(first_dof, last_dof):
            state.dof_velocity_before[world, dof] = scratch.dof[world, dof].start_velocity
    gravity = model.gravity_vector[world, 0]
    state.tree_last_step[world, tree] = Vector4(gravity[0], gravity[1], gravity[2], settings.duration)


@func
def end_tree(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """End the step of a tree: keep what its sensors need, and clear the applied forces."""
    if model.tree[tree].sensor_count > 0:
        if is_left_out(state, world, tree):
            # The motion from which loads of an earlier step would be found is overwritten.
            settle_loads(model, state, scratch, world, tree)
        elif model.tree[tree].sensed_count == 0:
            keep_loads(model, settings, state, scratch, world, tree)
        else:
            # With Bullet's force-torque sensors loads have been measured in each substep.
            state.tree_load_step[world, tree] = Vector4(0.0, 0.0, 0.0, 0.0)
    if model.tree[tree].is_followed != 0:
        keep_motion(settings, model, state, scratch, world, tree)
    clear_forces(model, state, world, tree)


@func
def end_step(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32):
    """End the step of all trees."""
    for tree in range(settings.tree_count):
        end_tree(settings, model, state, scratch, world, tree)


@kernel
def begin_step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pairs: Pairs,
    moves: Int32,
    first_world: Int32,
):
    """Begin a step; `moves` is 0 if only contacts are to be detected."""
    begin_step(settings, model, state, scratch, pairs, first_world + wp.tid(), moves)


@kernel
def end_step_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, first_world: Int32):
    """End a step."""
    end_step(settings, model, state, scratch, first_world + wp.tid())


@kernel
def abandon_step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    pairs: Pairs,
    first_world: Int32,
):
    """Restore the state at the start of a step that failed."""
    world = first_world + wp.tid()
    restore_contacts(contacts, pairs, world)
    return_to_start_impulses(settings, state, scratch, world)
    for tree in range(settings.tree_count):
        if is_absent(state, world, tree):
            continue
        abandon_tree(model, state, scratch, world, tree)
