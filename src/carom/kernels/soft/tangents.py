"""The directions of a touch's impulses."""

import warp as wp

from carom.kernels.types import Matrix3, Vector3, func


@func
def tangents(normal: Vector3) -> Matrix3:
    """A unit normal and two unit tangents, as columns; all three are orthogonal."""
    aside = Vector3(0.0, 1.0, 0.0) if wp.abs(normal[0]) > 0.7 else Vector3(1.0, 0.0, 0.0)
    first = wp.normalize(wp.cross(aside, normal))
    second = wp.cross(normal, first)
    return wp.matrix_from_cols(normal, first, second)
