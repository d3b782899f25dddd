"""The point of a shape's surface that is nearest to a point."""

import warp as wp

from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.triangles import (
    first_cursor,
    following_cursor,
    region_of,
    triangle_corners,
    triangle_from,
)
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, HULL, PLANE, ROUNDED, SPHERE

_TINY = real(1.0e-12)
# Largest difference of distances at which two triangles count as equally near [m].
_SAME = real(1.0e-9)


@func
def away_from(offset: Vector3, otherwise: Vector3) -> Vector3:
    """Unit vector along an offset; `otherwise` if the offset has no length."""
    length = wp.length(offset)
    return offset / length if length > _TINY else otherwise


@func
def sign_of(value: real) -> real:
    """-1 for negative values, 1 for all others."""
    return wp.where(value < 0.0, real(-1.0), real(1.0))


@func
def on_box(size: Vector3, point: Vector3):
    """Signed distance of a point from a box, and the outward normal there, in the frame of the box."""
    inside = Vector3(
        minimum(maximum(point[0], -size[0]), size[0]),
        minimum(maximum(point[1], -size[1]), size[1]),
        minimum(maximum(point[2], -size[2]), size[2]),
    )
    offset = point - inside
    distance = wp.length(offset)
    normal = Vector3(0.0, 0.0, 0.0)
    if distance > _TINY:
        normal = offset / distance
    else:
        axis = Int32(0)
        most = wp.abs(point[0]) - size[0]
        for other in range(1, 3):
            excess = wp.abs(point[other]) - size[other]
            if excess > most:
                most = excess
                axis = Int32(other)
        distance = most
        normal[axis] = sign_of(point[axis])
    return distance, normal


@func
def on_cylinder(radius: real, half: real, point: Vector3):
    """Signed distance of a point from a cylinder about z, and the outward normal there."""
    across = Vector3(point[0], point[1], 0.0)
    outward = away_from(across, Vector3(1.0, 0.0, 0.0))
    beside = wp.length(across) - radius
    above = wp.abs(point[2]) - half
    up = Vector3(0.0, 0.0, sign_of(point[2]))
    distance = maximum(beside, above)
    normal = wp.where(beside > above, outward, up)
    if beside > 0.0 and above > 0.0:
        distance = wp.sqrt(beside * beside + above * above)
        normal = (outward * beside + up * above) / distance
    return distance, normal


@func
def on_segment(a: Vector3, b: Vector3, point: Vector3) -> Vector3:
    """The point of a segment nearest to a point."""
    along = b - a
    share = wp.dot(point - a, along) / maximum(wp.dot(along, along), _TINY * _TINY)
    return a + along * minimum(maximum(share, 0.0), 1.0)


@func
def nearest_beside(a: Vector3, b: Vector3, point: Vector3, normal: Vector3, best: Vector3, least: real):
    """The nearest point of a face found so far and its distance, updated with the edge from a to b.

    Only edges that the point is outside of count. The distance is -1 as long as there was none.
    """
    nearest = best
    distance = least
    if wp.dot(wp.cross(b - a, point - a), normal) < 0.0:
        place = on_segment(a, b, point)
        apart = wp.length(place - point)
        if least < 0.0 or apart < least:
            nearest = place
            distance = apart
    return nearest, distance


@func
def on_face(shapes: Shapes, face: Int32, point: Vector3, height: real) -> Vector3:
    """The point of a polyhedron's face nearest to a point `height` above its plane, in the shape frame."""
    plane = shapes.face_plane[face]
    normal = Vector3(plane[0], plane[1], plane[2])
    best = point - normal * height
    least = real(-1.0)
    first = shapes.face_first_corner[face]
    count = shapes.face_corner_count[face]
    for corner in range(count):
        a = shapes.vertex_position[shapes.corner_vertex[first + corner]]
        b = shapes.vertex_position[shapes.corner_vertex[first + (corner + 1) % count]]
        best, least = nearest_beside(a, b, point, normal, best, least)
    return best


@func
def on_hull(shapes: Shapes, shape: Int32, point: Vector3, max_distance: real):
    """Signed distance of a point from a convex hull, and the outward normal there, in the shape frame.

    A distance beyond `max_distance` is a lower bound.
    """
    first = shapes.shape_first_face[shape]
    last = first + shapes.shape_face_count[shape]
    distance = real(-1.0e18)
    normal = Vector3(0.0, 0.0, 1.0)
    for face in range(first, last):
        plane = shapes.face_plane[face]
        outward = Vector3(plane[0], plane[1], plane[2])
        height = wp.dot(outward, point) - plane[3]
        if height > distance:
            distance = height
            normal = outward
    if distance > 0.0 and distance <= max_distance:
        # If the point is not right above the face with the largest height, the nearest point may be on an
        # edge or on another face.
        least = real(1.0e18)
        for face in range(first, last):
            plane = shapes.face_plane[face]
            outward = Vector3(plane[0], plane[1], plane[2])
            height = wp.dot(outward, point) - plane[3]
            if height > 0.0:
                offset = point - on_face(shapes, face, point, height)
                if wp.length(offset) < least:
                    least = wp.length(offset)
                    normal = away_from(offset, outward)
        distance = least
    return distance, normal


@func
def rounding_of(shapes: Shapes, world: Int32, shape: Int32) -> real:
    """Radius by which a hull is rounded [m]; 0 where its margin is Bullet's, which is not a part of it."""
    return shapes.shape_margin[world, shape] if shapes.shape_columns[shape] == ROUNDED else real(0.0)


@func
def face_normal(corners: Matrix3) -> Vector3:
    """The unit normal of a triangle, its corners as columns."""
    a = column(corners, 0)
    return away_from(wp.cross(column(corners, 1) - a, column(corners, 2) - a), Vector3(0.0, 0.0, 1.0))


@func
def on_triangle(corners: Matrix3, point: Vector3, normal: Vector3) -> Vector3:
    """The point of a triangle, its corners as columns, nearest to a point."""
    best = point - normal * wp.dot(point - column(corners, 0), normal)
    least = real(-1.0)
    for corner in range(3):
        a = column(corners, corner)
        b = column(corners, (corner + 1) % 3)
        best, least = nearest_beside(a, b, point, normal, best, least)
    return best


@func
def on_surface(shapes: Shapes, world: Int32, shape: Int32, point: Vector3, max_distance: real):
    """Signed distance of a point from a mesh or height field, and the normal there, in the shape frame.

    A point behind the nearest triangle is inside. A distance beyond `max_distance` has no meaning.
    """
    around = Vector3(max_distance, max_distance, max_distance)
    region = region_of(shapes, world, shape, point - around, point + around)
    distance = max_distance + 1.0
    least = max_distance + 0.0
    facing = real(0.0)
    normal = Vector3(0.0, 0.0, 1.0)
    cursor = triangle_from(shapes, region, shape, first_cursor(shapes, shape))
    while cursor >= 0:
        corners = triangle_corners(shapes, region, shape, cursor)
        outward = face_normal(corners)
        offset = point - on_triangle(corners, point, outward)
        apart = wp.length(offset)
        side = wp.dot(offset, outward)
        # If the nearest point is on an edge of two triangles, the one that faces the point more directly
        # decides the side.
        if apart < least - _SAME or (apart <= least + _SAME and wp.abs(side) > facing):
            least = minimum(apart, least)
            facing = wp.abs(side)
            distance = apart * sign_of(side)
            normal = away_from(offset * sign_of(side), outward)
        cursor = triangle_from(shapes, region, shape, following_cursor(shapes, shape, cursor))
    return distance, normal


@func
def nearest_on_shape(
    shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, point: Vector3, max_distance: real
):
    """Signed distance of a point from a shape, negative inside, and the outward unit normal, in world axes.

    A result beyond `max_distance` [m] is not exact, only larger than this.
    """
    frame = pairs.shape_frame[world, shape]
    local = wp.transpose(frame) * (point - pairs.shape_position[world, shape])
    size = shapes.shape_size[world, shape]
    kind = shapes.shape_kind[shape]
    distance = max_distance + 1.0
    normal = Vector3(0.0, 0.0, 1.0)
    if kind == PLANE:
        distance = wp.dot(size, local)
        normal = size
    elif kind == SPHERE:
        distance = wp.length(local) - size[0]
        normal = away_from(local, Vector3(0.0, 0.0, 1.0))
    elif kind == CAPSULE:
        core = Vector3(0.0, 0.0, minimum(maximum(local[2], -size[1]), size[1]))
        distance = wp.length(local - core) - size[0]
        normal = away_from(local - core, Vector3(1.0, 0.0, 0.0))
    elif kind == BOX:
        distance, normal = on_box(size, local)
    elif kind == CYLINDER:
        distance, normal = on_cylinder(size[0], size[1], local)
    elif kind == HULL:
        rounding = rounding_of(shapes, world, shape)
        distance, normal = on_hull(shapes, shape, local, max_distance + rounding)
        distance -= rounding
    else:
        distance, normal = on_surface(shapes, world, shape, local, max_distance)
    return distance, frame * normal
