"""Penetration depth of two overlapping cores: the expanding polytope algorithm (EPA).

The Minkowski difference of two overlapping cores, the set of all differences a - b of their points, contains
the origin. A polytope inside this set is expanded at its face nearest to the origin until this face is on the
boundary of the set. Then the distance of the face is the smallest translation that separates the cores, and
the normal of the face is its direction.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum
from carom.kernels.shapes.cores import Core, support
from carom.kernels.shapes.gjk import triangle_weights
from carom.kernels.shapes.segments import any_perpendicular
from carom.kernels.types import (
    Index4,
    Index4Rows,
    Int32,
    Vector3,
    Vector3Rows,
    Vector4,
    Vector4Rows,
    Vectors3,
    func,
    real,
    shared_func,
)
from carom.layouts.contacts import MAX_CORNERS

# A face is on the boundary if the boundary is at most this far beyond it [m], as in Bullet: at the rim of a
# cylinder the deepest point is as inexact as the square root of this is. Both are for differences up to 1 m,
# and grow with these, since rounding does.
PRECISION = real(1.0e-12)
# A face is removed if a new corner is more than this above its plane [m]; less than `PRECISION`.
VISIBLE = real(1.0e-13)
# A point is in a face if it is at most this far from the face [m].
ON_FACE = real(1.0e-9)
# A Minkowski difference at most this thick has no inside [m].
THIN = real(1.0e-10)
# Distance assigned to faces without area, so that they are never the nearest.
NEVER = real(1.0e30)


@func
def add_corner(
    core_a: Core,
    core_b: Core,
    vertex_position: Vectors3,
    points: Vector3Rows,
    points_a: Vector3Rows,
    world: Int32,
    row: Int32,
    direction: Vector3,
) -> Vector3:
    """Add the farthest point of the Minkowski difference along `direction` as a corner."""
    on_a = support(core_a, vertex_position, direction)
    w = on_a - support(core_b, vertex_position, -direction)
    points[world, row] = w
    points_a[world, row] = on_a
    return w


@func
def axis_direction(side: Int32, x: Vector3, y: Vector3, z: Vector3) -> Vector3:
    """Direction number `side` of x, -x, y, -y, z, -z, counted from 0."""
    direction = x if side < 2 else y if side < 4 else z
    return -direction if side % 2 == 1 else direction


@func
def add_face(
    points: Vector3Rows,
    planes: Vector4Rows,
    faces: Index4Rows,
    world: Int32,
    row: Int32,
    i: Int32,
    j: Int32,
    k: Int32,
):
    """Write a face and its plane; the corners are counter-clockwise as seen from outside."""
    a = points[world, i]
    normal = wp.cross(points[world, j] - a, points[world, k] - a)
    length = wp.length(normal)
    plane = Vector4(0.0, 0.0, 0.0, NEVER)
    if length > 0.0:
        normal = normal / length
        plane = Vector4(normal[0], normal[1], normal[2], wp.dot(normal, a))
    planes[world, row] = plane
    faces[world, row] = Index4(i, j, k, 0)


@func
def plane_height(plane: Vector4, point: Vector3) -> real:
    """Height of a point above a plane."""
    return plane[0] * point[0] + plane[1] * point[1] + plane[2] * point[2] - plane[3]


@func
def add_hole_edge(edges: Index4Rows, world: Int32, count: Int32, i: Int32, j: Int32) -> Int32:
    """Update the edges of the hole with an edge of a removed face; returns the number of edges.

    An edge between two removed faces is not an edge of the hole.
    """
    for row in range(count):
        edge = edges[world, row]
        if edge[0] == j and edge[1] == i:
            edges[world, row] = edges[world, count - 1]
            return count - 1
    if count < edges.shape[1]:
        edges[world, count] = Index4(i, j, 0, 0)
        return count + 1
    return count


@shared_func
def first_tetrahedron(
    core_a: Core,
    core_b: Core,
    vertex_position: Vectors3,
    points: Vector3Rows,
    points_a: Vector3Rows,
    world: Int32,
    start: Vector3,
):
    """Find four corners that span a volume.

    Returns:
        Number of corners, and a direction. If there are less than four, the Minkowski difference is flat and
        has no extent in this direction.
    """
    x = Vector3(1.0, 0.0, 0.0)
    y = Vector3(0.0, 1.0, 0.0)
    z = Vector3(0.0, 0.0, 1.0)
    line = x
    first = add_corner(core_a, core_b, vertex_position, points, points_a, world, 0, start)
    row = Int32(1)
    while row < 4:
        # Of 6, 4 and 2 directions, the one with the corner farthest from the corners so far.
        most = THIN
        best = Int32(-1)
        for side in range(8 - 2 * row):
            direction = axis_direction(side, x, y, z)
            w = add_corner(core_a, core_b, vertex_position, points, points_a, world, row, direction) - first
            away = wp.abs(wp.dot(w, x))
            if row == 1:
                away = wp.length(w)
            elif row == 2:
                away = wp.length(wp.cross(w, line))
            if away > most:
                most = away
                best = side
        if best < 0:
            return row, start if row == 1 else x
        direction = axis_direction(best, x, y, z)
        w = add_corner(core_a, core_b, vertex_position, points, points_a, world, row, direction) - first
        if row == 1:
            line = wp.normalize(w)
            x = any_perpendicular(line)
            y = wp.cross(line, x)
        elif row == 2:
            x = wp.normalize(wp.cross(line, w))
        row += 1
    return row, x


@func
def nearest_face(planes: Vector4Rows, world: Int32, face_count: Int32) -> Int32:
    """Face whose plane is nearest to the origin."""
    nearest = Int32(0)
    least = planes[world, 0][3]
    for face in range(1, face_count):
        distance = planes[world, face][3]
        if distance < least:
            least = distance
            nearest = face
    return nearest


@func
def point_in_face(points: Vector3Rows, points_a: Vector3Rows, world: Int32, corners: Index4, foot: Vector3):
    """Point of core a for the point of a face nearest to `foot`, and the squared distance from `foot`."""
    p = points[world, corners[0]] - foot
    q = points[world, corners[1]] - foot
    r = points[world, corners[2]] - foot
    weights = triangle_weights(p, q, r)
    on_a = (
        points_a[world, corners[0]] * weights[0]
        + points_a[world, corners[1]] * weights[1]
        + points_a[world, corners[2]] * weights[2]
    )
    return on_a, wp.length_sq(p * weights[0] + q * weights[1] + r * weights[2])


@func
def deepest_point(
    points: Vector3Rows,
    points_a: Vector3Rows,
    faces: Index4Rows,
    world: Int32,
    corners: Index4,
    face_count: Int32,
    foot: Vector3,
) -> Vector3:
    """Point of core a for `foot`, the boundary point of the Minkowski difference nearest to the origin.

    `foot` is in the face with these corners, or in another face in the same plane.
    """
    on_a, miss = point_in_face(points, points_a, world, corners, foot)
    if miss > ON_FACE * ON_FACE:
        for face in range(face_count):
            other, distance_sq = point_in_face(points, points_a, world, faces[world, face], foot)
            if distance_sq < miss:
                miss = distance_sq
                on_a = other
    return on_a


@shared_func
def overlap(
    core_a: Core,
    core_b: Core,
    vertex_position: Vectors3,
    points: Vector3Rows,
    points_a: Vector3Rows,
    planes: Vector4Rows,
    faces: Index4Rows,
    edges: Index4Rows,
    world: Int32,
    start: Vector3,
    common: Vector3,
    known: Int32,
):
    """Penetration depth: the smallest translation that separates two overlapping cores.

    The arrays of the polytope are workspace, see `Pairs`. `start` is an approximate direction from b to a,
    `common` a point that is in both cores. The `known` first corners are there already: 4, as
    `gjk.nearest_points` leaves them, or 0.

    Returns:
        The depth [m], the unit normal from b towards a, and the deepest points of a and of b. The normal is
        0 if the cores overlap by 1e30 m or more.
    """
    direction = Vector3(0.0, 0.0, 1.0) if wp.length_sq(start) == 0.0 else start
    count, flat = known + 0, start + Vector3(0.0, 0.0, 0.0)
    if known < 4:
        count, flat = first_tetrahedron(core_a, core_b, vertex_position, points, points_a, world, direction)
    if count < 4:
        normal = wp.normalize(flat)
        if wp.dot(normal, start) < 0.0:
            normal = -normal
        return real(0.0), normal, common, common
    w0 = points[world, 0]
    if wp.dot(wp.cross(points[world, 1] - w0, points[world, 2] - w0), points[world, 3] - w0) > 0.0:
        # Corners 0, 1, 2 must be counter-clockwise as seen from outside, the side away from corner 3.
        w = points[world, 1]
        points[world, 1] = points[world, 2]
        points[world, 2] = w
        on_a = points_a[world, 1]
        points_a[world, 1] = points_a[world, 2]
        points_a[world, 2] = on_a
    scale = real(1.0)
    for row in range(4):
        scale = maximum(scale, wp.length(points[world, row]))
    add_face(points, planes, faces, world, 0, 0, 1, 2)
    add_face(points, planes, faces, world, 1, 0, 3, 1)
    add_face(points, planes, faces, world, 2, 1, 3, 2)
    add_face(points, planes, faces, world, 3, 2, 3, 0)
    face_count = Int32(4)
    nearest = nearest_face(planes, world, face_count)
    # A translation in any direction separates the cores if it is long enough. The shortest one found is kept,
    # so that the result is valid even if rounding or a lack of space spoils the polytope.
    depth = real(NEVER)
    outward = Vector3(0.0, 0.0, 0.0)
    corners = faces[world, nearest]
    growing = Int32(1)
    while growing == 1 and count < MAX_CORNERS:
        plane = planes[world, nearest]
        normal = Vector3(plane[0], plane[1], plane[2])
        w = add_corner(core_a, core_b, vertex_position, points, points_a, world, count, normal)
        if wp.dot(w, normal) < depth:
            depth = wp.dot(w, normal)
            outward = normal
            corners = faces[world, nearest]
        if plane_height(plane, w) <= PRECISION * scale:
            growing = Int32(0)
        else:
            edge_count, kept = Int32(0), Int32(0)
            for face in range(face_count):
                seen = faces[world, face]
                if plane_height(planes[world, face], w) > VISIBLE * scale:
                    edge_count = add_hole_edge(edges, world, edge_count, seen[0], seen[1])
                    edge_count = add_hole_edge(edges, world, edge_count, seen[1], seen[2])
                    edge_count = add_hole_edge(edges, world, edge_count, seen[2], seen[0])
                else:
                    planes[world, kept] = planes[world, face]
                    faces[world, kept] = seen
                    kept += 1
            if kept + edge_count > faces.shape[1]:
                growing = Int32(0)
            for row in range(wp.min(edge_count, faces.shape[1] - kept)):
                edge = edges[world, row]
                add_face(points, planes, faces, world, kept + row, edge[0], edge[1], count)
            face_count = wp.min(kept + edge_count, faces.shape[1])
            count += 1
            nearest = nearest_face(planes, world, face_count)
    on_a = deepest_point(points, points_a, faces, world, corners, face_count, outward * depth)
    return depth, -outward, on_a, on_a - outward * depth
