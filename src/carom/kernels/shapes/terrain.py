"""Contacts of convex shapes with height fields as MuJoCo has them: one with each prism under a triangle.

Triangles push only upwards or sideways, however deep a shape is; and the diagonal of a cell goes from its
corner with the smaller coordinates to that with the larger ones, not the other one as in Bullet.
"""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.convex import nearest_or_deepest
from carom.kernels.shapes.cores import Core
from carom.kernels.shapes.surfaces import region_around
from carom.kernels.shapes.triangles import Region, triangle_core
from carom.kernels.structs import CandidateRows, Pairs, Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.parallel import MAX_CANDIDATES

# How far prisms reach below the lowest point of a field [m], besides its height: no shape leaves them there.
_BELOW = real(1.0)


@func
def prism_top(shapes: Shapes, region: Region, surface: Int32, cursor: Int32) -> Matrix3:
    """Corners of triangle number `cursor` of a region as columns, in the frame of the surface."""
    cell = cursor // 2
    columns = shapes.shape_columns[surface]
    corner = (
        shapes.shape_first_vertex[surface]
        + (region.first_row + cell // region.columns) * columns
        + region.first_column
        + cell % region.columns
    )
    across = corner + columns + 1
    middle, last = across, corner + columns
    if cursor % 2 == 1:
        middle, last = corner + 1, across
    return wp.matrix_from_cols(
        shapes.vertex_position[corner], shapes.vertex_position[middle], shapes.vertex_position[last]
    )


@func
def reaches(region: Region, top: Matrix3) -> bool:
    """Whether a prism reaches into a region."""
    meet = wp.max(wp.max(top[2, 0], top[2, 1]), top[2, 2]) >= region.lower[2]
    for axis in range(2):
        low = wp.min(wp.min(top[axis, 0], top[axis, 1]), top[axis, 2])
        high = wp.max(wp.max(top[axis, 0], top[axis, 1]), top[axis, 2])
        if low > region.upper[axis] or high < region.lower[axis]:
            meet = False
    return meet


@func
def add_deepest(
    candidates: CandidateRows, world: Int32, count: Int32, point: Vector3, normal: Vector3, distance: real
) -> Int32:
    """Add a candidate; if there are as many as a pair may have, in place of the least deep one, if deeper."""
    if count < MAX_CANDIDATES:
        return add_candidate(candidates, world, count, point, normal, distance)
    least = Int32(0)
    for row in range(1, count):
        if candidates[world, row].distance > candidates[world, least].distance:
            least = Int32(row)
    if distance < candidates[world, least].distance:
        add_candidate(candidates, world, least, point, normal, distance)
    return count


@func
def collide_terrain(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    core: Core,
    max_distance: real,
    around: real,
) -> Int32:
    """Write the candidates of shape a, convex, on shape b, a height field; returns their number.

    `max_distance` is the largest distance of a contact [m]; prisms are tested within the distance `around`
    [m] from the bounds of a.
    """
    region = region_around(shapes, pairs, world, a, b, around)
    up = column(pairs.shape_frame[world, b], 2)
    down = -(2.0 * shapes.shape_size[world, b][2] + _BELOW) * up
    count = Int32(0)
    cursor = Int32(0)
    while cursor < 2 * region.columns * region.rows:
        top = prism_top(shapes, region, b, cursor)
        cursor += 1
        if reaches(region, top):
            prism = triangle_core(pairs, world, b, top, 0.0)
            prism.size = down
            distance, normal, _point_a, point_b = nearest_or_deepest(
                shapes, pairs, world, core, prism, max_distance + core.radius, up, Vector3(0.0, 0.0, 0.0)
            )
            if distance <= max_distance + core.radius and distance - core.radius <= max_distance:
                count = add_deepest(pairs.candidate, world, count, point_b, normal, distance - core.radius)
    return count
