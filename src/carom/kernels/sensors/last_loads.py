"""The loads of joints in the last step, found when they are read; see `kernels.dynamics.loads`."""

import warp as wp

from carom.kernels.dynamics.dynamics import generalized_forces, link_bias_forces, link_inertias
from carom.kernels.dynamics.fluid import add_fluid_forces, has_fluid
from carom.kernels.dynamics.joint_terms import add_joint_terms
from carom.kernels.dynamics.kinematics import forward_kinematics, motion_subspaces
from carom.kernels.dynamics.loads import measure_loads
from carom.kernels.dynamics.mass_matrix import composite_inertia, factorise
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Vector3, Vector4, func, kernel
from carom.layouts.codes import LAST_STEP


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
    then.link_wrench = state.link_applied
    forward_kinematics(model, then, scratch.link_pose, world, tree)
    motion_subspaces(model, scratch.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)
    link_bias_forces(model, then, scratch, world, tree, LAST_STEP)
    if has_fluid(model, world):
        add_fluid_forces(model, scratch, world, tree)
    generalized_forces(model, then, scratch, world, tree, LAST_STEP)
    composite_inertia(model, scratch, world, tree)
    if model.tree_joint_terms[world, tree] != 0.0:
        add_joint_terms(model, duration, then, scratch, world, tree)
    factorise(model, scratch, world, tree)
    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        scratch.dof[world, dof].free_acceleration = state.dof_acceleration[world, dof]
        scratch.dof[world, dof].coupling = state.dof_coupling[world, dof]
    scratch.tree[world, tree].is_pushed = state.tree_is_pushed[world, tree]
    if state.tree_is_pushed[world, tree] != 0:
        base = model.tree[tree].first_link
        for link in range(base, base + model.tree[tree].link_count):
            push = state.link_push[world, link]
            scratch.link[world, link].constraint_force = Vector3(push[0], push[1], push[2])
            scratch.link[world, link].constraint_torque = Vector3(push[3], push[4], push[5])
            scratch.link[world, link].slide_torque = Vector3(0.0, 0.0, 0.0)
    measure_loads(model, duration, state, scratch, world, tree)
    state.tree_load_step[world, tree] = Vector4(0.0, 0.0, 0.0, 0.0)


@kernel
def settle_loads_kernel(model: Model, state: State, scratch: Scratch, tree: Int32, first_world: Int32):
    """Store the loads of a tree in each world."""
    settle_loads(model, state, scratch, first_world + wp.tid(), tree)
