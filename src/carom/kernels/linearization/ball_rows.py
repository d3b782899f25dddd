"""Rows of the motors and limits of spherical joints, linearised."""

import warp as wp

from carom.kernels.dynamics.limits import SPHERICAL_GAIN, swing_and_twist
from carom.kernels.dynamics.motors import euler_xyz
from carom.kernels.linearization.pose_rows import euler_rates, is_quarter_turn
from carom.kernels.linearization.rows import (
    NEAR,
    add_row_of_dof,
    note_problem,
    set_input,
    share_left,
    status_of,
)
from carom.kernels.linearization.soft_rows import let_row_yield
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Quaternion, Vector3, func, real
from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_TARGET_W,
)
from carom.layouts.linearization import (
    BALL_QUARTER_TURN,
    LIMIT_ROW,
    MOTOR_ROW,
    ROW_HOLDS,
    ROW_LOWER,
)


@func
def start_turn(model: Model, scratch: Scratch, world: Int32, link: Int32) -> Quaternion:
    """Position of a spherical joint before the step."""
    start = model.link[link].first_position
    return Quaternion(
        scratch.position_start[world, start],
        scratch.position_start[world, start + 1],
        scratch.position_start[world, start + 2],
        scratch.position_start[world, start + 3],
    )


@func
def limit_angle_rates(current: Quaternion, swings: Vector3, spin: Vector3) -> Vector3:
    """Rates of `limits.swing_and_twist` at an angular velocity along the axes of the link.

    The twist is what the quaternion turns about z; `swings` are all angles of the rest, which turns with the
    link, less the twist.
    """
    turned = current * Quaternion(spin[0], spin[1], spin[2], 0.0)
    square = current[2] * current[2] + current[3] * current[3]
    twist = (current[3] * turned[2] - current[2] * turned[3]) / square
    swing = spin - twist * wp.quat_rotate_inv(current, Vector3(0.0, 0.0, 1.0))
    return Vector3(euler_rates(swings, swing, Int32(0)), euler_rates(swings, swing, Int32(1)), twist)


@func
def add_ball_limit(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    constraint: Int32,
    dof: Int32,
    least: real,
):
    """Add the rows of the limits of a spherical joint, that push with more than `least`."""
    current = start_turn(model, scratch, world, model.constraint[constraint].link)
    angles = swing_and_twist(current)
    twist = wp.normalize(Quaternion(0.0, 0.0, current[2], current[3]))
    swings = euler_xyz(rotation_matrix(wp.quat_inverse(twist) * current))
    ranges = Vector3(
        model.constraint_lower[world, constraint],
        model.constraint_upper[world, constraint],
        model.constraint_twist[world, constraint],
    )
    bound = model.constraint_max_impulse[world, constraint] * (1.0 - NEAR)
    for axis in range(3):
        impulse = steps.impulse[place * space.dofs + dof + axis]
        side = wp.where(impulse > 0.0, real(-1.0), real(1.0))
        if side * angles[axis] >= ranges[axis] and wp.abs(impulse) > least:
            steps.impulse[place * space.dofs + dof + axis] = 0.0
            status = status_of(impulse, -bound, bound)
            alpha = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
            row = add_row_of_dof(space, steps, place, LIMIT_ROW, status, dof + axis, alpha, 1.0 - alpha)
            if status == ROW_HOLDS:
                if is_quarter_turn(angles):
                    note_problem(steps, place, BALL_QUARTER_TURN, dof)
                gain = SPHERICAL_GAIN * settings.joint_erp / settings.time_step
                for other in range(3):
                    spin = Vector3(0.0, 0.0, 0.0)
                    spin[other] = 1.0
                    rates = limit_angle_rates(current, swings, spin)
                    steps.side[row * space.columns + dof + other] = -gain * rates[axis]
                let_row_yield(model, state, space, steps, place, world, row, impulse)


@func
def add_ball_motor(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    link: Int32,
    dof: Int32,
):
    """Add the three rows of the motor of a spherical joint, whose first dof is given."""
    first = space.dof_row[dof]
    x, y, z = (
        state.dof_motor[world, first],
        state.dof_motor[world, first + 1],
        state.dof_motor[world, first + 2],
    )
    if x[MOTOR_MAX_IMPULSE] != 0.0 or y[MOTOR_MAX_IMPULSE] != 0.0 or z[MOTOR_MAX_IMPULSE] != 0.0:
        target = Quaternion(x[MOTOR_POSITION], y[MOTOR_POSITION], z[MOTOR_POSITION], x[MOTOR_TARGET_W])
        current = start_turn(model, scratch, world, link)
        angles = euler_xyz(rotation_matrix(wp.quat_inverse(target) * current))
        for axis in range(3):
            motor = state.dof_motor[world, first + axis]
            bound = motor[MOTOR_MAX_IMPULSE]
            impulse = state.dof_motor_impulse[world, first + axis]
            steps.impulse[place * space.dofs + dof + axis] -= impulse
            status = status_of(impulse, -bound, bound)
            alpha = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
            row = add_row_of_dof(space, steps, place, MOTOR_ROW, status, dof + axis, alpha, 1.0 - alpha)
            if status == ROW_HOLDS:
                steps.row_switch[row] = share_left(impulse, -bound, bound)
                if is_quarter_turn(angles):
                    note_problem(steps, place, BALL_QUARTER_TURN, dof)
                gain = motor[MOTOR_KP] * settings.joint_erp / settings.time_step
                for other in range(3):
                    spin = Vector3(0.0, 0.0, 0.0)
                    spin[other] = 1.0
                    side = row * space.columns + dof + other
                    steps.side[side] = -gain * euler_rates(angles, spin, axis)
                steps.through[row * space.dofs + dof + axis] = 1.0 - motor[MOTOR_DAMPING]
                let_row_yield(model, state, space, steps, place, world, row, impulse)
            else:
                sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
                set_input(space, steps, row, space.dof_input[dof + axis], MOTOR_MAX_IMPULSE, sign)
