"""Beginning and end of steps and substeps of soft bodies, parallel over bodies and worlds."""

import warp as wp

from carom.kernels.parallel.workspace import is_called_off, went_wrong
from carom.kernels.soft.frames import carry_nodes, follow_nodes
from carom.kernels.soft.pushes import keep_velocities
from carom.kernels.soft.stages import clear_node_forces, keep_nodes, return_nodes
from carom.kernels.structs import Model, SoftModel, SoftWork, State
from carom.kernels.types import kernel


@kernel
def soft_begin_kernel(soft: SoftModel, state: State, soft_work: SoftWork):
    """Save the nodes of each body at the start of a step."""
    body, world = wp.tid()
    if not is_called_off(state, world):
        keep_nodes(soft, state, soft_work, world, body)


@kernel
def tree_velocities_kernel(model: Model, state: State, soft_work: SoftWork):
    """Save the velocities of each tree at the start of a substep."""
    tree, world = wp.tid()
    if not is_called_off(state, world):
        keep_velocities(model, state, soft_work, world, tree)


@kernel
def soft_poses_kernel(model: Model, state: State, soft: SoftModel):
    """Put anchored nodes where single bodies have moved; update the base pose and velocity of each body."""
    body, world = wp.tid()
    if not is_called_off(state, world):
        carry_nodes(model, state, soft, world, body)
        follow_nodes(model, state, soft, world, body)


@kernel
def soft_end_kernel(soft: SoftModel, state: State, soft_work: SoftWork):
    """End the step of each body, or return its nodes to where the step began."""
    body, world = wp.tid()
    if went_wrong(state, world):
        return_nodes(soft, state, soft_work, world, body)
    elif not is_called_off(state, world):
        clear_node_forces(soft, state, world, body)
