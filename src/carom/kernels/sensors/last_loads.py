"""The loads of joints in the last step, found when they are read; see `kernels.dynamics.loads`."""

import warp as wp

from carom.kernels.dynamics.dynamics import link_bias_forces, link_inertias
from carom.kernels.dynamics.kinematics import forward_kinematics, motion_subspaces
from carom.kernels.dynamics.loads import inertial_forces, store_load
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Vector4, func, kernel
from carom.layouts.codes import LAST_STEP, LOADED


@func
def settle_loads(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Store the loads of a tree in `State.link_load` if the last step has not."""
    duration = state.tree_load_step[world, tree][3]
    if duration <= 0.0:
        return
    then = State()
    then = state
    then.position = state.position_before
    then.dof_velocity = state.dof_velocity_before
    forward_kinematics(model, then, scratch.link_pose, world, tree)
    motion_subspaces(model, scratch.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)
    link_bias_forces(model, then, scratch, world, tree, LAST_STEP)
    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        scratch.dof[world, dof].force = state.dof_acceleration[world, dof]
        scratch.dof[world, dof].coupling = state.dof_coupling[world, dof]
    inertial_forces(model, scratch, world, tree)
    base = model.tree[tree].first_link
    count = model.tree[tree].link_count
    for i in range(count - 1):
        link = base + count - 1 - i
        force = scratch.link[world, link].inertial_force + scratch.link[world, link].force
        moment = scratch.link[world, link].inertial_moment + scratch.link[world, link].moment
        parent = model.link[link].parent
        scratch.link[world, parent].inertial_force += force
        scratch.link[world, parent].inertial_moment += moment
        if (model.link[link].sensor & LOADED) != 0:
            store_load(model, state, scratch, 1.0 / duration, world, link, force, moment)
    state.tree_load_step[world, tree] = Vector4(0.0, 0.0, 0.0, 0.0)


@kernel
def settle_loads_kernel(model: Model, state: State, scratch: Scratch, tree: Int32, first_world: Int32):
    """Store the loads of a tree in each world."""
    settle_loads(model, state, scratch, first_world + wp.tid(), tree)
