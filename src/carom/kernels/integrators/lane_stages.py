"""Stages of worlds that take their steps several at once, after `lane_motion_kernel`; see `solver.stages`."""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega, update_link_poses
from carom.kernels.dynamics.lane_motion import has_several_links
from carom.kernels.dynamics.step import continue_free_motion, is_continued, take_poses
from carom.kernels.integrators.frames import (
    arm_of_base,
    carried_by_turning,
    is_off_frame,
    leave_out_carried,
)
from carom.kernels.integrators.midpoint import midpoint_motion
from carom.kernels.integrators.stages import explicit_motion
from carom.kernels.solver.activity import has_woken, is_absent, is_left_out
from carom.kernels.solver.islands import may_be_pushed
from carom.kernels.structs import Model, PairRows, Scratch, Settings, StageWork, State
from carom.kernels.types import Int32, Vector3, func, kernel


@func
def update_poses(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """As `update_link_poses`, for a tree whose poses are known."""
    if is_absent(state, world, tree):
        return
    if settings.looks_ahead != 0:
        base = model.tree[tree].first_link
        for link in range(base, base + model.tree[tree].link_count):
            scratch.link_pose[world, link] = state.link_pose[world, link]
    take_poses(model, state, scratch, world, tree)


@kernel
def lane_poses_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, first_world: Int32):
    """As `link_poses_kernel`."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if has_several_links(model, tree):
            update_poses(settings, model, state, scratch, world, tree)
        else:
            update_link_poses(settings, model, state, scratch, world, tree)


@func
def continue_by_frame(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    by_frame: Int32,
):
    """As `continue_free_motion`, of a tree that moves by its frame if `by_frame` is 1."""
    if is_left_out(state, world, tree):
        return
    carried = Vector3(0.0, 0.0, 0.0)
    is_carried = by_frame != 0 and is_off_frame(model, tree)
    if is_carried:
        carried = carried_by_turning(
            base_omega(model, state, world, tree), arm_of_base(model, state, world, tree)
        )
    continue_free_motion(model, settings, state, scratch, world, tree)
    if is_carried and not has_woken(state, world, tree):
        leave_out_carried(model, state, scratch, world, tree, carried, settings.time_step)


@kernel
def continued_explicit_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    first_world: Int32,
    by_frame: Int32,
):
    """As `explicit_motion_kernel`; the time step of `lane_motion_kernel` was 0."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if is_continued(model, tree):
            continue_by_frame(model, settings, state, scratch, world, tree, by_frame)
        else:
            explicit_motion(
                model, settings, state, scratch, world, tree, may_be_pushed(model, pair_rows, world, tree),
                by_frame,
            )  # fmt: skip


@kernel
def continued_midpoint_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    stage_work: StageWork,
    first_world: Int32,
):
    """As `midpoint_motion_kernel`."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if is_continued(model, tree):
            continue_free_motion(model, settings, state, scratch, world, tree)
        else:
            midpoint_motion(
                model, settings, state, scratch, stage_work, world, tree,
                may_be_pushed(model, pair_rows, world, tree),
            )  # fmt: skip
