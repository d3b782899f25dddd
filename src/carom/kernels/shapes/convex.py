"""Contacts of any two convex shapes: the normal from their nearest or deepest points, then all points."""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.maths.min_max import minimum
from carom.kernels.shapes.clip import clip_faces
from carom.kernels.shapes.cores import Core, support, toward
from carom.kernels.shapes.faces import arrange_box_corners, box_face, supporting_face
from carom.kernels.shapes.gjk import TOUCHING, nearest_points
from carom.kernels.shapes.last_normal import encloses_origin
from carom.kernels.shapes.polytope import overlap
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, Vector3, Vector3Rows, Vectors3, func, real
from carom.layouts.codes import BOX, ELLIPSOID

# A face lies on the other shape if the cosine of the angle between its normal and the contact's exceeds this.
FLAT_ON = real(0.999)
# The nearest point is added as a candidate if it is this much deeper than all others [m].
DEEPER = real(1.0e-6)


@func
def over_face(box: Core, other: Core, vertex_position: Vectors3):
    """Height of a core over the box face turned towards it, the face's normal, and the core's lowest point.

    If the projection of the lowest point onto the plane of the face lies in the face, these two points are
    the nearest points of core and box, and GJK is not needed: the usual case for a shape that rests on a
    table. Otherwise the height is 0.
    """
    offset = wp.transpose(box.frame) * (other.position - box.position)
    axis = Int32(0)
    most = wp.abs(offset[0]) - box.size[0]
    for candidate in range(1, 3):
        excess = wp.abs(offset[candidate]) - box.size[candidate]
        if excess > most:
            most = excess
            axis = Int32(candidate)
    normal = Vector3(0.0, 0.0, 0.0)
    normal[axis] = toward(offset[axis], 1.0)
    outward = box.frame * normal
    lowest = support(other, vertex_position, -outward)
    local = wp.transpose(box.frame) * (lowest - box.position)
    height = wp.dot(normal, local) - box.size[axis]
    beside = wp.abs(local) - box.size
    beside[axis] = real(-1.0)
    if beside[0] > 0.0 or beside[1] > 0.0 or beside[2] > 0.0:
        height = real(0.0)
    return height, outward, lowest


@func
def nearest_or_deepest(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    core_a: Core,
    core_b: Core,
    max_distance: real,
    start: Vector3,
    last_normal: Vector3,
):
    """Distance of two cores (negative: overlap), normal on b towards a, nearest points on a and on b.

    If the distance exceeds `max_distance`, it is a lower bound and the other results are meaningless. `start`
    is an approximate direction from b to a, `last_normal` that of sharp cores that overlapped just before,
    or 0.
    """
    if core_a.kind == BOX:
        height, outward, lowest = over_face(core_a, core_b, shapes.vertex_position)
        if height > TOUCHING:
            return height, -outward, lowest - outward * height, lowest
    elif core_b.kind == BOX:
        height, outward, lowest = over_face(core_b, core_a, shapes.vertex_position)
        if height > TOUCHING:
            return height, outward, lowest, lowest - outward * height
    is_sharp = core_a.radius + core_b.radius <= 0.0
    distance, corners = real(0.0), Int32(4)
    point_a = core_a.position
    point_b = core_b.position
    if not (
        is_sharp
        and wp.length_sq(last_normal) > 0.0
        and encloses_origin(
            core_a, core_b, shapes.vertex_position, pairs.polytope_point, pairs.polytope_point_a, world,
            last_normal,
        )
    ):  # fmt: skip
        distance, point_a, point_b, corners = nearest_points(
            core_a, core_b, shapes.vertex_position, start, max_distance, pairs.polytope_point,
            pairs.polytope_point_a, world,
        )  # fmt: skip
    normal = start
    if distance > TOUCHING:
        normal = (point_a - point_b) / wp.length(point_a - point_b)
    else:
        depth, normal, point_a, point_b = overlap(
            core_a, core_b, shapes.vertex_position, pairs.polytope_point, pairs.polytope_point_a,
            pairs.polytope_plane, pairs.polytope_face, pairs.polytope_edge, world, start, point_a,
            wp.where(is_sharp, corners, Int32(0)),
        )  # fmt: skip
        distance = -depth
    return distance, normal, point_a, point_b


@func
def face_towards(
    shapes: Shapes, core: Core, shape: Int32, direction: Vector3, polygon: Vector3Rows, world: Int32
):
    """Write the face of a core most aligned with `direction`; returns its normal and number of corners."""
    if core.kind == BOX:
        return box_face(core, direction, polygon, world), Int32(4)
    normal, count = supporting_face(
        core, shapes.shape_first_face[shape], shapes.shape_face_count[shape], shapes.vertex_position,
        shapes.face_plane, shapes.face_first_corner, shapes.face_corner_count, shapes.corner_vertex,
        direction, polygon, world,
    )  # fmt: skip
    return normal, count


@func
def collide_faces(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    core_a: Core,
    core_b: Core,
    normal: Vector3,
    max_distance: real,
    found: Int32,
) -> Int32:
    """Add the candidates of two faces lying on each other; none if neither is perpendicular to the normal."""
    normal_a, count_a = face_towards(shapes, core_a, a, -normal, pairs.polygon_a, world)
    normal_b, count_b = face_towards(shapes, core_b, b, normal, pairs.polygon_b, world)
    flat_a = 0.0 if count_a < 3 else -wp.dot(normal_a, normal)
    flat_b = 0.0 if count_b < 3 else wp.dot(normal_b, normal)
    count = found
    if flat_a >= flat_b and flat_a > FLAT_ON:
        if core_b.kind == BOX:
            arrange_box_corners(core_b, normal_b, pairs.polygon_b, world)
        count = clip_faces(
            core_a, pairs.polygon_a, count_a, normal_a, pairs.polygon_b, count_b, pairs.polygon_clipped,
            normal, 1, core_a.radius, core_b.radius, max_distance, pairs.candidate, world, found,
        )  # fmt: skip
    elif flat_b > FLAT_ON:
        if core_a.kind == BOX:
            arrange_box_corners(core_a, normal_a, pairs.polygon_a, world)
        count = clip_faces(
            core_b, pairs.polygon_b, count_b, normal_b, pairs.polygon_a, count_a, pairs.polygon_clipped,
            normal, 0, core_a.radius, core_b.radius, max_distance, pairs.candidate, world, found,
        )  # fmt: skip
    return count


@func
def collide_convex(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    core_a: Core,
    core_b: Core,
    max_distance: real,
    found: Int32,
    start: Vector3,
    last_normal: Vector3,
) -> Int32:
    """Add candidates of two cores at most `max_distance` apart to the first `found`; returns the number.

    `start` and `last_normal` are those of `nearest_or_deepest`.
    """
    rounding = core_a.radius + core_b.radius
    core_distance, normal, _point_a, point_b = nearest_or_deepest(
        shapes, pairs, world, core_a, core_b, max_distance + rounding, start, last_normal
    )
    distance = core_distance - rounding
    # Beyond the second the points are meaningless, and rounding may hide that from the first.
    if distance > max_distance or core_distance > max_distance + rounding:
        return found
    count = found + 0
    if core_a.kind != ELLIPSOID and core_b.kind != ELLIPSOID:
        count = collide_faces(shapes, pairs, world, a, b, core_a, core_b, normal, max_distance, found)
    deepest = distance + 2.0 * DEEPER
    for row in range(found, count):
        deepest = minimum(deepest, pairs.candidate[world, row].distance)
    if count == found or distance < deepest - DEEPER:
        count = add_candidate(
            pairs.candidate, world, count, point_b + normal * core_b.radius, normal, distance
        )
    return count
