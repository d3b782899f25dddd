"""A state that is not finite never leaves the step it arose in, nor does one for which room was short.

Each step keeps what it started from. If a velocity comes out as NaN or infinite, or contacts or rows do not
fit into their arrays, the world goes back there, and its entries of `State.status_entry` tell why. In the
second case the step is done again with longer arrays.
"""

import warp as wp

from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, func, real
from carom.layouts.status import STATUS, WELL


@func
def keep_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Remember the coordinates of a tree at the start of the step, and whether it slept."""
    q = model.tree[tree].first_position
    while q < model.tree[tree].first_position + model.tree[tree].position_count:
        scratch.position_start[world, q] = state.position[world, q]
        q += 1
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
    """Put a tree back to where the step started."""
    q = model.tree[tree].first_position
    while q < model.tree[tree].first_position + model.tree[tree].position_count:
        state.position[world, q] = scratch.position_start[world, q]
        q += 1
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
    """Note the first tree whose velocities are not finite."""
    if not wp.isfinite(sum_of_velocities) and state.status_entry[world, STATUS] == WELL:
        state.status_entry[world, STATUS] = tree + 1
