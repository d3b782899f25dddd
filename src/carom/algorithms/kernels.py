"""Kernels behind the algorithms; they run the stages of the step on coordinates of their own."""

import warp as wp

from carom.model.codes import INVERSE_DYNAMICS
from carom.model.real import Int32, Vector3, kernel
from carom.model.structs import Model, Query, Scratch, Settings, State
from carom.physics.dynamics import generalized_forces, link_bias_forces, link_inertias
from carom.physics.kinematics import forward_kinematics, motion_subspaces
from carom.physics.mass_matrix import composite_inertia


@kernel
def inverse_dynamics_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, tree: Int32):
    """Leaves in `dof_force` minus the generalized forces that cause `dof_acceleration`."""
    world = wp.tid()
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)
    link_bias_forces(model, settings, state, scratch, world, tree, INVERSE_DYNAMICS)
    generalized_forces(model, state, scratch, world, tree, INVERSE_DYNAMICS)


@kernel
def mass_matrix_kernel(model: Model, state: State, scratch: Scratch, tree: Int32):
    """Leaves the joint-space inertia in `block_factor`, both triangles."""
    world = wp.tid()
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)
    composite_inertia(model, scratch, world, tree)
    count = model.tree[tree].dof_count
    columns = 4 * ((count + 3) // 4)
    matrix = 4 * model.tree[tree].first_block
    for row in range(count):
        for column in range(row):
            entry = scratch.entry_factor[world, matrix + row * columns + column]
            scratch.entry_factor[world, matrix + column * columns + row] = entry


@kernel
def jacobian_kernel(model: Model, state: State, scratch: Scratch, query: Query, tree: Int32, link: Int32):
    """Fill `dof_linear` and `dof_angular` of the query with a point's Jacobian, column by column."""
    world = wp.tid()
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)
    from_com = query.point_on_link[world, 0] - model.link[link].com_from_pivot
    point = scratch.link[world, link].offset + scratch.link[world, link].rotation * from_com

    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        query.dof_linear[world, dof] = Vector3(0.0, 0.0, 0.0)
        query.dof_angular[world, dof] = Vector3(0.0, 0.0, 0.0)
    moved_by = model.link[link].nearest_dof
    while moved_by >= 0:
        axis = scratch.dof[world, moved_by].angular
        query.dof_angular[world, moved_by] = axis
        query.dof_linear[world, moved_by] = scratch.dof[world, moved_by].linear + wp.cross(axis, point)
        moved_by = model.dof[moved_by].parent
