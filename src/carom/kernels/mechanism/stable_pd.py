"""Torques of a stable PD controller."""

import math

import warp as wp

from carom.kernels.joints.coordinates import quaternion_at, vector_at
from carom.kernels.joints.nodes import has_quaternion
from carom.kernels.mechanism.cholesky import solve_damped
from carom.kernels.mechanism.dynamics import (
    composite_inertia,
    first_rate,
    newton_euler_of_input,
    place_in_base,
)
from carom.kernels.structs import Control, MechanismSizes, MechanismTable
from carom.kernels.types import Int32, Quaternion, Vector3, func, kernel, real
from carom.layouts.mechanism import BASE_MOTION

_NO_ANGLE = real(1e-6)
_HALF_TURN = real(math.pi)


@func
def turn_between(start: Quaternion, end: Quaternion) -> Vector3:
    """Rotation vector from orientation `start` to `end`, in the axes of `start` [rad]."""
    turn = wp.quat_inverse(start) * end
    cosine = wp.clamp(turn[3], -1.0, 1.0)
    sine = wp.sqrt(1.0 - cosine * cosine)
    if sine <= _NO_ANGLE:
        return Vector3(0.0, 0.0, 0.0)
    angle = 2.0 * wp.acos(cosine)
    if angle > _HALF_TURN:
        angle -= 2.0 * _HALF_TURN
    return Vector3(turn[0], turn[1], turn[2]) * (angle / sine)


@func
def advanced(start: Quaternion, rate: Vector3, time_step: real) -> Quaternion:
    """An orientation after one explicit Euler step with an angular velocity in its own axes."""
    half = 0.5 * time_step
    return wp.normalize(start + start * Quaternion(rate[0] * half, rate[1] * half, rate[2] * half, 0.0))


@func
def wanted_torques(sizes: MechanismSizes, mechanism: MechanismTable, control: Control, time_step: real):
    """Fill `dof_torque` with PD torques, with the errors of positions extrapolated by one time step."""
    rates = first_rate(sizes)
    for node in range(sizes.nodes):
        q = mechanism.node[node].first_position
        first = mechanism.node[node].first_dof
        turn = Vector3(0.0, 0.0, 0.0)
        if has_quaternion(mechanism, node):
            start = quaternion_at(mechanism.input, BASE_MOTION + q)
            rate = vector_at(mechanism.input, rates + first)
            turn = turn_between(advanced(start, rate, time_step), quaternion_at(control.coordinate_target, q))
        for k in range(mechanism.node[node].dof_count):
            dof = first + k
            if dof < sizes.base_dofs:
                control.dof_torque[dof] = 0.0
            else:
                rate_now = mechanism.input[rates + dof]
                error = turn[k % 3]
                if not has_quaternion(mechanism, node):
                    position = mechanism.input[BASE_MOTION + q + k]
                    error = control.coordinate_target[q + k] - position - time_step * rate_now
                control.dof_torque[dof] = control.dof_kp[dof] * error + control.dof_kd[dof] * (
                    control.dof_target_rate[dof] - rate_now
                )


@kernel
def stable_pd_kernel(
    sizes: MechanismSizes, mechanism: MechanismTable, control: Control, base_is_held: Int32, time_step: real
):
    """Compute in `dof_torque` the torques of stable PD control for the next step."""
    newton_euler_of_input(sizes, mechanism, -1)
    for node in range(sizes.nodes):
        place_in_base(mechanism, node)
    composite_inertia(sizes, mechanism)
    wanted_torques(sizes, mechanism, control, time_step)
    # Accelerations of a base that is held are 0.
    solve_damped(
        mechanism.matrix, control.dof_kd, time_step, control.dof_torque, mechanism.output,
        control.entry_factor, control.dof_acceleration, base_is_held * sizes.base_dofs, sizes.dofs,
    )  # fmt: skip
    for dof in range(sizes.base_dofs, sizes.dofs):
        torque = control.dof_torque[dof] - time_step * control.dof_kd[dof] * control.dof_acceleration[dof]
        most = control.dof_most[dof]
        control.dof_torque[dof] = wp.clamp(torque, -most, most)
