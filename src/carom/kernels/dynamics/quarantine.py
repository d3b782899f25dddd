"""Saving the state at the start of a step, and restoring it if the step fails.

A step fails if a velocity becomes NaN or infinite, or if contacts or rows do not fit into their arrays. The
state of the world is then restored, and `State.status_entry` has the reason. In the second case the step is
repeated with longer arrays.
"""

import warp as wp

from carom.kernels.maths.runs import copy_run
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, func, real
from carom.layouts.status import STATUS, WELL


@func
def keep_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Save the coordinates, joint torques and sleep state of a tree at the start of the step."""
    copy_run(
        scratch.position_start,
        state.position,
        model.tree[tree].first_position,
        world,
        model.tree[tree].position_count,
    )
    dof = model.tree[tree].first_dof
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        scratch.dof[world, dof].start_velocity = state.dof_velocity[world, dof]
        scratch.dof[world, dof].start_torque = state.dof_torque[world, dof]
        dof += 1
    scratch.tree[world, tree].start_activity = state.tree_activity[world, tree]
    scratch.tree[world, tree].start_wants_sleep = state.tree_wants_sleep[world, tree]
    scratch.tree[world, tree].start_idle_time = state.tree_idle_time[world, tree]


@func
def return_to_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Restore the state of a tree at the start of the step."""
    copy_run(
        state.position,
        scratch.position_start,
        model.tree[tree].first_position,
        world,
        model.tree[tree].position_count,
    )
    dof = model.tree[tree].first_dof
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        state.dof_velocity[world, dof] = scratch.dof[world, dof].start_velocity
        state.dof_torque[world, dof] = scratch.dof[world, dof].start_torque
        dof += 1
    state.tree_activity[world, tree] = scratch.tree[world, tree].start_activity
    state.tree_wants_sleep[world, tree] = scratch.tree[world, tree].start_wants_sleep
    state.tree_idle_time[world, tree] = scratch.tree[world, tree].start_idle_time


@func
def report_fault(state: State, world: Int32, tree: Int32, sum_of_velocities: real):
    """Record a tree in the status if the sum of its velocities is not finite; the first fault stays."""
    if not wp.isfinite(sum_of_velocities) and state.status_entry[world, STATUS] == WELL:
        state.status_entry[world, STATUS] = tree + 1
