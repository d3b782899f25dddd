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
    q = model.tree_first_position[tree]
    while q < model.tree_first_position[tree] + model.tree_position_count[tree]:
        scratch.position_start[world, q] = state.position[world, q]
        q += 1
    dof = model.tree_first_dof[tree]
    while dof < model.tree_first_dof[tree] + model.tree_dof_count[tree]:
        scratch.dof_start_velocity[world, dof] = state.dof_velocity[world, dof]
        scratch.dof_start_torque[world, dof] = state.dof_torque[world, dof]
        dof += 1


@func
def return_to_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Put a tree back to where the step started."""
    q = model.tree_first_position[tree]
    while q < model.tree_first_position[tree] + model.tree_position_count[tree]:
        state.position[world, q] = scratch.position_start[world, q]
        q += 1
    dof = model.tree_first_dof[tree]
    while dof < model.tree_first_dof[tree] + model.tree_dof_count[tree]:
        state.dof_velocity[world, dof] = scratch.dof_start_velocity[world, dof]
        state.dof_torque[world, dof] = scratch.dof_start_torque[world, dof]
        dof += 1


@func
def report_fault(state: State, world: Int32, tree: Int32, sum_of_velocities: real):
    """Note the first tree whose velocities are not finite."""
    if not wp.isfinite(sum_of_velocities) and state.fault_tree[world, 0] == 0:
        state.fault_tree[world, 0] = tree + 1
