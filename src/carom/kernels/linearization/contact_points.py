"""With which of their features shapes touch, and how contacts move with the dofs.

How a contact moves is known exactly where a ball, the end of a capsule, or a corner touches a plane or a
face, where two balls touch, and where a contact has been kept from a step before: whatever touches there. Of
others the host measures it, see `linearization.measured`.
"""

import warp as wp

from carom.kernels.linearization.dof_motion import point_motion
from carom.kernels.structs import Shapes, State, StepBatch, StepSpace, TouchingLinks
from carom.kernels.types import Int32, Transform, Vector3, func, real
from carom.layouts.codes import BOX, CAPSULE, ELLIPSOID_FACETS, HULL, PLANE, SPHERE
from carom.layouts.linearization import MOVES_A, MOVES_B, WANTED

# Distance [m], and difference of unit vectors, that count as none.
_NONE = wp.constant(real(1.0e-7))
# Points of a new contact are on a line along the normal; those of a kept one have moved off it by more [m].
_KEPT = wp.constant(real(1.0e-9))
_HALF_ROOT = wp.constant(real(0.7071067811865476))


@func
def shape_frame(state: State, shapes: Shapes, world: Int32, shape: Int32) -> Transform:
    """World pose of a shape."""
    return wp.transform_multiply(state.link_pose[world, shapes.shape_link[shape]], shapes.shape_pose[shape])


@func
def greatest_of(v: Vector3) -> real:
    """The greatest component without signs."""
    return wp.max(wp.max(wp.abs(v[0]), wp.abs(v[1])), wp.abs(v[2]))


@func
def is_corner(shapes: Shapes, world: Int32, shape: Int32, local: Vector3, radius: real) -> bool:
    """Whether a point in the shape frame is a corner of a box, a hull or a capsule's core.

    `radius` is the part of a box by which its corners are rounded.
    """
    kind = shapes.shape_kind[shape]
    size = shapes.shape_size[world, shape]
    off = real(1.0)
    if kind == CAPSULE:
        off = greatest_of(Vector3(local[0], local[1], wp.abs(local[2]) - size[1]))
    elif kind == BOX:
        margins = Vector3(radius, radius, radius)
        off = greatest_of(Vector3(wp.abs(local[0]), wp.abs(local[1]), wp.abs(local[2])) - (size - margins))
    elif shapes.shape_columns[shape] != ELLIPSOID_FACETS:
        first = shapes.shape_first_vertex[shape]
        for vertex in range(first, first + shapes.shape_vertex_count[shape]):
            off = wp.min(off, greatest_of(shapes.vertex_position[vertex] - local))
    return off < _NONE


@func
def touching_radius(
    state: State, shapes: Shapes, world: Int32, shape: Int32, point: Vector3, outward: Vector3
) -> real:
    """The radius of the ball around a point of its link with which a shape touches; -1 for other features.

    Args:
        state: The state.
        shapes: The shapes.
        world: The world.
        shape: The shape.
        point: The point of contact on it, in world axes.
        outward: The normal, towards the shape.
    """
    kind = shapes.shape_kind[shape]
    if kind == SPHERE:
        return shapes.shape_size[world, shape][0]
    found = real(-1.0)
    if kind == CAPSULE or kind == BOX or kind == HULL:
        to_shape = wp.transform_inverse(shape_frame(state, shapes, world, shape))
        radius = wp.where(kind == CAPSULE, shapes.shape_size[world, shape][0], real(0.0))
        if is_corner(shapes, world, shape, wp.transform_point(to_shape, point + radius * outward), radius):
            found = radius
        elif kind != CAPSULE:
            margin = shapes.shape_margin[world, shape]
            if is_corner(
                shapes, world, shape, wp.transform_point(to_shape, point + margin * outward), margin
            ):
                found = margin
    return found


@func
def touches_with_face(state: State, shapes: Shapes, world: Int32, shape: Int32, normal: Vector3) -> bool:
    """Whether a normal, away from a shape, is that of a face of the shape."""
    kind = shapes.shape_kind[shape]
    if kind == PLANE:
        return True
    turn = wp.transform_get_rotation(shape_frame(state, shapes, world, shape))
    local = wp.quat_rotate_inv(turn, normal)
    off = real(1.0)
    if kind == BOX:
        off = 1.0 - greatest_of(local)
    elif kind == HULL and shapes.shape_columns[shape] != ELLIPSOID_FACETS:
        first = shapes.shape_first_face[shape]
        for face in range(first, first + shapes.shape_face_count[shape]):
            plane = shapes.face_plane[face]
            off = wp.min(off, greatest_of(Vector3(plane[0], plane[1], plane[2]) - local))
    return off < _NONE


@func
def move_balls(
    space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks, radius_a: real, radius_b: real
):
    """Write how the contact of two balls moves."""
    n = space.dofs
    centre_a = touch.point_a + radius_a * touch.normal
    centre_b = touch.point_b - radius_b * touch.normal
    apart = wp.length(centre_a - centre_b)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        moved_a = Vector3(0.0, 0.0, 0.0)
        moved_b = Vector3(0.0, 0.0, 0.0)
        if steps.reach_side[entry] & MOVES_A != 0:
            moved_a = point_motion(steps, entry, centre_a)
        if steps.reach_side[entry] & MOVES_B != 0:
            moved_b = point_motion(steps, entry, centre_b)
        across = moved_a - moved_b
        turned = (across - wp.dot(touch.normal, across) * touch.normal) / apart
        steps.turned[3 * place * n + dof] = turned
        steps.moved_a[entry] = moved_a - radius_a * turned
        steps.moved_b[entry] = moved_b + radius_b * turned


@func
def move_on_face(
    space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks, radius: real, face_is_a: bool
):
    """Write how the contact of a ball around a point of one link with a face of the other one moves."""
    n = space.dofs
    normal = touch.normal
    sign = wp.where(face_is_a, real(-1.0), real(1.0))
    core = wp.where(face_is_a, touch.point_b, touch.point_a)
    on_face = wp.where(face_is_a, touch.point_a, touch.point_b)
    side_of_core = wp.where(face_is_a, Int32(MOVES_B), Int32(MOVES_A))
    side_of_face = wp.where(face_is_a, Int32(MOVES_A), Int32(MOVES_B))
    core += sign * radius * normal
    gap = wp.dot(touch.point_a - touch.point_b, normal)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        moved = Vector3(0.0, 0.0, 0.0)
        beside = Vector3(0.0, 0.0, 0.0)
        turned = Vector3(0.0, 0.0, 0.0)
        if steps.reach_side[entry] & side_of_core != 0:
            moved = point_motion(steps, entry, core)
        if steps.reach_side[entry] & side_of_face != 0:
            beside = point_motion(steps, entry, on_face)
            turned = wp.cross(steps.axis_angular[entry], normal)
        parting = wp.dot(normal, moved - beside)
        moved -= sign * radius * turned
        # The point on the face is the projection of the other one.
        projected = moved - parting * normal - sign * gap * turned
        steps.turned[3 * place * n + dof] = turned
        if face_is_a:
            steps.moved_a[entry] = projected
            steps.moved_b[entry] = moved
        else:
            steps.moved_a[entry] = moved
            steps.moved_b[entry] = projected


@func
def move_kept(space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks):
    """Write how a kept contact moves: its points with their links, while the normal stays."""
    n = space.dofs
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        moved_a = Vector3(0.0, 0.0, 0.0)
        moved_b = Vector3(0.0, 0.0, 0.0)
        if steps.reach_side[entry] & MOVES_A != 0:
            moved_a = point_motion(steps, entry, touch.point_a)
        if steps.reach_side[entry] & MOVES_B != 0:
            moved_b = point_motion(steps, entry, touch.point_b)
        steps.moved_a[entry] = moved_a
        steps.moved_b[entry] = moved_b
        steps.turned[3 * place * n + dof] = Vector3(0.0, 0.0, 0.0)


@func
def move_as_measured(space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks) -> bool:
    """Write how a contact moves as the host has measured it, or ask for that; returns whether it is known."""
    n = space.dofs
    own = place * space.most_contacts + touch.contact
    slot = steps.measured[own]
    if slot < 0:
        steps.measured[own] = WANTED
        return False
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        first = 3 * (slot * n + dof)
        steps.moved_a[place * n + dof] = steps.measured_motion[first]
        steps.moved_b[place * n + dof] = steps.measured_motion[first + 1]
        steps.turned[3 * place * n + dof] = steps.measured_motion[first + 2]
    return True


@func
def turn_directions(space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks):
    """Write how the friction directions turn with the normal."""
    n = space.dofs
    normal, first = touch.normal, touch.direction1
    # The first is perpendicular to the normal and to an axis, so it turns about that axis.
    axis = Vector3(0.0, 0.0, 1.0)
    if wp.abs(normal[2]) > _HALF_ROOT:
        axis = Vector3(1.0, 0.0, 0.0)
    across = wp.cross(axis, normal)
    share = wp.sign(wp.dot(first, across)) / wp.length(across)
    hand = wp.sign(wp.dot(wp.cross(normal, first), touch.direction2))
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = 3 * place * n + dof
        turned = steps.turned[entry]
        rate = share * wp.cross(axis, turned)
        rate -= wp.dot(first, rate) * first
        steps.turned[entry + n] = rate
        steps.turned[entry + 2 * n] = hand * (wp.cross(turned, first) + wp.cross(normal, rate))


@func
def move_contact(
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    shape_a: Int32,
    shape_b: Int32,
) -> bool:
    """Write how a contact moves; returns whether that is known."""
    known = Int32(0)
    offset = touch.point_a - touch.point_b
    if wp.length(offset - wp.dot(offset, touch.normal) * touch.normal) > _KEPT:
        move_kept(space, steps, place, touch)
        known = Int32(1)
    elif shapes.shape_kind[shape_a] == SPHERE and shapes.shape_kind[shape_b] == SPHERE:
        radius_a, radius_b = shapes.shape_size[world, shape_a][0], shapes.shape_size[world, shape_b][0]
        move_balls(space, steps, place, touch, radius_a, radius_b)
        known = Int32(1)
    for side in range(2):
        if known == 0:
            face_is_a = side == 1
            shape = wp.where(face_is_a, shape_b, shape_a)
            other = wp.where(face_is_a, shape_a, shape_b)
            point = wp.where(face_is_a, touch.point_b, touch.point_a)
            outward = wp.where(face_is_a, -touch.normal, touch.normal)
            radius = touching_radius(state, shapes, world, shape, point, outward)
            if radius >= 0.0:
                if touches_with_face(state, shapes, world, other, outward):
                    move_on_face(space, steps, place, touch, radius, face_is_a)
                    known = Int32(1)
    if known == 0 and move_as_measured(space, steps, place, touch):
        known = Int32(1)
    if known == 1:
        turn_directions(space, steps, place, touch)
    return known == 1
