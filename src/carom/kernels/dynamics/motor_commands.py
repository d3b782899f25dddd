"""Setting the motors of several joints at once."""

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
    """A number that is given, or what stands for it."""
    if given & bit != 0:
        return numbers[joint]
    return otherwise


@func
def total(given: Int32, bit: Int32, numbers: Reals, count: Int32) -> real:
    """The sum of numbers if they are given."""
    result = real(0.0)
    if given & bit != 0:
        for joint in range(count):
            result += numbers[joint]
    return result


@func
def sum_of_given(commands: MotorCommands, count: Int32, given: Int32) -> real:
    """The sum of all numbers that are given: finite if all of them are."""
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
    """Set the motors of joints, or add to their torques; nothing if a number is not finite.

    The same as `AxisMotor.command` of `carom.scene.joint_motor` for each.

    Args:
        state: The state of all worlds.
        commands: The commands of the motors.
        world: Their world.
        count: How many joints there are.
        default_force: Force of motors whose forces are not given [N or N m].
        default_kp: Default gain.
        default_kd: Default gain.
        mode: `VELOCITY`, `TORQUE` or `POSITION`.
        given: What is given; other positions and velocities are 0.
        time_step: Of a step [s]; makes impulses of forces.
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
