"""Default arguments of the functions that command motors."""

DEFAULT_FORCE = 100000.0
"""Maximum force [N or N m]."""

DEFAULT_POSITION_GAIN = 0.1
DEFAULT_VELOCITY_GAIN = 1.0
