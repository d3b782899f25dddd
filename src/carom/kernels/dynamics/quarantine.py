"""Saving the state at the start of a step, and restoring it if the step fails.

A step fails if a velocity becomes NaN or infinite, or if contacts or rows do not fit into their arrays. The
state of the world is then restored, and `State.status_entry` has the reason. In the second case the step is
repeated with longer arrays.
"""

import warp as wp

from carom.kernels.maths.runs import copy_run
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, func, real
from carom.layouts.status import STATUS, WELL


@func
def keep_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Save what a step may change of a tree: coordinates, poses, joint torques, sensors and sleep state."""
    copy_run(
        scratch.position_start,
        state.position,
        model.tree[tree].first_position,
        world,
        model.tree[tree].position_count,
    )
    # The velocities of a base come before the dofs of a fixed tree.
    dof = model.tree[tree].first_velocity + 0
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        scratch.dof[world, dof].start_velocity = state.dof_velocity[world, dof]
        scratch.dof[world, dof].start_torque = state.dof_torque[world, dof]
        scratch.dof[world, dof].start_motor_impulse = state.dof_motor_impulse[world, dof]
        scratch.dof[world, dof].start_joint_impulse = state.dof_joint_impulse[world, dof]
        scratch.dof[world, dof].start_limit_impulse = state.dof_limit_impulse[world, dof]
        dof += 1
    first = model.tree[tree].first_actuator
    for actuator in range(first, first + model.tree[tree].actuator_count):
        scratch.actuator_start[world, actuator] = state.actuator_activation[world, actuator]
        scratch.actuator_force_start[world, actuator] = state.actuator_force[world, actuator]
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        scratch.link_pose_start[world, link] = state.link_pose[world, link]
        if model.tree[tree].sensed_count > 0 and model.link[link].sensor != 0:
            scratch.link_reaction_start[world, link] = state.link_reaction[world, link]
            scratch.link_load_start[world, link] = state.link_load[world, link]
    scratch.tree[world, tree].start_island = state.tree_island[world, tree]
    scratch.tree[world, tree].start_iterations = state.tree_iterations[world, tree]
    scratch.tree[world, tree].start_residual = state.tree_residual[world, tree]
    scratch.tree[world, tree].start_activity = state.tree_activity[world, tree]
    scratch.tree[world, tree].start_wants_sleep = state.tree_wants_sleep[world, tree]
    scratch.tree[world, tree].start_idle_time = state.tree_idle_time[world, tree]


@func
def return_to_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Restore the state of a tree at the start of the step."""
    copy_run(
        state.position,
        scratch.position_start,
        model.tree[tree].first_position,
        world,
        model.tree[tree].position_count,
    )
    dof = model.tree[tree].first_velocity + 0
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        state.dof_velocity[world, dof] = scratch.dof[world, dof].start_velocity
        state.dof_torque[world, dof] = scratch.dof[world, dof].start_torque
        state.dof_motor_impulse[world, dof] = scratch.dof[world, dof].start_motor_impulse
        state.dof_joint_impulse[world, dof] = scratch.dof[world, dof].start_joint_impulse
        state.dof_limit_impulse[world, dof] = scratch.dof[world, dof].start_limit_impulse
        dof += 1
    first = model.tree[tree].first_actuator
    for actuator in range(first, first + model.tree[tree].actuator_count):
        state.actuator_activation[world, actuator] = scratch.actuator_start[world, actuator]
        state.actuator_force[world, actuator] = scratch.actuator_force_start[world, actuator]
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        state.link_pose[world, link] = scratch.link_pose_start[world, link]
        if model.tree[tree].sensed_count > 0 and model.link[link].sensor != 0:
            state.link_reaction[world, link] = scratch.link_reaction_start[world, link]
            state.link_load[world, link] = scratch.link_load_start[world, link]
    state.tree_island[world, tree] = scratch.tree[world, tree].start_island
    state.tree_iterations[world, tree] = scratch.tree[world, tree].start_iterations
    state.tree_residual[world, tree] = scratch.tree[world, tree].start_residual
    state.tree_activity[world, tree] = scratch.tree[world, tree].start_activity
    state.tree_wants_sleep[world, tree] = scratch.tree[world, tree].start_wants_sleep
    state.tree_idle_time[world, tree] = scratch.tree[world, tree].start_idle_time


@func
def keep_start_impulses(settings: Settings, state: State, scratch: Scratch, world: Int32):
    """Save the impulses of all user constraints at the start of the step."""
    for user in range(settings.user_count):
        scratch.user_impulse_start[world, user] = state.user_impulse[world, user]


@func
def return_to_start_impulses(settings: Settings, state: State, scratch: Scratch, world: Int32):
    """Restore the impulses of all user constraints at the start of the step."""
    for user in range(settings.user_count):
        state.user_impulse[world, user] = scratch.user_impulse_start[world, user]


@func
def report_fault(state: State, world: Int32, tree: Int32, sum_of_velocities: real):
    """Record a tree in the status if the sum of its velocities is not finite; the first fault stays."""
    if not wp.isfinite(sum_of_velocities) and state.status_entry[world, STATUS] == WELL:
        state.status_entry[world, STATUS] = tree + 1
