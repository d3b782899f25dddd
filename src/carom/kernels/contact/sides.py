"""Which of two shapes in contact is a and which is b, as Bullet has it.

Normals point from b to a, friction directions follow from normals, and users see all of them.
"""

import warp as wp

from carom.kernels.contact.contact_margins import is_part_of_compound
from carom.kernels.structs import Shapes
from carom.kernels.types import Index4, Int32, func
from carom.layouts.codes import PLANE, TRIANGLES


@func
def side_rank(shapes: Shapes, shape: Int32) -> Int32:
    """Lower for what comes first: parts of compounds, then other convex shapes, then planes and surfaces."""
    kind = shapes.shape_kind[shape]
    if kind == PLANE or kind >= TRIANGLES:
        return Int32(2)
    return wp.where(is_part_of_compound(shapes, shape), Int32(0), Int32(1))


@func
def in_order_of_sides(shapes: Shapes, pair: Index4) -> Index4:
    """The shapes of a pair as (a, b, 0, 0); equals stay in their order."""
    if side_rank(shapes, pair[0]) > side_rank(shapes, pair[1]):
        return Index4(pair[1], pair[0], 0, 0)
    return pair
