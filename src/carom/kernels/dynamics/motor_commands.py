"""Setting the motors of several joints in one launch."""

import math

import warp as wp

from carom.kernels.structs import MotorCommands, State
from carom.kernels.types import Int32, Reals, func, kernel, real
from carom.layouts.codes import (
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
)
from carom.layouts.motor_commands import FORCES, KDS, KPS, POSITION, POSITIONS, TORQUE, VELOCITIES, VELOCITY

UNBOUNDED = real(math.inf)


@func
def stated(given: Int32, bit: Int32, numbers: Reals, joint: Int32, otherwise: real) -> real:
    """The number for a joint if such numbers are given, else the default `otherwise`."""
    return numbers[joint] if given & bit != 0 else otherwise


@func
def total(given: Int32, bit: Int32, numbers: Reals, count: Int32) -> real:
    """Sum of the numbers for all joints if they are given, else 0."""
    result = real(0.0)
    if given & bit != 0:
        for joint in range(count):
            result += numbers[joint]
    return result


@func
def sum_of_given(commands: MotorCommands, count: Int32, given: Int32) -> real:
    """Sum of all numbers given: it is finite if all of them are."""
    return (
        total(given, POSITIONS, commands.joint_position, count)
        + total(given, VELOCITIES, commands.joint_velocity, count)
        + total(given, FORCES, commands.joint_force, count)
        + total(given, KPS, commands.joint_kp, count)
        + total(given, KDS, commands.joint_kd, count)
    )


@kernel
def command_motors_kernel(
    state: State,
    commands: MotorCommands,
    world: Int32,
    count: Int32,
    default_force: real,
    default_kp: real,
    default_kd: real,
    mode: Int32,
    given: Int32,
    time_step: real,
):
    """Set the motors of joints, or add joint torques; does nothing if a number is not finite.

    For each joint the result is that of `AxisMotor.command` in `carom.scene.joint_motor`. `mode` is
    `VELOCITY`, `TORQUE` or `POSITION`, and `given` has the bits of the quantities given. Positions and
    velocities that are not given are 0; forces [N or N m], with `TORQUE` the torques, and gains are the
    defaults. Forces become impulses by `time_step` [s].
    """
    if not wp.isfinite(sum_of_given(commands, count, given)):
        commands.joint_refused[0] = 1
        return
    commands.joint_refused[0] = 0
    for joint in range(count):
        dof = commands.joint_dof[joint]
        velocity = stated(given, VELOCITIES, commands.joint_velocity, joint, 0.0)
        force = stated(given, FORCES, commands.joint_force, joint, default_force)
        kd = stated(given, KDS, commands.joint_kd, joint, default_kd)
        if mode == TORQUE:
            state.dof_torque[world, dof] += force
        else:
            motor = state.dof_motor[world, dof]
            motor[MOTOR_POSITION] = 0.0
            motor[MOTOR_KP] = 0.0
            if mode == POSITION:
                position = stated(given, POSITIONS, commands.joint_position, joint, 0.0)
                motor[MOTOR_POSITION] = wp.clamp(
                    position, commands.joint_lower[joint], commands.joint_upper[joint]
                )
                motor[MOTOR_KP] = stated(given, KPS, commands.joint_kp, joint, default_kp)
            if mode == VELOCITY:
                motor[MOTOR_VELOCITY_CLAMP] = UNBOUNDED
            motor[MOTOR_VELOCITY] = velocity
            motor[MOTOR_KD] = kd
            motor[MOTOR_MAX_IMPULSE] = force * time_step
            state.dof_motor[world, dof] = motor
