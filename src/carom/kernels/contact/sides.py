"""Order of the two shapes of a contact: which one is shape a and which one shape b, as in Bullet.

Normals point from b to a, and friction directions are computed from normals. Users see both.
"""

from carom.kernels.structs import Shapes
from carom.kernels.types import Index2, Int32, func
from carom.layouts.codes import PLANE, TRIANGLES


@func
def side_rank(shapes: Shapes, shape: Int32) -> Int32:
    """Rank of a shape in this order: first what is in the most compounds, last a plane or surface.

    Bullet takes two compounds apart at once until only one of them is left; that comes first.
    """
    kind = shapes.shape_kind[shape]
    if kind == PLANE or kind >= TRIANGLES:
        return Int32(1)
    return -shapes.shape_depth[shape]


@func
def in_order_of_sides(shapes: Shapes, pair: Index2) -> Index2:
    """Shapes of a pair as (a, b); shapes of equal rank keep their order."""
    if side_rank(shapes, pair[0]) > side_rank(shapes, pair[1]):
        return Index2(pair[1], pair[0])
    return pair
