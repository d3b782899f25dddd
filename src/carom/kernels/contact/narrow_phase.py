"""Narrow phase: contact candidates of a pair of shapes, by the kinds of the two."""

import warp as wp

from carom.kernels.contact.bounds import local_center, magnitudes
from carom.kernels.contact.candidates import add_candidate, flip_candidates, keep_four
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.balls import collide_ball
from carom.kernels.shapes.box_faces import box_face_points
from carom.kernels.shapes.boxes import APART, EDGES, FACE_A, box_axis, box_edge_point
from carom.kernels.shapes.convex import collide_convex, face_towards
from carom.kernels.shapes.cores import Core, core_of, half_extents, segment_half, toward
from carom.kernels.shapes.hull_on_plane import collide_hull_on_plane
from carom.kernels.shapes.planes import (
    collide_cylinder_on_plane,
    collide_plane,
    collide_plane_deepest,
    with_sharp_edges,
)
from carom.kernels.shapes.segments import collide_segments
from carom.kernels.shapes.surfaces import collide_surface
from carom.kernels.shapes.terrain import collide_terrain
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, ELLIPSOID, HEIGHTFIELD, HULL, PLANE, SPHERE, TRIANGLES
from carom.layouts.parallel import MAX_CANDIDATES

# Far more than rounding of positions, and nothing beside a contact margin [m].
_ROUNDING = real(1e-9)


@func
def has_yielding_contacts(shapes: Shapes, world: Int32, shape: Int32) -> bool:
    """Whether contacts of a shape's link yield as MuJoCo's; see `kernels.dynamics.contact_compliance`."""
    return shapes.shape_impedance[world, shape][1] > 0.0


@func
def most_points(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> Int32:
    """In how many points two shapes touch at most; if contacts yield, some in as many as MuJoCo's.

    These are two boxes, and what is on height fields.
    """
    kind_a, kind_b = shapes.shape_kind[a], shapes.shape_kind[b]
    most = Int32(4)
    if (kind_a == BOX and kind_b == BOX) or kind_a == HEIGHTFIELD or kind_b == HEIGHTFIELD:
        if both_yield(shapes, world, a, b):
            most = Int32(MAX_CANDIDATES)
    return most


@func
def both_yield(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> bool:
    """Whether contacts of both shapes yield as MuJoCo's."""
    return has_yielding_contacts(shapes, world, a) and has_yielding_contacts(shapes, world, b)


@func
def box_gap(
    frame_a: Matrix3, half_a: Vector3, frame_b: Matrix3, half_b: Vector3, offset: Vector3, normal: Vector3
) -> real:
    """Distance of two boxes along a normal, from b to a; `offset` is from the centre of b to that of a."""
    reach = wp.dot(wp.abs(wp.transpose(frame_a) * normal), half_a)
    reach += wp.dot(wp.abs(wp.transpose(frame_b) * normal), half_b)
    return wp.dot(offset, normal) - reach


@func
def collide_boxes(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, max_distance: real, most: Int32
) -> Int32:
    """Write the candidates of two boxes, whose edges are sharp, at most `most`, 4 or 8."""
    frame_a = pairs.shape_frame[world, a]
    frame_b = pairs.shape_frame[world, b]
    half_a = shapes.shape_size[world, a]
    half_b = shapes.shape_size[world, b]
    position_a = pairs.shape_position[world, a]
    position_b = pairs.shape_position[world, b]
    code, normal, gap = box_axis(frame_a, half_a, frame_b, half_b, position_b - position_a, max_distance)
    if code == APART:
        return 0
    if code >= EDGES:
        point_b = box_edge_point(frame_a, half_a, frame_b, half_b, position_a, position_b, code, normal)
        if both_yield(shapes, world, a, b):
            # Those of other boxes are deeper by what Bullet adds to their extents.
            gap = box_gap(frame_a, half_a, frame_b, half_b, position_a - position_b, normal)
            if gap > max_distance:
                return 0
        return add_candidate(pairs.candidate, world, 0, point_b, normal, gap)
    if code == FACE_A:
        return box_face_points(
            frame_a, half_a, position_a, -normal, frame_b, half_b, position_b, 1, max_distance, most,
            pairs.polygon_a, pairs.polygon_clipped, pairs.candidate, world,
        )  # fmt: skip
    return box_face_points(
        frame_b, half_b, position_b, normal, frame_a, half_a, position_a, 0, max_distance, most,
        pairs.polygon_a, pairs.polygon_clipped, pairs.candidate, world,
    )  # fmt: skip


@func
def collide_simple(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, core_a: Core, max_distance: real
) -> Int32:
    """Write the candidates of a pair in the order of `in_order` whose nearest points have a closed form.

    `max_distance` is the largest distance of a contact [m]. Returns the number of candidates; -1 if the pair
    has no such closed form.
    """
    kind_a = core_a.kind
    kind_b = shapes.shape_kind[b]
    count = Int32(-1)
    if kind_b == PLANE:
        normal = pairs.shape_frame[world, b] * shapes.shape_size[world, b]
        sharp = with_sharp_edges(core_a)
        if kind_a == CYLINDER and has_yielding_contacts(shapes, world, a):
            return collide_cylinder_on_plane(
                core_a, pairs.shape_position[world, b], normal, max_distance, pairs.candidate,
                world,
            )  # fmt: skip
        if core_a.kind == ELLIPSOID:
            return collide_plane_deepest(
                core_a, shapes.vertex_position, pairs.shape_position[world, b], normal, max_distance,
                pairs.candidate, world,
            )  # fmt: skip
        if kind_a == HULL and has_yielding_contacts(shapes, world, a):
            return collide_hull_on_plane(
                core_a, shapes.shape_first_face[a], shapes.shape_face_count[a], shapes.vertex_position,
                shapes.face_plane, shapes.face_first_corner, shapes.face_corner_count, shapes.corner_vertex,
                pairs.shape_position[world, b], normal, max_distance, pairs.polygon_a, pairs.candidate, world,
            )  # fmt: skip
        corners = Int32(0)
        if kind_a != HULL:
            _normal, corners = face_towards(shapes, sharp, a, -normal, pairs.polygon_a, world)
        count = collide_plane(
            sharp, pairs.polygon_a, corners, shapes.vertex_position, pairs.shape_position[world, b],
            normal, max_distance, pairs.candidate, world,
        )  # fmt: skip
    elif (kind_a == SPHERE or kind_a == CAPSULE) and (kind_b == SPHERE or kind_b == CAPSULE):
        core_b = core_of(shapes, pairs, world, b)
        count = collide_segments(
            core_a.position, segment_half(core_a), core_a.radius,
            core_b.position, segment_half(core_b), core_b.radius,
            max_distance, pairs.candidate, world,
        )  # fmt: skip
    elif kind_a == SPHERE and (kind_b == BOX or kind_b == CYLINDER):
        core_b = core_of(shapes, pairs, world, b)
        count = collide_ball(core_a.position, core_a.radius, core_b, max_distance, pairs.candidate, world)
    return count


@func
def gap_of_boxes(shapes: Shapes, core_a: Core, core_b: Core, a: Int32, b: Int32):
    """The largest gap between the boxes around two convex shapes along a normal of their faces [m].

    Negative if they overlap along all. The second result is that normal, from b towards a.
    """
    half_a, half_b = half_extents(core_a), half_extents(core_b)
    turned = wp.transpose(core_a.frame)
    turn = turned * core_b.frame
    room = magnitudes(turn)
    apart = turned * (core_b.position - core_a.position)
    apart += turn * local_center(shapes, b) - local_center(shapes, a)
    along_b = wp.transpose(turn) * apart
    beside_a = wp.abs(apart) - half_a - room * half_b
    beside_b = wp.abs(along_b) - half_b - wp.transpose(room) * half_a
    axis_a, axis_b = greatest_entry(beside_a), greatest_entry(beside_b)
    gap = beside_a[axis_a]
    normal = column(core_a.frame, axis_a) * -toward(apart[axis_a], 1.0)
    if beside_b[axis_b] > gap:
        gap = beside_b[axis_b]
        normal = column(core_b.frame, axis_b) * -toward(along_b[axis_b], 1.0)
    return gap, normal


@func
def greatest_entry(vector: Vector3) -> Int32:
    """The index of the first of the greatest entries of a vector."""
    index = wp.where(vector[1] > vector[0], Int32(1), Int32(0))
    return wp.where(vector[2] > vector[index], Int32(2), index)


@func
def collide_in_order(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    max_distance: real,
    around: real,
    last_normal: Vector3,
) -> Int32:
    """Write the candidates of two shapes that are in the order of `in_order`."""
    kind_a = shapes.shape_kind[a]
    kind_b = shapes.shape_kind[b]
    if kind_a == PLANE or kind_a >= TRIANGLES:
        # Surfaces and planes make no contacts with each other.
        return 0
    if kind_a == BOX and kind_b == BOX:
        return collide_boxes(shapes, pairs, world, a, b, max_distance, most_points(shapes, world, a, b))
    core_a = core_of(shapes, pairs, world, a)
    if kind_b == HEIGHTFIELD and both_yield(shapes, world, a, b):
        return collide_terrain(shapes, pairs, world, a, b, core_a, max_distance, around)
    if kind_b >= TRIANGLES:
        return collide_surface(shapes, pairs, world, a, b, core_a, max_distance, around)
    count = collide_simple(shapes, pairs, world, a, b, core_a, max_distance)
    if count >= 0:
        return count
    core_b = core_of(shapes, pairs, world, b)
    gap, normal = gap_of_boxes(shapes, core_a, core_b, a, b)
    if gap > max_distance + _ROUNDING:
        return 0
    start = core_a.position - core_b.position
    if both_yield(shapes, world, a, b):
        # Bullet's points depend on where its search begins.
        start = normal
    return collide_convex(shapes, pairs, world, a, b, core_a, core_b, max_distance, 0, start, last_normal)


@func
def rank(kind: Int32) -> Int32:
    """Rank of a kind of shape in the order of the narrow phase: its code, but planes last."""
    if kind == PLANE:
        return 100
    return kind


@func
def in_order(shapes: Shapes, a: Int32, b: Int32):
    """Two shapes in the order that the narrow phase expects."""
    if rank(shapes.shape_kind[a]) > rank(shapes.shape_kind[b]):
        return b, a
    return a, b


@func
def collide_shapes(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    max_distance: real,
    around: real,
    last_normal: Vector3,
) -> Int32:
    """Write the candidates for two shapes at most `max_distance` [m] apart; returns their number.

    There are at most four, or as many as `most_points` says. Normals point from b towards a, as does the
    `last_normal` of shapes that overlapped in the last substep, or 0. Triangles are tested within the
    distance `around` [m] from the bounds of the convex shape.
    """
    first, second = in_order(shapes, a, b)
    turned = wp.where(first != a, -last_normal, last_normal)
    count = collide_in_order(shapes, pairs, world, first, second, max_distance, around, turned)
    if count > most_points(shapes, world, first, second):
        count = keep_four(pairs.candidate, world, count)
    if first != a:
        flip_candidates(pairs.candidate, world, count)
    return count
