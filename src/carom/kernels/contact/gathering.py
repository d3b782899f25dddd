"""Manifolds of what does not lie on a face: they gather their points over the steps, as Bullet's do.

Bullet adds one point in a step, the deepest, and keeps those of the steps before until their sides have
parted. A face that lies flat has all its corners after a few steps, so a manifold made at once is as good and
steadier, and which of its points is the deepest is up to rounding. But what rolls or tumbles never comes so
far: new points enter where it rolls to, old ones linger where it rolled from, and both decide how deep it
rolls and how it scrubs sideways. So hulls, cylinders and capsules get their points by Bullet's rules unless
they lie on a face, and on infinite planes all shapes do.
"""

import math

import warp as wp

from carom.kernels.contact.candidates import (
    candidate_distance,
    candidate_normal,
    candidate_on_a,
    flip_candidates,
)
from carom.kernels.contact.contact_margins import is_part_of_compound
from carom.kernels.contact.manifold import keep_contact, keep_for_matching, write_contact
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

# Cosine of the angle between axis and normal up to which a shape lies on its side.
ON_SIDE = real(math.sqrt(0.5))
# Cosine of the angle between face and contact, 1.8 degrees, beyond which a shape lies on the face.
ON_FACE = real(0.9995)
# Stands for the new point among the rows of previous contacts.
NEW = wp.constant(-1)
# There is no new point to add, as the manifold is to be made at once.
AT_ONCE = wp.constant(-1)


@wp.struct
class Gathered:
    """The manifold as it grows: its first `count` slots are in use."""

    count: Int32
    slots: Index4  # rows of previous contacts, or `NEW`
    distances: Vector4
    predecessor: Int32  # row of the previous contact in whose place the new point is, -1 for none


@func
def rolls(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape is round about an axis, or a hull."""
    return shapes.shape_rolling[shape] != NO_ROLLING


@func
def is_single_sided(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape is one point or many triangles for its partners, so that nothing is gathered."""
    kind = shapes.shape_kind[shape]
    return kind == SPHERE or kind >= TRIANGLES


@func
def lies_on_face(shapes: Shapes, shape: Int32, outward: Vector3) -> bool:
    """Whether a hull touches with a face on which it can lie; `outward` is a direction in its frame."""
    first = shapes.shape_first_face[shape]
    for face in range(first, first + shapes.shape_flat_faces[shape]):
        plane = shapes.face_plane[face]
        if plane[0] * outward[0] + plane[1] * outward[1] + plane[2] * outward[2] > ON_FACE:
            return True
    return False


@func
def rolls_on(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, outward: Vector3) -> bool:
    """Whether a shape, if it rolls, touches with something on which it does, and not with a face.

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

    On planes all shapes gather their points, also where they lie on a face: boxes that land flat tip and
    creep by them. On faces of other shapes the deepest point of what lies exactly flat is in the middle, and
    would stay alone.
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
        pairs: Room for candidates, poses of the shapes, and the previous contacts.
        world: The world.
        sides: The two shapes.
        max_distance: Largest distance of a contact [m].
        first: First previous contact of the two shapes.
        last: End of these.

    Returns:
        1, or 0 if they are too far apart; `AT_ONCE` if the manifold does not gather.
    """
    a = sides[0]
    b = sides[1]
    if is_single_sided(shapes, a) or is_single_sided(shapes, b):
        return AT_ONCE
    if not (rolls(shapes, a) or rolls(shapes, b) or gathers_everywhere(shapes, a, b)):
        return AT_ONCE
    if pairs.shape_motion[world, a] + pairs.shape_motion[world, b] > 0.0:
        # What is stopped at one end only would swing through with the other.
        return AT_ONCE
    if last > first:
        if not gathers(shapes, pairs, world, a, b, pairs.previous_normal[world, first]):
            return AT_ONCE
    order = in_order(shapes, a, b)
    found = nearest_convex(
        shapes, pairs, world, order[0], order[1], core_of(shapes, pairs, world, order[0]), max_distance
    )
    if order[0] != a:
        flip_candidates(pairs.candidate_terms, world, found)
    if last == first and found > 0:
        if not gathers(shapes, pairs, world, a, b, candidate_normal(pairs.candidate_terms, world, 0)):
            return AT_ONCE
    return found


@func
def refresh(state: State, pairs: Pairs, world: Int32, before: Gathered, far: real) -> Gathered:
    """Drop the points that have parted, along their normal or across it; the last takes a free slot."""
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
    """A measure of the area that a point spans with three previous contacts, all on shape a."""
    return wp.length_sq(
        wp.cross(
            point - pairs.previous_local_a[world, i],
            pairs.previous_local_a[world, k] - pairs.previous_local_a[world, j],
        )
    )


@func
def least_needed(pairs: Pairs, world: Int32, full: Gathered, point: Vector3, distance: real) -> Int32:
    """The one of four slots whose point gives way to a new one: the rest spans most, the deepest stays."""
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
    """Put the new point, on shape a in the frame of its link, where one is near, or else where is room."""
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
    """Write a manifold of previous contacts [first, last) and a new point, if one was found.

    Parts of compounds drop points before they add one, others after that, as in Bullet.

    Returns:
        The number of all contacts, which was `wanted` before; those beyond the capacity are not written.
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
            candidate_on_a(pairs.candidate_terms, world, 0),
        )
        distance = candidate_distance(pairs.candidate_terms, world, 0)
        manifold = add_point(pairs, world, manifold, point, distance, far)
    if not compound:
        manifold = refresh(state, pairs, world, manifold, far)
    for slot in range(manifold.count):
        row = wanted + slot
        if row < contacts.contact_shapes.shape[1]:
            if manifold.slots[slot] == NEW:
                write_contact(shapes, state, contacts, pairs, world, row, sides, 0)
                keep_for_matching(contacts, pairs, world, manifold.predecessor, row)
            else:
                keep_contact(state, contacts, pairs, world, manifold.slots[slot], row)
    return wanted + manifold.count
