"""The Runge-Kutta method of fourth order, as in MuJoCo: forces, contacts and rows are those of four stages.

Velocities are added up in own axes, see `layouts.newton`, and positions go from those at the start of
the substep to each stage by one velocity: quaternions turn by the exponential map.
"""

import warp as wp

from carom.kernels.dynamics.actuators import bounded_control
from carom.kernels.dynamics.feedback import constraint_feedback
from carom.kernels.dynamics.integration import integrate_positions
from carom.kernels.dynamics.muscles import activation_rate
from carom.kernels.integrators.frames import add_to_base, arm_of_base, carried_by_turning, is_off_frame
from carom.kernels.integrators.stages import base_turn, end_of_dofs, to_own_axes, to_world_axes
from carom.kernels.joints.coordinates import load_quaternion, three_numbers
from carom.kernels.joints.trees import has_quaternion
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.maths.rotation import rotation_vector
from carom.kernels.maths.runs import copy_run
from carom.kernels.solver.activity import is_absent, is_left_out, stop_with_base
from carom.kernels.solver.joint_solver import apply_delta_velocities
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.structs import (
    Contacts,
    Model,
    Scratch,
    Settings,
    Shapes,
    StageWork,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, Quaternion, func, kernel, real
from carom.layouts.codes import FILTER, FILTER_EXACT, INTEGRATOR, MUSCLE, UNFILTERED

_LAST = Int32(3)


@func
def weight_of(stage: Int32) -> real:
    """The share of a stage in the result."""
    if stage == 1 or stage == 2:
        return real(1.0) / real(3.0)
    return real(1.0) / real(6.0)


@func
def rate_of_activation(model: Model, state: State, world: Int32, actuator: Int32) -> real:
    """The rate of the activation of an actuator with dynamics [1/s]."""
    dynamics = model.actuator[actuator].dynamics
    control = bounded_control(model, state, world, actuator)
    activation = state.actuator_activation[world, actuator] + 0.0
    constant = model.actuator_time_constant[world, actuator]
    rate = real(0.0)
    if dynamics == INTEGRATOR:
        rate = control
    elif dynamics == FILTER or dynamics == FILTER_EXACT:
        rate = (control - activation) / constant
    elif dynamics == MUSCLE:
        times = model.actuator_muscle_time[world, actuator]
        rate = activation_rate(control, activation, constant, times[0], times[1])
    return rate


@func
def turn_rate(state: State, work: StageWork, world: Int32, q: Int32, dof: Int32):
    """Replace an angular velocity in own axes by the rate of the rotation vector since the substep began.

    That is the inverse of the derivative of the exponential map, without terms that fourth order needs not.
    `q` is the place of the quaternion, `dof` that of the velocity in `StageWork.dof_stage`.
    """
    start = Quaternion(
        work.position_first[world, q],
        work.position_first[world, q + 1],
        work.position_first[world, q + 2],
        work.position_first[world, q + 3],
    )
    now = wp.normalize(load_quaternion(state, world, q))
    turned = rotation_vector(wp.quat_inverse(wp.normalize(start)) * now)
    omega = three_numbers(work.dof_stage, world, dof)
    across = wp.cross(turned, omega)
    rate = omega + real(0.5) * across + wp.cross(turned, across) / real(12.0)
    for axis in range(3):
        work.dof_stage[world, dof + axis] = rate[axis]


@func
def add_carried(model: Model, settings: Settings, state: State, work: StageWork, world: Int32, tree: Int32):
    """Add what turning carries a base along, which the free motion of a stage has left out."""
    base = model.tree[tree].first_velocity
    omega = wp.quat_rotate(base_turn(model, state, world, tree), three_numbers(work.dof_stage, world, base))
    carried = carried_by_turning(omega, arm_of_base(model, state, world, tree))
    add_to_base(state, world, base, settings.time_step * carried)


@func
def advance_stage(
    model: Model,
    settings: Settings,
    state: State,
    work: StageWork,
    world: Int32,
    tree: Int32,
    stage: Int32,
):
    """Take the velocities at the end of a stage into the sums, and go on to the next stage or the end."""
    h = settings.time_step
    base = model.tree[tree].first_velocity
    weight = weight_of(stage)
    ahead = real(0.5)
    if stage == 2:
        ahead = real(1.0)
    to_own_axes(model, state, world, tree)
    for dof in range(base, end_of_dofs(model, tree)):
        velocity = work.dof_stage[world, dof]
        change = state.dof_velocity[world, dof] - velocity
        work.dof_change[world, dof] += weight * change
        state.dof_velocity[world, dof] = change
    first_link = model.tree[tree].first_link
    turn_rate(state, work, world, model.tree[tree].first_position + 3, base)
    for link in range(first_link + 1, first_link + model.tree[tree].link_count):
        if has_quaternion(model, link):
            turn_rate(state, work, world, model.link[link].first_position, model.link[link].first_dof)
    for dof in range(base, end_of_dofs(model, tree)):
        change = state.dof_velocity[world, dof] + 0.0
        rate = work.dof_stage[world, dof] + 0.0
        work.dof_rate[world, dof] += weight * rate
        after = work.dof_first[world, dof] + ahead * change
        moving = ahead * rate
        if stage == _LAST:
            after = work.dof_first[world, dof] + work.dof_change[world, dof]
            moving = work.dof_rate[world, dof] + 0.0
        else:
            state.dof_torque[world, dof] = work.dof_applied[world, dof]
        work.dof_stage[world, dof] = after
        state.dof_velocity[world, dof] = moving
    first = model.tree[tree].first_position
    copy_run(state.position, work.position_first, first, world, model.tree[tree].position_count)
    to_world_axes(model, state, world, tree)
    integrate_positions(model, state, world, tree, h)
    copy_run(state.dof_velocity, work.dof_stage, base, world, end_of_dofs(model, tree) - base)
    to_world_axes(model, state, world, tree)


@func
def advance_activations_of_stage(
    model: Model, settings: Settings, state: State, work: StageWork, world: Int32, tree: Int32, stage: Int32
):
    """The same for activations of actuators; those at the end of the substep are within their bounds."""
    h = settings.time_step
    ahead = real(0.5)
    if stage == 2:
        ahead = real(1.0)
    first = model.tree[tree].first_actuator
    for actuator in range(first, first + model.tree[tree].actuator_count):
        dynamics = model.actuator[actuator].dynamics
        if dynamics != UNFILTERED:
            rate = rate_of_activation(model, state, world, actuator)
            work.actuator_rate[world, actuator] += weight_of(stage) * rate
            after = work.actuator_first[world, actuator] + ahead * h * rate
            if stage == _LAST:
                duration = h + 0.0
                if dynamics == FILTER_EXACT:
                    constant = model.actuator_time_constant[world, actuator]
                    duration = constant * (1.0 - wp.exp(-h / constant))
                after = within_bounds(
                    work.actuator_first[world, actuator] + duration * work.actuator_rate[world, actuator],
                    model.actuator_activation_lower[world, actuator],
                    model.actuator_activation_upper[world, actuator],
                )
            state.actuator_activation[world, actuator] = after


@kernel
def rk4_stage_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    stage_work: StageWork,
    first_world: Int32,
    stage: Int32,
    by_frame: Int32,
):
    """Add delta velocities to the velocities of a stage, 0 to 3, and go on to the next one, or to the end.

    `by_frame` is 1 if rows have seen accelerations of the origins of frames. Positions are those of centres
    of mass here: of fourth order that is the same.
    """
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if stage == _LAST:
            gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
        if is_left_out(state, world, tree):
            if stage == _LAST and not is_absent(state, world, tree):
                stop_with_base(model, state, world, tree)
        else:
            if stage == _LAST and model.tree[tree].sensed_count > 0:
                constraint_feedback(model, settings, state, scratch, world, tree)
            apply_delta_velocities(model, state, scratch, world, tree)
            if by_frame != 0 and is_off_frame(model, tree):
                add_carried(model, settings, state, stage_work, world, tree)
            if model.tree[tree].actuator_count > 0:
                advance_activations_of_stage(model, settings, state, stage_work, world, tree, stage)
            advance_stage(model, settings, state, stage_work, world, tree, stage)
