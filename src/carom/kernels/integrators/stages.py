"""Stages that all these integrators have: what is kept of the start of a substep, and explicit free motion.

Forces are those of the positions and velocities at the start of a stage, and the mass matrix of trees and of
all rows is M with armature. So a stage with its rows gives accelerations a, as velocities v + h a.
"""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega
from carom.kernels.dynamics.lane_motion import accelerate_tree
from carom.kernels.dynamics.motors import explicit_pd
from carom.kernels.dynamics.single_body import is_single_body, move_single_body
from carom.kernels.dynamics.step import take_accelerations
from carom.kernels.integrators.frames import (
    arm_of_base,
    carried_by_turning,
    is_off_frame,
    leave_out_carried,
)
from carom.kernels.joints.coordinates import load_quaternion, three_numbers
from carom.kernels.maths.runs import copy_run
from carom.kernels.maths.shares import TREES_PER_SHARE, next_share
from carom.kernels.solver.activity import has_woken, is_left_out, stop
from carom.kernels.solver.islands import may_be_pushed
from carom.kernels.solver.joint_solver import clear_delta_velocities
from carom.kernels.structs import Model, PairRows, Scratch, Settings, StageWork, State
from carom.kernels.types import Int32, IntRows, Vector3, func, kernel, real


@func
def end_of_dofs(model: Model, tree: Int32) -> Int32:
    """The row after the last velocity of a tree; those of its base come first, also if that is fixed."""
    return model.tree[tree].first_dof + model.tree[tree].dof_count


@func
def base_turn(model: Model, state: State, world: Int32, tree: Int32):
    """Orientation of the base of a tree, by its coordinates."""
    return wp.normalize(load_quaternion(state, world, model.tree[tree].first_position + 3))


@func
def write_base_omega(model: Model, state: State, world: Int32, tree: Int32, omega: Vector3):
    """Set the angular velocity of a base, in whatever axes."""
    first = model.tree[tree].first_velocity
    for axis in range(3):
        state.dof_velocity[world, first + axis] = omega[axis]


@func
def to_own_axes(model: Model, state: State, world: Int32, tree: Int32):
    """Turn the angular velocity of a base from the axes of the world into those of its link."""
    omega = three_numbers(state.dof_velocity, world, model.tree[tree].first_velocity)
    turned = wp.quat_rotate_inv(base_turn(model, state, world, tree), omega)
    write_base_omega(model, state, world, tree, turned)


@func
def to_world_axes(model: Model, state: State, world: Int32, tree: Int32):
    """The inverse of `to_own_axes`."""
    omega = three_numbers(state.dof_velocity, world, model.tree[tree].first_velocity)
    turned = wp.quat_rotate(base_turn(model, state, world, tree), omega)
    write_base_omega(model, state, world, tree, turned)


@kernel
def begin_stages_kernel(
    settings: Settings, model: Model, state: State, stage_work: StageWork, first_world: Int32
):
    """Keep the state at the start of a substep."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        first = model.tree[tree].first_position
        copy_run(stage_work.position_first, state.position, first, world, model.tree[tree].position_count)
        base = model.tree[tree].first_velocity
        turn = base_turn(model, state, world, tree)
        omega = wp.quat_rotate_inv(turn, three_numbers(state.dof_velocity, world, base))
        for dof in range(base, end_of_dofs(model, tree)):
            velocity = state.dof_velocity[world, dof] + 0.0
            if dof < base + 3:
                velocity = omega[dof - base]
            stage_work.dof_first[world, dof] = velocity
            stage_work.dof_stage[world, dof] = velocity
            stage_work.dof_rate[world, dof] = real(0.0)
            stage_work.dof_change[world, dof] = real(0.0)
            stage_work.dof_applied[world, dof] = state.dof_torque[world, dof]
        first = model.tree[tree].first_actuator
        for actuator in range(first, first + model.tree[tree].actuator_count):
            stage_work.actuator_first[world, actuator] = state.actuator_activation[world, actuator]
            stage_work.actuator_rate[world, actuator] = real(0.0)


@func
def explicit_motion(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    pushed: bool,
    by_frame: Int32,
):
    """As `step.free_motion`, with explicit damping and springs of joints.

    `by_frame` is 1 if bases move by the origins of their frames, see `frames`.
    """
    if is_left_out(state, world, tree):
        return
    carried = Vector3(0.0, 0.0, 0.0)
    is_carried = by_frame != 0 and is_off_frame(model, tree)
    if is_carried:
        carried = carried_by_turning(
            base_omega(model, state, world, tree), arm_of_base(model, state, world, tree)
        )
    if is_single_body(model, tree):
        move_single_body(model, settings, state, scratch, world, tree, pushed)
    else:
        explicit_pd(model, state, world, tree)
        # What is implicit of joints vanishes with the duration of the substep.
        accelerate_tree(model, real(0.0), state, scratch, world, tree)
        take_accelerations(model, settings, state, scratch, world, tree, pushed)
    if is_carried:
        leave_out_carried(model, state, scratch, world, tree, carried, settings.time_step)
    if has_woken(state, world, tree):
        stop(model, state, world, tree)
    clear_delta_velocities(model, scratch, world, tree)


@kernel
def explicit_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    taken: IntRows,
    first_world: Int32,
    by_frame: Int32,
):
    """Update velocities for a substep without constraints, by explicit forces."""
    world = first_world + wp.tid()
    share = next_share(taken, Int32(-1))
    while TREES_PER_SHARE * share < settings.tree_count:
        first = TREES_PER_SHARE * share
        for tree in range(first, wp.min(first + TREES_PER_SHARE, settings.tree_count)):
            explicit_motion(
                model, settings, state, scratch, world, tree, may_be_pushed(model, pair_rows, world, tree),
                by_frame,
            )  # fmt: skip
        share = next_share(taken, share)
