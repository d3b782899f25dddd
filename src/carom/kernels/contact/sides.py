"""Order of the two shapes of a contact: which one is shape a and which one shape b, as in Bullet.

Normals point from b to a, and friction directions are computed from normals. Users see both.
"""

import warp as wp

from carom.kernels.contact.contact_margins import is_part_of_compound
from carom.kernels.structs import Shapes
from carom.kernels.types import Index2, Int32, func
from carom.layouts.codes import PLANE, TRIANGLES


@func
def side_rank(shapes: Shapes, shape: Int32) -> Int32:
    """Rank of a shape in this order: 0 part of a compound, 1 other convex shape, 2 plane or surface."""
    kind = shapes.shape_kind[shape]
    if kind == PLANE or kind >= TRIANGLES:
        return Int32(2)
    return wp.where(is_part_of_compound(shapes, shape), Int32(0), Int32(1))


@func
def in_order_of_sides(shapes: Shapes, pair: Index2) -> Index2:
    """Shapes of a pair as (a, b); shapes of equal rank keep their order."""
    if side_rank(shapes, pair[0]) > side_rank(shapes, pair[1]):
        return Index2(pair[1], pair[0])
    return pair
