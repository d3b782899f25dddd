"""Shapes that overlapped in the last substep, along a normal that is known: the first tetrahedron for EPA.

Resting shapes touch along nearly the same normal as before. Four corners of the Minkowski difference around
that normal, and one on the other side, enclose the origin then as a rule, with the face that is nearest to it
already among theirs. So neither GJK has to be asked whether the shapes overlap, nor the polytope to grow.
"""

import warp as wp

from carom.kernels.shapes.cores import Core
from carom.kernels.shapes.gjk import face_hides_origin
from carom.kernels.shapes.polytope import add_corner
from carom.kernels.shapes.segments import any_perpendicular
from carom.kernels.types import Int32, Vector3, Vector3Rows, Vectors3, real, shared_func

# By how much the directions of the four corners lean away from the normal: by more than shapes turn within a
# substep, and by less than neighbouring faces do.
_LEAN = real(0.05)
# These directions are turned against the edges of faces, along which two corners would be equally far.
_COSINE, _SINE = real(0.92387953251128674), real(0.38268343236508978)


@shared_func
def encloses_origin(
    core_a: Core,
    core_b: Core,
    vertex_position: Vectors3,
    points: Vector3Rows,
    points_a: Vector3Rows,
    world: Int32,
    normal: Vector3,
) -> bool:
    """Write four corners of the Minkowski difference; whether the origin is between them.

    `normal` is that of the last contact, from b towards a. The corners are as `gjk.nearest_points` leaves
    them where cores overlap.
    """
    outward = -normal
    x = any_perpendicular(outward)
    y = wp.cross(outward, x)
    along = (x * _COSINE + y * _SINE) * _LEAN
    across = (y * _COSINE - x * _SINE) * _LEAN
    first = add_corner(core_a, core_b, vertex_position, points, points_a, world, 0, outward + along)
    second = add_corner(core_a, core_b, vertex_position, points, points_a, world, 1, outward + across)
    third = add_corner(core_a, core_b, vertex_position, points, points_a, world, 2, outward - along)
    # The diagonal from the first to the third parts the four corners: those on the side of the origin stay.
    beside = wp.cross(outward, third - first)
    if wp.dot(beside, second - first) * wp.dot(beside, -first) < 0.0:
        second = add_corner(core_a, core_b, vertex_position, points, points_a, world, 1, outward - across)
    behind = add_corner(core_a, core_b, vertex_position, points, points_a, world, 3, -outward)
    return not (
        face_hides_origin(first, second, third, behind)
        or face_hides_origin(first, second, behind, third)
        or face_hides_origin(second, third, behind, first)
        or face_hides_origin(third, first, behind, second)
    )
