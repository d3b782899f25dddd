"""Data of the kernel that sets the motors of several joints."""

from carom.layouts.types import Ints, Reals, struct

# What the numbers are for: a velocity, a torque beside the motor, a position, an explicit PD drive, which the
# kernel does not set. The values are PyBullet's.
VELOCITY, TORQUE, POSITION, PD = 0, 1, 2, 3
MODES = (VELOCITY, TORQUE, POSITION, PD)
# Bits that say which numbers are given.
POSITIONS, VELOCITIES, FORCES, KPS, KDS = 1, 2, 4, 8, 16


@struct
class MotorCommands:
    """Commands of motors with one degree of freedom each."""

    joint_dof: Ints
    joint_lower: Reals  # least target position
    joint_upper: Reals
    joint_position: Reals
    joint_velocity: Reals
    joint_force: Reals
    joint_kp: Reals
    joint_kd: Reals
    joint_refused: Ints  # the first one: some number was not finite, and nothing has been done
