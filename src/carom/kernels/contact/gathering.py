"""Contact manifolds that gather their points over several steps, as in Bullet.

In each step Bullet adds one point, the deepest, and keeps the points of earlier steps until they have
separated. A face that lies flat has all its corners after a few steps. There a manifold made at once is
equally good, and steadier, because rounding decides which corner is the deepest. The manifold of a shape that
rolls or tumbles is never complete: new points come in front, old points remain behind, and both affect the
penetration depth and the sideways scrubbing. So hulls, cylinders and capsules gather their points by Bullet's
rules unless they lie on a face. On infinite planes all shapes gather their points.
"""

import math

import warp as wp

from carom.kernels.contact.candidates import candidate_on_a, flip_candidates
from carom.kernels.contact.contact_margins import is_part_of_compound
from carom.kernels.contact.manifold import keep_contact, keep_for_matching, sides_of, write_contact
from carom.kernels.contact.narrow_phase import in_order
from carom.kernels.queries.closest import nearest_convex
from carom.kernels.shapes.cores import core_of
from carom.kernels.structs import Contacts, Pairs, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, Vector4, func, real
from carom.layouts.codes import (
    HULL,
    NO_ROLLING,
    PLANE,
    ROLLING_ABOUT_ANY,
    ROLLING_ABOUT_X,
    ROLLING_OFF_FACES,
    SPHERE,
    TRIANGLES,
)

# A hull lies on its side if the cosine of the angle between its axis and the normal is less than this.
ON_SIDE = real(math.sqrt(0.5))
# A shape lies on a face if the cosine of the angle between the normals of face and contact exceeds this (an
# angle of 1.8 degrees).
ON_FACE = real(0.9995)
# Marks the slot of the new point, where other slots have the row of a previous contact.
NEW = wp.constant(-1)
# Result of `find_new_point`: the manifold is made at once instead of gathering points.
AT_ONCE = wp.constant(-1)


@wp.struct
class Gathered:
    """A manifold while it is updated; its first `count` slots are in use."""

    count: Int32
    slots: Index4  # rows of previous contacts, or `NEW`
    distances: Vector4
    predecessor: Int32  # row of the previous contact whose impulses the new point inherits, -1 for none


@func
def rolls(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape can roll: it is round about an axis, or a hull."""
    return shapes.shape_rolling[shape] != NO_ROLLING


@func
def is_single_sided(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape is a sphere or consists of triangles, so that its manifolds gather no points."""
    kind = shapes.shape_kind[shape]
    return kind == SPHERE or kind >= TRIANGLES


@func
def lies_on_face(shapes: Shapes, shape: Int32, outward: Vector3) -> bool:
    """Whether a hull touches with a face on which it can lie; `outward` is the normal in its frame."""
    first = shapes.shape_first_face[shape]
    for face in range(first, first + shapes.shape_flat_faces[shape]):
        plane = shapes.face_plane[face]
        if plane[0] * outward[0] + plane[1] * outward[1] + plane[2] * outward[2] > ON_FACE:
            return True
    return False


@func
def rolls_on(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, outward: Vector3) -> bool:
    """Whether a shape touches with a surface on which it rolls, not with a face on which it lies.

    Args:
        shapes: All shapes.
        pairs: Poses of the shapes.
        world: The world.
        shape: The shape.
        outward: The contact's normal, out of the shape.
    """
    about = shapes.shape_rolling[shape]
    if about == NO_ROLLING or about == ROLLING_ABOUT_ANY:
        return about == ROLLING_ABOUT_ANY
    local = wp.transpose(pairs.shape_frame[world, shape]) * outward
    if about != ROLLING_OFF_FACES:
        along = wp.abs(local[about - ROLLING_ABOUT_X])
        if shapes.shape_kind[shape] != HULL:
            return along < ON_FACE
        if along < ON_SIDE:
            return True
    return not lies_on_face(shapes, shape, local)


@func
def gathers_everywhere(shapes: Shapes, a: Int32, b: Int32) -> bool:
    """Whether one of two shapes is an infinite plane.

    On planes all shapes gather their points, even if they lie on a face; therefore boxes that land flat tip
    and creep, as in Bullet. On a face of another shape, the deepest point of a shape that lies exactly flat
    is in the middle of the face, and would remain the only point.
    """
    return shapes.shape_kind[a] == PLANE or shapes.shape_kind[b] == PLANE


@func
def gathers(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, normal: Vector3) -> bool:
    """Whether a manifold with this normal gathers its points."""
    if gathers_everywhere(shapes, a, b):
        return True
    return rolls_on(shapes, pairs, world, a, -normal) or rolls_on(shapes, pairs, world, b, normal)


@func
def find_new_point(
    shapes: Shapes, pairs: Pairs, world: Int32, sides: Index4, max_distance: real, first: Int32, last: Int32
) -> Int32:
    """Write the deepest candidate of a manifold that gathers its points.

    Args:
        shapes: All shapes.
        pairs: Workspace for candidates, poses of the shapes, and the previous contacts.
        world: The world.
        sides: The two shapes.
        max_distance: Largest distance of a contact [m].
        first: First previous contact of the two shapes.
        last: End of their previous contacts.

    Returns:
        1 if a candidate was written, 0 if the shapes are too far apart, `AT_ONCE` if the manifold does not
        gather its points.
    """
    a = sides[0]
    b = sides[1]
    if is_single_sided(shapes, a) or is_single_sided(shapes, b):
        return AT_ONCE
    if not (rolls(shapes, a) or rolls(shapes, b) or gathers_everywhere(shapes, a, b)):
        return AT_ONCE
    if pairs.shape_motion[world, a] + pairs.shape_motion[world, b] > 0.0:
        # A fast shape that is stopped at one point only would swing through the surface with its other end.
        return AT_ONCE
    if last > first:
        if not gathers(shapes, pairs, world, a, b, pairs.previous_normal[world, first]):
            return AT_ONCE
    first_shape, second_shape = in_order(shapes, a, b)
    core = core_of(shapes, pairs, world, first_shape)
    found = nearest_convex(shapes, pairs, world, first_shape, second_shape, core, max_distance)
    if first_shape != a:
        flip_candidates(pairs.candidate, world, found)
    if last == first and found > 0:
        if not gathers(shapes, pairs, world, a, b, pairs.candidate[world, 0].normal):
            return AT_ONCE
    return found


@func
def refresh(state: State, pairs: Pairs, world: Int32, before: Gathered, far: real) -> Gathered:
    """Drop the points that have separated along or across their normal; the last point fills the gap."""
    kept = before
    slot = kept.count - 1
    while slot >= 0:
        row = kept.slots[slot]
        if row != NEW:
            links = pairs.previous_shapes[world, row]
            normal = pairs.previous_normal[world, row]
            offset = wp.transform_point(state.link_pose[world, links[2]], pairs.previous_local_a[world, row])
            offset -= wp.transform_point(state.link_pose[world, links[3]], pairs.previous_local_b[world, row])
            distance = wp.dot(offset, normal)
            kept.distances[slot] = distance
            if distance > far or wp.length_sq(offset - normal * distance) > far * far:
                kept.count -= 1
                kept.slots[slot] = kept.slots[kept.count]
                kept.distances[slot] = kept.distances[kept.count]
        slot -= 1
    return kept


@func
def spread(pairs: Pairs, world: Int32, point: Vector3, i: Int32, j: Int32, k: Int32) -> real:
    """Measure of the area that a point and three previous contacts span on shape a [m^4]."""
    return wp.length_sq(
        wp.cross(
            point - pairs.previous_local_a[world, i],
            pairs.previous_local_a[world, k] - pairs.previous_local_a[world, j],
        )
    )


@func
def least_needed(pairs: Pairs, world: Int32, full: Gathered, point: Vector3, distance: real) -> Int32:
    """Slot whose point a new point replaces, when all four slots are in use.

    The deepest of the five points is kept, and the other points are chosen to span the largest area.
    """
    deepest = Int32(-1)
    least = distance
    for slot in range(4):
        if full.distances[slot] < least:
            least = full.distances[slot]
            deepest = Int32(slot)
    best = Int32(0)
    most = real(0.0)
    slots = full.slots
    for slot in range(4):
        i = Int32(wp.where(slot == 0, 1, 0))
        j = Int32(wp.where(slot <= 1, 2, 1))
        k = Int32(wp.where(slot <= 2, 3, 2))
        size = spread(pairs, world, point, slots[i], slots[j], slots[k])
        if slot != deepest and size > most:
            most = size
            best = Int32(slot)
    return best


@func
def add_point(
    pairs: Pairs, world: Int32, before: Gathered, point: Vector3, distance: real, far: real
) -> Gathered:
    """Put the new point into the slot of the nearest point within `far`, else into a free or replaced one.

    `point` is on shape a, in the frame of its link.
    """
    more = before
    slot = more.count
    nearest_sq = far * far
    for other in range(more.count):
        away_sq = wp.length_sq(pairs.previous_local_a[world, more.slots[other]] - point)
        if away_sq < nearest_sq:
            nearest_sq = away_sq
            slot = Int32(other)
    if slot < more.count:
        more.predecessor = more.slots[slot]
    elif slot == 4:
        slot = least_needed(pairs, world, more, point, distance)
    else:
        more.count += 1
    more.slots[slot] = NEW
    more.distances[slot] = distance
    return more


@func
def gather(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    wanted: Int32,
    sides: Index4,
    found: Int32,
    first: Int32,
    last: Int32,
    far: real,
) -> Int32:
    """Write a manifold of the previous contacts [first, last) and a new point, if one was found.

    Separated points are dropped before the new point is added if one of the shapes is part of a compound,
    and after it otherwise, as in Bullet.

    Returns:
        Number of contacts: `wanted`, those of earlier pairs, plus the contacts of this manifold. Contacts
        beyond the capacity are not written.
    """
    manifold = Gathered()
    manifold.count = last - first
    manifold.predecessor = Int32(NEW)
    for slot in range(last - first):
        manifold.slots[slot] = first + slot
        manifold.distances[slot] = pairs.previous_distance[world, first + slot]
    compound = is_part_of_compound(shapes, sides[0]) or is_part_of_compound(shapes, sides[1])
    if compound:
        manifold = refresh(state, pairs, world, manifold, far)
    if found > 0:
        point = wp.transform_point(
            wp.transform_inverse(state.link_pose[world, shapes.shape_link[sides[0]]]),
            candidate_on_a(pairs.candidate, world, 0),
        )
        distance = pairs.candidate[world, 0].distance
        manifold = add_point(pairs, world, manifold, point, distance, far)
    if not compound:
        manifold = refresh(state, pairs, world, manifold, far)
    for slot in range(manifold.count):
        row = wanted + slot
        if row < contacts.contact_shapes.shape[1]:
            if manifold.slots[slot] == NEW:
                write_contact(contacts, pairs, world, row, sides_of(shapes, state, world, sides), 0)
                keep_for_matching(contacts, pairs, world, manifold.predecessor, row)
            else:
                keep_contact(state, contacts, pairs, world, manifold.slots[slot], row)
    return wanted + manifold.count
