"""Bounds of numbers that Python and the library's hand-written C++ share."""

# Greatest magnitude of positions, velocities, masses and similar quantities, so that their products do not
# overflow; the same as in files.
MAX_MAGNITUDE = 1e30
# Squared lengths of valid quaternions: their products neither underflow nor overflow.
MIN_SQUARE, MAX_SQUARE = 1e-60, 1e60
# Rounding error of the squared length of a unit quaternion.
UNIT_ROUNDING = 1e-15
# Greatest search distance, which stands for all larger ones [m].
MAX_DISTANCE = 1e30
# A PD drive with a smaller maximum force [N or N m] is switched off.
MIN_PD_FORCE = 1.1920928955078125e-07
