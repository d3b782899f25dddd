"""Joint motors (POSITION_CONTROL, VELOCITY_CONTROL): constraint rows with gains and a maximum impulse.

A motor's row requests a joint rate after the step; the solver computes the impulse that causes it, up to
the motor's maximum impulse. That of a servo yields: its gains are stiffness and damping. Explicit PD control
and joint damping are torques instead.
"""

import warp as wp

from carom.kernels.dynamics.rows import add_row, axis_effective_masses, dof_effective_mass
from carom.kernels.joints.coordinates import load_quaternion
from carom.kernels.maths.lanes import in_some_world
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.maths.runs import subtract_products
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Matrix3, Quaternion, Vector3, func, real
from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_SERVO,
    MOTOR_TARGET_W,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
    PD_KD,
    PD_KP,
    PD_MAX_FORCE,
    PD_POSITION,
    PD_VELOCITY,
)


@func
def unless_nan(value: real, other: real) -> real:
    """Return `value`, or NaN if `other` is NaN: clamping to NaN bounds would hide the NaN."""
    return wp.where(other == other, value, other)


@func
def joint_damping(model: Model, state: State, world: Int32, tree: Int32):
    """Add viscous joint damping as an explicit torque, from the rates before the step."""
    subtract_products(
        state.dof_torque, model.dof_damping, state.dof_velocity, model.tree[tree].first_dof, world,
        model.tree[tree].dof_count,
    )  # fmt: skip


@func
def explicit_pd(model: Model, state: State, world: Int32, tree: Int32):
    """Add the torques of explicit PD control; they add up over the substeps of one step."""
    base = model.tree[tree].first_link
    for link in range(base + 1, base + model.tree[tree].link_count):
        if model.link[link].dof_count == 1:
            dof = model.link[link].first_dof
            drive = state.dof_pd[world, dof]
            bound = drive[PD_MAX_FORCE]
            if in_some_world(not bound <= 0.0):
                position = state.position[world, model.link[link].first_position]
                force = drive[PD_KP] * (drive[PD_POSITION] - position) + drive[PD_KD] * (
                    drive[PD_VELOCITY] - state.dof_velocity[world, dof]
                )
                force = unless_nan(within_bounds(force, -bound, bound), bound)
                torque = state.dof_torque[world, dof]
                state.dof_torque[world, dof] = wp.where(bound <= 0.0, torque, torque + force)


@func
def motor_row(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Add the row of a revolute or prismatic motor; returns the next free row."""
    link = model.constraint[constraint].link
    dof = model.link[link].first_dof
    motor = state.dof_motor[world, dof]
    bound = motor[MOTOR_MAX_IMPULSE]
    if bound == 0.0:
        return row
    velocity = state.dof_velocity[world, dof]
    position_error = motor[MOTOR_POSITION] - state.position[world, model.link[link].first_position]
    wanted = (
        motor[MOTOR_KP] * position_error / settings.time_step
        + velocity
        + motor[MOTOR_KD] * (motor[MOTOR_VELOCITY] - velocity)
    )
    clamp = motor[MOTOR_VELOCITY_CLAMP]
    wanted = unless_nan(within_bounds(wanted, -clamp, clamp), bound + clamp)
    effective_mass = dof_effective_mass(model, scratch, world, model.constraint[constraint].tree, dof)
    change = wanted - velocity
    if in_some_world(motor[MOTOR_SERVO] != 0.0):
        return servo_row(
            model, settings, state, scratch, world, constraint, row, change, effective_mass, position_error
        )
    return add_row(model, scratch, world, constraint, row, dof, change, effective_mass, -bound, bound)


@func
def servo_row(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
    change_of_motor: real,
    effective_mass: real,
    position_error: real,
) -> Int32:
    """Add the row of a servo: a spring and a damper by position and velocity at the end of the substep.

    It is soft, as that of an actuator. Where other worlds of the lanes have a servo and this one a motor of
    shares, it is as hard as that, with the change that it requests.
    """
    dof = model.link[model.constraint[constraint].link].first_dof
    motor = state.dof_motor[world, dof]
    bound = motor[MOTOR_MAX_IMPULSE]
    h = settings.time_step
    is_servo = motor[MOTOR_SERVO] != 0.0
    stiffness, damping = motor[MOTOR_KP], motor[MOTOR_KD]
    # Impulse = h (stiffness error + damping target) - yielding (rate at the end).
    yielding = h * (damping + h * stiffness)
    impulse = h * (stiffness * position_error + damping * motor[MOTOR_VELOCITY])
    yields = is_servo and yielding > 0.0
    softness = wp.where(yields, 1.0 / wp.where(yields, yielding, real(1.0)), real(0.0))
    moves = effective_mass != 0.0
    inverse_mass = wp.where(moves, 1.0 / wp.where(moves, effective_mass, real(1.0)), real(1.0))
    share = wp.where(is_servo, inverse_mass / (inverse_mass + softness), real(1.0))
    # Without gains it does nothing.
    share = wp.where(is_servo and yielding <= 0.0, real(0.0), share)
    change = wp.where(is_servo, impulse * softness - state.dof_velocity[world, dof], change_of_motor)
    scratch.row_share[world, row] = share
    scratch.row_softness[world, row] = share * softness
    after = add_row(model, scratch, world, constraint, row, dof, change, effective_mass, -bound, bound)
    scratch.row[world, row].soft = 1
    return after


@func
def euler_xyz(r: Matrix3) -> Vector3:
    """Angles (x, y, z) with R = Rx(x) Ry(y) Rz(z); at gimbal lock z is 0."""
    half_pi = 0.5 * 3.14159265358979323846
    s = r[0, 2]
    if s >= 1.0:
        return Vector3(wp.atan2(r[1, 0], r[1, 1]), half_pi, 0.0)
    if s <= -1.0:
        return Vector3(-wp.atan2(r[1, 0], r[1, 1]), -half_pi, 0.0)
    return Vector3(wp.atan2(-r[1, 2], r[2, 2]), wp.asin(s), wp.atan2(-r[0, 1], r[0, 0]))


@func
def joint_quaternion(model: Model, state: State, world: Int32, link: Int32) -> Quaternion:
    """Position of a spherical joint."""
    return load_quaternion(state, world, model.link[link].first_position)


@func
def spherical_motor_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Add the rows of a spherical motor, by orientation error and rate; returns the next free row."""
    link = model.constraint[constraint].link
    first = model.link[link].first_dof
    x = state.dof_motor[world, first]
    y = state.dof_motor[world, first + 1]
    z = state.dof_motor[world, first + 2]
    if x[MOTOR_MAX_IMPULSE] == 0.0 and y[MOTOR_MAX_IMPULSE] == 0.0 and z[MOTOR_MAX_IMPULSE] == 0.0:
        return row
    target = Quaternion(x[MOTOR_POSITION], y[MOTOR_POSITION], z[MOTOR_POSITION], x[MOTOR_TARGET_W])
    current = joint_quaternion(model, state, world, link)
    error = euler_xyz(rotation_matrix(wp.quat_inverse(target) * current))
    effective_mass = axis_effective_masses(model, scratch, world, model.constraint[constraint].tree, link)
    for axis in range(3):
        motor = state.dof_motor[world, first + axis]
        bound = motor[MOTOR_MAX_IMPULSE]
        change = -motor[MOTOR_DAMPING] * state.dof_velocity[world, first + axis]
        change -= motor[MOTOR_KP] * error[axis] * settings.joint_erp / settings.time_step
        change = unless_nan(change, bound)
        row = add_row(
            model, scratch, world, constraint, row, first + axis, change, effective_mass[axis], -bound, bound
        )
    return row
