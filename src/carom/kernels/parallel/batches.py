"""A whole step of trees that cannot interact, parallel over batches of trees and worlds."""

import warp as wp

from carom.kernels.dynamics.step import free_motion, move_or_stop
from carom.kernels.parallel.trees import begin_tree
from carom.kernels.parallel.workspace import is_called_off, state_of_tree
from carom.kernels.solver.joint_solver import is_constrained, solve_joints
from carom.kernels.structs import IslandWork, Model, Pairs, Scratch, Settings, State
from carom.kernels.types import Int32, func, kernel
from carom.layouts.codes import MAX_ROWS_PER_CONSTRAINT


@func
def scratch_of_batch(model: Model, scratch: Scratch, root: Int32) -> Scratch:
    """The scratch arrays, with rows restricted to those of a batch."""
    first = MAX_ROWS_PER_CONSTRAINT * model.tree[root].first_constraint
    own = Scratch()
    own = scratch
    if model.tree[root].batch_constraints > 0:
        end = first + MAX_ROWS_PER_CONSTRAINT * model.tree[root].batch_constraints
        own.row = scratch.row[:, first:end]
        own.row_share = scratch.row_share[:, first:end]
        own.row_softness = scratch.row_softness[:, first:end]
    return own


@kernel
def batch_step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pairs: Pairs,
    work: IslandWork,
    substeps: Int32,
):
    """Begin a step of each batch of trees, and perform its substeps; see `step.step_kernel`."""
    root, world = wp.tid()
    work.tree_free_fault[world, root] = 0
    work.tree_motion_fault[world, root] = 0
    if is_called_off(state, world) or model.tree[root].batch != root:
        return
    own_state = state_of_tree(state, work.tree_free_fault, root)
    own_scratch = scratch_of_batch(model, scratch, root)
    for tree in range(root, settings.tree_count):
        if model.tree[tree].batch == root:
            begin_tree(settings, model, state, scratch, pairs, world, tree, 1)
    for _substep in range(substeps):
        for tree in range(root, settings.tree_count):
            if model.tree[tree].batch == root:
                pushed = is_constrained(model, own_state, world, root)
                free_motion(model, settings, own_state, scratch, world, tree, pushed)
        for tree in range(root, settings.tree_count):
            if model.tree[tree].batch == root:
                solve_joints(model, settings, own_state, own_scratch, world, tree)
        for tree in range(root, settings.tree_count):
            if model.tree[tree].batch == root:
                move_or_stop(settings, model, own_state, scratch, world, tree)
