"""Contact points of a hull on a plane as MuJoCo has them: the deepest corner, and a face beside it."""

import warp as wp

from carom.kernels.shapes.cores import Core, farthest_of
from carom.kernels.shapes.faces import aligned, face_of_graph
from carom.kernels.shapes.planes import add_on_plane
from carom.kernels.structs import CandidateRows
from carom.kernels.types import (
    Index4,
    Int32,
    Ints,
    Vector3,
    Vector3Rows,
    Vectors3,
    Vectors4,
    func,
    real,
    shared_func,
)

# Most corners of a face that touch a plane.
MOST = 4


@func
def following(row: Int32, count: Int32) -> Int32:
    """The next corner around a polygon."""
    return wp.where(row + 1 == count, Int32(0), row + 1)


@func
def spanned(polygon: Vector3Rows, world: Int32, a: Int32, b: Int32, c: Int32, d: Int32) -> real:
    """Twice the area of a quadrilateral: its diagonals crossed."""
    return wp.length(wp.cross(polygon[world, c] - polygon[world, a], polygon[world, d] - polygon[world, b]))


@func
def widest_four(polygon: Vector3Rows, world: Int32, count: Int32) -> Index4:
    """Four corners of a convex polygon of at least four that span a large area.

    The first one goes around the polygon, and drives the others on as long as the area grows: the last one by
    a corner, then the third and the second as far as they go. Of equal areas the first found counts.
    """
    b, c, d = Int32(1), Int32(2), Int32(3)
    best = Index4(0, 1, 2, 3)
    most = spanned(polygon, world, 0, b, c, d)
    for first in range(count):
        a = Int32(first)
        grows = Int32(1)
        while grows == 1:
            area = spanned(polygon, world, a, b, c, following(d, count))
            if area <= most:
                grows = Int32(0)
            else:
                most = area
                d = following(d, count)
                area = spanned(polygon, world, a, b, following(c, count), d)
                while area > most:
                    most = area
                    c = following(c, count)
                    area = spanned(polygon, world, a, b, following(c, count), d)
                area = spanned(polygon, world, a, following(b, count), c, d)
                while area > most:
                    most = area
                    b = following(b, count)
                    area = spanned(polygon, world, a, following(b, count), c, d)
                best = Index4(a, b, c, d)
        if b == a:
            b = following(b, count)
            if c == b:
                c = following(c, count)
                if d == c:
                    d = following(d, count)
    return best


@shared_func
def collide_hull_on_plane(
    core: Core,
    first_face: Int32,
    face_count: Int32,
    vertex_position: Vectors3,
    face_plane: Vectors4,
    face_first_corner: Ints,
    face_corner_count: Ints,
    corner_vertex: Ints,
    origin: Vector3,
    normal: Vector3,
    max_distance: real,
    polygon: Vector3Rows,
    candidates: CandidateRows,
    world: Int32,
) -> Int32:
    """Write the candidates of a hull, shape a, on a plane, shape b; returns their number.

    They are corners within `max_distance` [m] of that face, among those at the deepest corner, which is
    turned to the plane most: the deepest one first, and of more than four corners those of `widest_four`.
    """
    local = -(wp.transpose(core.frame) * normal)
    deepest = farthest_of(core, vertex_position, local)
    point = core.position + core.frame * vertex_position[deepest]
    if wp.dot(point - origin, normal) - core.radius > max_distance:
        return 0
    best = face_of_graph(core, first_face, vertex_position, face_plane, local)
    if core.climbs == 0:
        most = real(-2.0)
        for face in range(first_face, first_face + face_count):
            along = aligned(face_plane[face], local)
            if along > most:
                first = face_first_corner[face]
                for corner in range(face_corner_count[face]):
                    if corner_vertex[first + corner] == deepest:
                        most = along
                        best = face
    if best < 0:
        return add_on_plane(candidates, world, 0, point, core.radius, origin, normal, max_distance)
    corners = face_corner_count[best]
    start = Int32(0)
    for corner in range(corners):
        if corner_vertex[face_first_corner[best] + corner] == deepest:
            start = Int32(corner)
    # If there are more corners than fit, some are left out at even intervals.
    kept = wp.min(corners, polygon.shape[1] // 2)
    first = face_first_corner[best]
    for i in range(kept):
        vertex = corner_vertex[first + (start + (i * corners) // kept) % corners]
        polygon[world, i] = core.position + core.frame * vertex_position[vertex]
    chosen = Index4(0, 1, 2, 3)
    if kept > MOST:
        chosen = widest_four(polygon, world, kept)
    count = Int32(0)
    for i in range(wp.min(kept, MOST)):
        count = add_on_plane(
            candidates, world, count, polygon[world, chosen[i]], core.radius, origin, normal, max_distance
        )
    return count
