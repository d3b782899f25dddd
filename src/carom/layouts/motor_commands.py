"""Commands to motors of joints."""

# Control modes: velocity, torque in addition to the motor, position, and explicit PD control. The values are
# PyBullet's.
VELOCITY, TORQUE, POSITION, PD = 0, 1, 2, 3
MODES = (VELOCITY, TORQUE, POSITION, PD)
# Defaults of PyBullet's functions: maximum force [N or N m] and gains.
DEFAULT_FORCE = 100000.0
DEFAULT_POSITION_GAIN, DEFAULT_VELOCITY_GAIN = 0.1, 1.0
# A maximum velocity that changes nothing.
NO_CLAMP = -1.0
# The maximum force of a motor that was given a list of targets but no force [N or N m], and its gain if the
# list of gains has the wrong length.
UNSTATED_FORCE, UNSTATED_GAIN = 1000000.0, 0.1
# Lists for a joint with several degrees of freedom: positions, velocities, forces, two gains and dampings, of
# so many numbers each at most.
TARGET_LISTS, TARGET_ENTRIES = 6, 4
