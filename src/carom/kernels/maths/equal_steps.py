"""Friction that does not depend on how its two directions lie (`Settings.cone_friction` = `ISOTROPIC`).

In the usual cone each of both rows takes a step of its own effective mass before both are scaled back to the
circle. Where these masses differ, as between the rolling and the axial direction of a wheel, the impulse of
a sliding contact is then not opposite to its velocity, and changes with the directions, which are fixed in
the world. Here both rows take steps of the same size: the inverse of the greatest eigenvalue of the block of
the Delassus matrix of both. A sliding contact at rest in these sweeps has an impulse opposite to its velocity
(the principle of maximum dissipation), and no sweep depends on the directions.
"""

import warp as wp

from carom.kernels.types import Vector2, func, real


@func
def equal_steps(inverse_mass1: real, inverse_mass2: real, coupling: real) -> Vector2:
    """Factors that make steps of the same size of those of two rows, each with its effective mass.

    Args:
        inverse_mass1: Change of the velocity of the first row by its own unit impulse.
        inverse_mass2: The same of the second row.
        coupling: Change of the velocity of either row by a unit impulse of the other.
    """
    half = 0.5 * (inverse_mass1 - inverse_mass2)
    greatest = 0.5 * (inverse_mass1 + inverse_mass2) + wp.sqrt(half * half + coupling * coupling)
    return Vector2(inverse_mass1, inverse_mass2) / greatest if greatest > 0.0 else Vector2(0.0, 0.0)
