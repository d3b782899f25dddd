"""Ray tests with triangle meshes and height fields; see `ray_solids` for the conventions.

Rays hit triangles from both sides; the normal is that of the side hit.
"""

import warp as wp

from carom.kernels.contact.hierarchy import next_node
from carom.kernels.maths.rotation import column
from carom.kernels.queries.ray_solids import MISS
from carom.kernels.shapes.triangles import Region, cell_at, triangle_corners
from carom.kernels.structs import Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, func, real

# Used as the reciprocal of zero.
HUGE = real(1.0e30)
# Triangles are enlarged by this share for rays, so that no ray passes between two neighbours.
EDGE_TOLERANCE = real(1.0e-9)


@func
def inverse_way(way: Vector3) -> Vector3:
    """Reciprocals of the components of a ray's vector `way`; `HUGE` for zero."""
    result = Vector3(HUGE, HUGE, HUGE)
    for axis in range(3):
        if wp.abs(way[axis]) * HUGE > 1.0:
            result[axis] = 1.0 / way[axis]
    return result


@func
def box_entry(start: Vector3, inverse: Vector3, lower: Vector3, upper: Vector3, last: real) -> real:
    """Fraction at which a ray enters a box, 0 if it starts inside; `MISS` if there is none up to `last`."""
    one, other = wp.cw_mul(lower - start, inverse), wp.cw_mul(upper - start, inverse)
    enter = wp.max(wp.max(wp.min(one, other)), 0.0)
    leave = wp.min(wp.min(wp.max(one, other)), last)
    # Empty boxes have their lower corner above their upper one.
    return enter if enter <= leave and lower[0] <= upper[0] else MISS


@func
def comes_after(fraction: real, after: real, inclusive: bool) -> bool:
    """Whether the fraction of a hit is greater than `after`, or equal to it if `inclusive`."""
    return fraction > after or (inclusive and fraction == after)


@func
def ray_triangle(start: Vector3, way: Vector3, corners: Matrix3):
    """Ray against a triangle whose corners are columns."""
    a, b, c = column(corners, 0), column(corners, 1), column(corners, 2)
    across = wp.cross(b - a, c - a)
    slope = wp.dot(across, way)
    height = wp.dot(across, start - a)
    fraction = real(MISS)
    if height * slope < 0.0 and wp.abs(height) <= wp.abs(slope):
        at = -height / slope
        p = start + way * at
        area = wp.length_sq(across)
        least = wp.min(
            wp.dot(wp.cross(b - a, p - a), across),
            wp.min(wp.dot(wp.cross(c - b, p - b), across), wp.dot(wp.cross(a - c, p - c), across)),
        )
        if least >= -EDGE_TOLERANCE * area:
            fraction = at
    return fraction, wp.normalize(across) * wp.sign(height)


@func
def ray_mesh(
    shapes: Shapes, surface: Int32, start: Vector3, way: Vector3, after: real, inclusive: bool, last: real
):
    """Ray against a triangle mesh: first hit that comes after `after` (see `comes_after`), up to `last`."""
    region = Region()
    leaf_count = shapes.shape_leaf_count[surface]
    best, best_normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    limit = last
    inverse = inverse_way(way)
    node = Int32(1)
    while node > 0:
        row = shapes.shape_first_node[surface] + node
        if box_entry(start, inverse, shapes.node_lower[row], shapes.node_upper[row], limit) < MISS:
            if node < leaf_count:
                node = 2 * node
                continue
            fraction, normal = ray_triangle(start, way, triangle_corners(shapes, region, surface, node))
            if comes_after(fraction, after, inclusive) and fraction <= limit and fraction < best:
                best = fraction
                best_normal = normal
                limit = fraction
        node = next_node(node)
    return best, best_normal


@func
def time_to_leave(place: real, speed: real, cell: Int32) -> real:
    """Time at which a point that moves along an axis leaves a unit cell."""
    if speed > 0.0:
        return (real(cell) + 1.0 - place) / speed
    return (real(cell) - place) / speed if speed < 0.0 else HUGE


@func
def ray_field(
    shapes: Shapes,
    world: Int32,
    surface: Int32,
    start: Vector3,
    way: Vector3,
    after: real,
    inclusive: bool,
    last: real,
):
    """Ray against a height field, as `ray_mesh`; goes from cell to cell under the ray."""
    center = shapes.shape_center[surface]
    size = shapes.shape_size[world, surface]
    best, best_normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    now = box_entry(start, inverse_way(way), center - size, center + size, last)
    columns = shapes.shape_columns[surface] - 1
    rows = shapes.shape_vertex_count[surface] // shapes.shape_columns[surface] - 1
    # Position and velocity in units of cells.
    x = (start[0] - center[0] + size[0]) * 0.5 * real(columns) / size[0]
    y = (start[1] - center[1] + size[1]) * 0.5 * real(rows) / size[1]
    vx = way[0] * 0.5 * real(columns) / size[0]
    vy = way[1] * 0.5 * real(rows) / size[1]
    region = Region()
    region.columns = Int32(1)
    region.rows = Int32(1)
    region.first_column = cell_at(x + vx * now, columns + 1)
    region.first_row = cell_at(y + vy * now, rows + 1)
    walking = now <= last
    while walking:
        for half in range(2):
            fraction, normal = ray_triangle(
                start, way, triangle_corners(shapes, region, surface, Int32(half))
            )
            if comes_after(fraction, after, inclusive) and fraction <= last and fraction < best:
                best = fraction
                best_normal = normal
        leave_column = time_to_leave(x, vx, region.first_column)
        leave_row = time_to_leave(y, vy, region.first_row)
        now = wp.min(leave_column, leave_row)
        if leave_column < leave_row:
            region.first_column += Int32(wp.sign(vx))
        else:
            region.first_row += Int32(wp.sign(vy))
        walking = (
            best == MISS
            and now <= last
            and region.first_column >= 0
            and region.first_column < columns
            and region.first_row >= 0
            and region.first_row < rows
        )
    return best, best_normal
