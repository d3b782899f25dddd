"""Kernels behind the algorithms; they run the stages of the step on coordinates of their own."""

import warp as wp

from carom.model.codes import INVERSE_DYNAMICS
from carom.model.real import Int32, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.dynamics import generalized_forces, link_bias_forces, link_inertias
from carom.physics.kinematics import forward_kinematics, motion_subspaces
from carom.physics.mass_matrix import composite_inertia


@kernel
def motion_subspaces_kernel(model: Model, state: State, scratch: Scratch, tree: Int32):
    """Link poses and motion subspaces at the coordinates of `state`."""
    world = wp.tid()
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)


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
    """Leaves the lower triangle of the joint-space inertia in `block_factor`."""
    world = wp.tid()
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)
    composite_inertia(model, scratch, world, tree)
