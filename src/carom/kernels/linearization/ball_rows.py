"""Rows of the motors of spherical joints, linearised."""

import warp as wp

from carom.kernels.dynamics.motors import euler_xyz
from carom.kernels.linearization.pose_rows import euler_rates, is_quarter_turn
from carom.kernels.linearization.rows import add_row_of_dof, note_problem, set_input, share_left, status_of
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
from carom.layouts.linearization import BALL_QUARTER_TURN, MOTOR_ROW, ROW_HOLDS, ROW_LOWER


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
        start = model.link[link].first_position
        current = Quaternion(
            scratch.position_start[world, start],
            scratch.position_start[world, start + 1],
            scratch.position_start[world, start + 2],
            scratch.position_start[world, start + 3],
        )
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
            else:
                sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
                set_input(space, steps, row, space.dof_input[dof + axis], MOTOR_MAX_IMPULSE, sign)
