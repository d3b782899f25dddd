"""A state that is not finite never leaves the step it arose in.

Each step keeps the coordinates it started from. If a velocity comes out as NaN or infinite, all
trees of that world go back to them and `State.fault_tree` tells which tree was at fault. The same
happens when contacts or rows do not fit into their arrays; then the step is done again with larger ones.
"""

import warp as wp

from carom.model.real import Int32, func, real
from carom.model.structs import Model, Scratch, State

# Value of `State.fault_tree` when contacts or rows did not fit into their arrays.
OVERFLOW = -1


@func
def keep_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Remember the coordinates of a tree at the start of the step."""
    q = model.tree[tree].first_position
    while q < model.tree[tree].first_position + model.tree[tree].position_count:
        scratch.position_start[world, q] = state.position[world, q]
        q += 1
    dof = model.tree[tree].first_dof
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        scratch.dof[world, dof].start_velocity = state.dof_velocity[world, dof]
        scratch.dof[world, dof].start_torque = state.dof_torque[world, dof]
        dof += 1


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


@func
def report_fault(state: State, world: Int32, tree: Int32, sum_of_velocities: real):
    """Note the first tree whose velocities are not finite."""
    if not wp.isfinite(sum_of_velocities) and state.fault_tree[world, 0] == 0:
        state.fault_tree[world, 0] = tree + 1
