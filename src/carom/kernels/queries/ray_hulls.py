"""Ray tests with convex hulls, four faces at a time.

A ray meets a hull between the last plane that it enters and the first that it leaves. Rays in scenes of
meshes spend most of their time with this search. So four planes are compared at once: the same operation on
four numbers takes one instruction (SIMD).
"""

import warp as wp

from carom.kernels.queries.ray_packets import maximum, minimum
from carom.kernels.queries.ray_solids import MISS, ray_from_margin
from carom.kernels.types import Int32, Vector3, Vector4, Vectors4, func, real, shared_func

# After so many faces a ray that leaves the hull before it enters is done.
STRIDE = 16
LOWEST = real(-1.0e30)


@func
def where_less(a: Vector4, b: Vector4, then: Vector4, otherwise: Vector4) -> Vector4:
    """In each lane, the number of `then` if a < b, that of `otherwise` if not."""
    return Vector4(
        wp.where(a[0] < b[0], then[0], otherwise[0]),
        wp.where(a[1] < b[1], then[1], otherwise[1]),
        wp.where(a[2] < b[2], then[2], otherwise[2]),
        wp.where(a[3] < b[3], then[3], otherwise[3]),
    )


@func
def least(numbers: Vector4) -> real:
    """The least number of all lanes."""
    return wp.min(wp.min(numbers[0], numbers[1]), wp.min(numbers[2], numbers[3]))


@func
def greatest(numbers: Vector4) -> real:
    """The greatest number of all lanes."""
    return wp.max(wp.max(numbers[0], numbers[1]), wp.max(numbers[2], numbers[3]))


@func
def nearest_face(face_plane: Vectors4, first_face: Int32, face_count: Int32, place: Vector3) -> Vector3:
    """Outward normal of the face of a hull that is nearest to a point inside the hull."""
    highest = real(LOWEST)
    nearest = Vector3(0.0, 0.0, 0.0)
    for face in range(first_face, first_face + face_count):
        plane = face_plane[face]
        outward = Vector3(plane[0], plane[1], plane[2])
        height = wp.dot(outward, place) - plane[3]
        if height > highest:
            highest = height
            nearest = outward
    return nearest


@func
def entry_face(enter: Vector4, faces: Vector4, last_entry: real) -> Int32:
    """The first of the faces whose planes the ray enters last; each lane has the first of its own."""
    candidates = where_less(enter, Vector4(last_entry), Vector4(-LOWEST), faces)
    return Int32(least(candidates))


@shared_func
def ray_hull(
    start: Vector3, way: Vector3, face_plane: Vectors4, first_face: Int32, face_count: Int32, margin: real
):
    """Ray against a convex polyhedron whose faces are moved outwards by `margin`."""
    enter = Vector4(-1.0)
    leave = Vector4(1.0)
    highest = Vector4(LOWEST)
    zero, one = Vector4(0.0), Vector4(1.0)
    faces = Vector4(0.0)
    end = first_face + face_count
    face = first_face + 0
    while face < end:
        # Where there are less than four faces left, the last one counts more than once.
        a = face_plane[face]
        b = face_plane[wp.min(face + 1, end - 1)]
        c = face_plane[wp.min(face + 2, end - 1)]
        d = face_plane[wp.min(face + 3, end - 1)]
        x = Vector4(a[0], b[0], c[0], d[0])
        y = Vector4(a[1], b[1], c[1], d[1])
        z = Vector4(a[2], b[2], c[2], d[2])
        distance = Vector4(a[3], b[3], c[3], d[3])
        height = x * start[0] + y * start[1] + z * start[2] - distance - Vector4(margin)
        slope = x * way[0] + y * way[1] + z * way[2]
        highest = maximum(highest, height)
        # Not a number, or infinite, in lanes where the ray is parallel to the plane; those do not use it.
        at = wp.cw_div(-height, slope)
        entering = where_less(slope, zero, at, Vector4(LOWEST))
        here = Vector4(real(face), real(face + 1), real(face + 2), real(face + 3))
        faces = where_less(enter, entering, here, faces)
        enter = maximum(entering, enter)
        outside = where_less(zero, height, Vector4(-2.0), one)
        leaving = where_less(slope, zero, one, where_less(zero, slope, at, outside))
        leave = minimum(leaving, leave)
        face += 4
        if (face - first_face) % STRIDE == 0:
            if greatest(enter) > least(leave):
                return real(MISS), Vector3(0.0, 0.0, 0.0)
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    height_of_start = greatest(highest)
    entry = greatest(enter)
    if height_of_start <= 0.0:
        if height_of_start >= -margin:
            fraction, normal = ray_from_margin(nearest_face(face_plane, first_face, face_count, start), way)
    elif entry >= 0.0 and entry <= least(leave):
        fraction = entry
        plane = face_plane[wp.min(entry_face(enter, faces, entry), end - 1)]
        normal = Vector3(plane[0], plane[1], plane[2])
    return fraction, normal
