"""Data of the kernel that sets the motors of several joints."""

from carom.layouts.types import Ints, Reals, struct

# Control modes: velocity, torque in addition to the motor, position, and explicit PD control, which the
# kernel does not implement. The values are PyBullet's.
VELOCITY, TORQUE, POSITION, PD = 0, 1, 2, 3
MODES = (VELOCITY, TORQUE, POSITION, PD)
# Bits of the quantities that are given.
POSITIONS, VELOCITIES, FORCES, KPS, KDS = 1, 2, 4, 8, 16


@struct
class MotorCommands:
    """Commands for motors of one degree of freedom each."""

    joint_dof: Ints
    joint_lower: Reals  # bounds of the target position
    joint_upper: Reals
    joint_position: Reals
    joint_velocity: Reals
    joint_force: Reals
    joint_kp: Reals
    joint_kd: Reals
    joint_refused: Ints  # first entry: 1 if a number was not finite; then no motor has been set
