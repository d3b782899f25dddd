"""Traversal of the triangles of a mesh or height field that are in a region.

A *cursor* is the position of a traversal, which goes from one triangle of the region to the next. For a mesh
it is a leaf of the mesh's hierarchy. For a height field it is the number of a triangle, counted over the
cells under the region.
"""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet
from carom.kernels.contact.hierarchy import next_node
from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.shapes.cores import Core
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import TRIANGLES


@wp.struct
class Region:
    """Box in the frame of a surface; for height fields also the columns and rows of cells under the box."""

    lower: Vector3
    upper: Vector3
    first_column: Int32
    first_row: Int32
    columns: Int32
    rows: Int32


@func
def region_of(shapes: Shapes, world: Int32, surface: Int32, lower: Vector3, upper: Vector3) -> Region:
    """Region of a surface inside a box that is given in the frame of the surface."""
    region = Region()
    region.lower = lower
    region.upper = upper
    if shapes.shape_kind[surface] != TRIANGLES:
        columns = shapes.shape_columns[surface]
        rows = shapes.shape_vertex_count[surface] // columns
        half = shapes.shape_size[world, surface]
        corner = shapes.shape_center[surface] - half
        width = 2.0 * half[0] / real(columns - 1)
        height = 2.0 * half[1] / real(rows - 1)
        region.first_column = cell_at((lower[0] - corner[0]) / width, columns)
        region.first_row = cell_at((lower[1] - corner[1]) / height, rows)
        region.columns = cell_at((upper[0] - corner[0]) / width, columns) - region.first_column + 1
        region.rows = cell_at((upper[1] - corner[1]) / height, rows) - region.first_row + 1
        top = shapes.shape_center[surface][2] + half[2]
        bottom = shapes.shape_center[surface][2] - half[2]
        if lower[2] > top or upper[2] < bottom:
            region.rows = Int32(0)
    return region


@func
def cell_at(place: real, points: Int32) -> Int32:
    """Cell between grid points that contains a coordinate [cells], or the nearest cell."""
    return Int32(wp.clamp(wp.floor(place), 0.0, real(points - 2)))


@func
def region_box(shapes: Shapes, region: Region, surface: Int32, node: Int32) -> bool:
    """Whether the bounds of a node of a mesh's hierarchy meet a region."""
    row = shapes.shape_first_node[surface] + node
    return boxes_meet(region.lower, region.upper, shapes.node_lower[row], shapes.node_upper[row], 0.0)


@func
def triangle_corners(shapes: Shapes, region: Region, surface: Int32, cursor: Int32) -> Matrix3:
    """Corners of a triangle as columns, counter-clockwise from outside, in the frame of the surface."""
    a, b, c = Int32(0), Int32(0), Int32(0)
    if shapes.shape_kind[surface] == TRIANGLES:
        face = shapes.shape_first_face[surface] + cursor - shapes.shape_leaf_count[surface]
        first = shapes.face_first_corner[face]
        a = shapes.corner_vertex[first]
        b = shapes.corner_vertex[first + 1]
        c = shapes.corner_vertex[first + 2]
    else:
        cell = cursor // 2
        columns = shapes.shape_columns[surface]
        a = (
            shapes.shape_first_vertex[surface]
            + (region.first_row + cell // region.columns) * columns
            + region.first_column
            + cell % region.columns
        )
        # The diagonal of a cell goes from its corner with the larger x to that with the larger y.
        b = a + 1
        c = a + columns
        if cursor % 2 == 1:
            a = b
            b = c + 1
    p = shapes.vertex_position[a]
    q = shapes.vertex_position[b]
    r = shapes.vertex_position[c]
    return wp.matrix_from_cols(p, q, r)


@func
def corners_meet(region: Region, corners: Matrix3) -> bool:
    """Whether the bounds of a triangle, its corners as columns, meet a region."""
    meet = True
    for axis in range(3):
        low = minimum(minimum(corners[axis, 0], corners[axis, 1]), corners[axis, 2])
        high = maximum(maximum(corners[axis, 0], corners[axis, 1]), corners[axis, 2])
        if low > region.upper[axis] or high < region.lower[axis]:
            meet = False
    return meet


@func
def triangle_from(shapes: Shapes, region: Region, surface: Int32, start: Int32) -> Int32:
    """First cursor at or after `start` whose triangle's bounds meet the region; -1 if there is none.

    A traversal begins with `first_cursor` as `start`.
    """
    if shapes.shape_kind[surface] != TRIANGLES:
        cursor = start + 0
        while cursor < 2 * region.columns * region.rows:
            if corners_meet(region, triangle_corners(shapes, region, surface, cursor)):
                return cursor
            cursor += 1
        return -1
    leaf_count = shapes.shape_leaf_count[surface]
    node = start
    while node > 0:
        if region_box(shapes, region, surface, node):
            if node >= leaf_count:
                return node
            node = 2 * node
        else:
            node = next_node(node)
    return -1


@func
def first_cursor(shapes: Shapes, surface: Int32) -> Int32:
    """Cursor at which a traversal of the triangles of a surface starts."""
    return 1 if shapes.shape_kind[surface] == TRIANGLES else 0


@func
def following_cursor(shapes: Shapes, surface: Int32, cursor: Int32) -> Int32:
    """Cursor at which a traversal continues after a triangle."""
    return next_node(cursor) if shapes.shape_kind[surface] == TRIANGLES else cursor + 1


@func
def triangle_core(pairs: Pairs, world: Int32, surface: Int32, corners: Matrix3, radius: real) -> Core:
    """Core of a triangle of a surface."""
    core = Core()
    core.kind = TRIANGLES
    core.radius = radius
    core.position = pairs.shape_position[world, surface]
    core.frame = pairs.shape_frame[world, surface] * corners
    return core
