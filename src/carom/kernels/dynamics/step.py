"""Free motion of trees; and a whole step in one launch, for bodies without contacts and user constraints."""

import warp as wp

from carom.kernels.dynamics.actuators import advance_activations
from carom.kernels.dynamics.dynamics import update_velocities
from carom.kernels.dynamics.feedback import (
    FIRST,
    clear_constraint_forces,
    constraint_feedback,
    measure_joint_wrenches,
)
from carom.kernels.dynamics.integration import integrate_positions
from carom.kernels.dynamics.lane_motion import accelerate_tree, has_several_links
from carom.kernels.dynamics.mass_matrix import invert
from carom.kernels.dynamics.motors import explicit_pd
from carom.kernels.dynamics.single_body import is_single_body, move_single_body
from carom.kernels.dynamics.step_ends import begin_step, end_step
from carom.kernels.solver.activity import has_woken, is_absent, is_left_out, stop, stop_with_base
from carom.kernels.solver.joint_solver import (
    apply_delta_velocities,
    clear_delta_velocities,
    is_constrained,
    solve_joints,
)
from carom.kernels.structs import Model, Pairs, Scratch, Settings, State
from carom.kernels.types import Int32, func, kernel
from carom.layouts.status import STATUS, WELL


@func
def move_tree(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, pushed: bool
):
    """As `free_motion`, for a tree that is awake, with any number of links."""
    explicit_pd(model, state, world, tree)
    accelerate_tree(model, settings.time_step, state, scratch, world, tree)
    take_accelerations(model, settings, state, scratch, world, tree, pushed)


@func
def take_accelerations(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, pushed: bool
):
    """Update the velocities of a tree by its accelerations, and what sensors and constraints need of them."""
    if model.tree[tree].sensed_count > 0:
        measure_joint_wrenches(model, settings, state, scratch, world, tree, FIRST)
    if model.tree[tree].sensor_count > 0:
        clear_constraint_forces(model, state, scratch, world, tree)
    update_velocities(model, settings, state, scratch, world, tree)
    if pushed:
        invert(model, scratch, world, tree)


@func
def free_motion(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, pushed: bool
):
    """Update velocities for the substep without constraints; if `pushed`, also the data for constraints."""
    if is_left_out(state, world, tree):
        return
    if is_single_body(model, tree):
        move_single_body(model, settings, state, scratch, world, tree, pushed)
    else:
        move_tree(model, settings, state, scratch, world, tree, pushed)
    if has_woken(state, world, tree):
        # Gravity and forces act on a tree from the substep after its waking up.
        stop(model, state, world, tree)
    clear_delta_velocities(model, scratch, world, tree)


@func
def is_continued(model: Model, tree: Int32) -> bool:
    """Whether `lane_motion_kernel` has found all that the motion of a tree in a lane needs.

    Those with Bullet's force-torque sensors need more of its intermediate results than one world has.
    """
    return has_several_links(model, tree) and model.tree[tree].sensed_count == 0


@func
def take_poses(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Give the links of a tree the poses that `lane_motion_kernel` has found."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        state.link_pose[world, link] = scratch.link_pose_free[world, link]


@func
def continue_free_motion(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """As `free_motion`, for a tree that `is_continued` after `lane_motion_kernel`."""
    if is_left_out(state, world, tree):
        return
    explicit_pd(model, state, world, tree)
    if model.tree[tree].sensor_count > 0:
        clear_constraint_forces(model, state, scratch, world, tree)
    take_poses(model, state, scratch, world, tree)
    update_velocities(model, settings, state, scratch, world, tree)
    if has_woken(state, world, tree):
        stop(model, state, world, tree)
    clear_delta_velocities(model, scratch, world, tree)


@func
def constrained_motion(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32):
    """Add the solver's delta velocities to the velocities, and integrate positions, of all trees."""
    for tree in range(settings.tree_count):
        move_or_stop(settings, model, state, scratch, world, tree)


@func
def move_or_stop(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """As `constrained_motion`, for one tree."""
    if is_left_out(state, world, tree):
        if not is_absent(state, world, tree):
            stop_with_base(model, state, world, tree)
        return
    if model.tree[tree].sensed_count > 0:
        constraint_feedback(model, settings, state, scratch, world, tree)
    take_impulses(settings, model, state, scratch, world, tree)


@func
def take_impulses(
    settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Add the solver's delta velocities to the velocities of a tree, and integrate its positions."""
    apply_delta_velocities(model, state, scratch, world, tree)
    if model.tree[tree].actuator_count > 0:
        advance_activations(model, settings, state, world, tree)
    integrate_positions(model, state, world, tree, settings.time_step)


@kernel
def step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pairs: Pairs,
    substeps: Int32,
    first_world: Int32,
):
    """Advance each world by one step of `substeps` substeps."""
    world = first_world + wp.tid()
    begin_step(settings, model, state, scratch, pairs, world, 1)
    for _substep in range(substeps):
        if state.status_entry[world, STATUS] == WELL:
            for tree in range(settings.tree_count):
                pushed = is_constrained(model, state, world, model.tree[tree].batch)
                free_motion(model, settings, state, scratch, world, tree, pushed)
            for tree in range(settings.tree_count):
                solve_joints(model, settings, state, scratch, world, tree)
            constrained_motion(settings, model, state, scratch, world)
    if state.status_entry[world, STATUS] == WELL:
        end_step(settings, model, state, scratch, world)
