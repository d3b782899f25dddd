"""A manifold that gathers points: previous contacts and new points, by Bullet's rules.

A new point replaces a previous one within the breaking distance. Else it takes a free slot, or, when all four
are in use, the slot of the point that the manifold needs least. Points that have separated are dropped.
"""

import warp as wp

from carom.kernels.contact.candidates import candidate_on_a
from carom.kernels.contact.contact_margins import is_part_of_compound
from carom.kernels.contact.gathering import are_boxes
from carom.kernels.contact.manifold import keep_contact, keep_for_matching, sides_of, write_contact
from carom.kernels.maths.min_max import minimum
from carom.kernels.structs import Contacts, Pairs, Shapes, State
from carom.kernels.types import Index2, Index4, Int32, Vector3, Vector4, func, real
from carom.layouts.contacts import HELD_BEFORE

# Slots have rows of previous contacts, or for new points `NEW` minus the index of the candidate.
NEW = wp.constant(-1)
# Predecessor of a new point that replaces no previous one.
NOBODY = wp.constant(-1)
# Counter of the contacts of a manifold that held until a body was moved.
HELD_UNTIL_MOVED = real(HELD_BEFORE)

Points = wp.types.matrix((4, 3), real)


@wp.struct
class Gathered:
    """A manifold while it is updated; its first `count` slots are in use."""

    count: Int32
    slots: Index4  # rows of previous contacts, or codes of candidates
    distances: Vector4
    points: Points  # on shape a, in the frame of its link
    predecessors: Index4  # of new points: row of the contact whose impulses they inherit, or `NOBODY`


@func
def start_gathering(pairs: Pairs, world: Int32, first: Int32, last: Int32) -> Gathered:
    """The manifold of the previous contacts [first, last)."""
    manifold = Gathered()
    manifold.count = last - first
    manifold.predecessors = Index4(NOBODY, NOBODY, NOBODY, NOBODY)
    for slot in range(last - first):
        manifold.slots[slot] = first + slot
        manifold.distances[slot] = pairs.previous_distance[world, first + slot]
        point = pairs.previous_local_a[world, first + slot]
        for axis in range(3):
            manifold.points[slot, axis] = point[axis]
    return manifold


@func
def point_of(manifold: Gathered, slot: Int32) -> Vector3:
    """Point of a slot on shape a, in the frame of its link."""
    return Vector3(manifold.points[slot, 0], manifold.points[slot, 1], manifold.points[slot, 2])


@func
def refresh(state: State, pairs: Pairs, world: Int32, before: Gathered, far: real) -> Gathered:
    """Drop the points that have separated along or across their normal; the last point fills the gap."""
    kept = before
    slot = kept.count - 1
    while slot >= 0:
        row = kept.slots[slot]
        if row >= 0:
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
                kept.predecessors[slot] = kept.predecessors[kept.count]
                for axis in range(3):
                    kept.points[slot, axis] = kept.points[kept.count, axis]
        slot -= 1
    return kept


@func
def spread(full: Gathered, point: Vector3, i: Int32, j: Int32, k: Int32) -> real:
    """Measure of the area that a point and those of three slots span on shape a [m^4]."""
    return wp.length_sq(wp.cross(point - point_of(full, i), point_of(full, k) - point_of(full, j)))


@func
def least_needed(full: Gathered, point: Vector3, distance: real) -> Int32:
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
    for slot in range(4):
        i = Int32(wp.where(slot == 0, 1, 0))
        j = Int32(wp.where(slot <= 1, 2, 1))
        k = Int32(wp.where(slot <= 2, 3, 2))
        size = spread(full, point, i, j, k)
        if slot != deepest and size > most:
            most = size
            best = Int32(slot)
    return best


@func
def add_point(before: Gathered, candidate: Int32, point: Vector3, distance: real, far: real) -> Gathered:
    """Put a new point into the slot of the nearest point within `far`, else into a free or replaced one.

    `point` is on shape a, in the frame of its link.
    """
    more = before
    slot = more.count
    nearest_sq = far * far
    for other in range(more.count):
        away_sq = wp.length_sq(point_of(more, other) - point)
        if away_sq < nearest_sq:
            nearest_sq = away_sq
            slot = Int32(other)
    if slot < more.count:
        if more.slots[slot] >= 0:
            more.predecessors[slot] = more.slots[slot]
    else:
        if slot == 4:
            slot = least_needed(more, point, distance)
        else:
            more.count += 1
        more.predecessors[slot] = NOBODY
    more.slots[slot] = NEW - candidate
    more.distances[slot] = distance
    for axis in range(3):
        more.points[slot, axis] = point[axis]
    return more


@func
def gather(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    wanted: Int32,
    sides: Index2,
    found: Int32,
    first: Int32,
    last: Int32,
    far: real,
) -> Int32:
    """Write a manifold of the previous contacts [first, last) and of the first `found` candidates.

    Separated points are dropped before the new points are added if one of the shapes is part of a compound,
    and after it otherwise, as in Bullet. But what was held at rest has other depths than in Bullet: if it was
    moved away, chance would decide which new points the old ones keep out, so those are dropped first.

    Returns:
        Number of contacts: `wanted`, those of earlier pairs, plus the contacts of this manifold. Contacts
        beyond the capacity are not written.
    """
    boxes = are_boxes(shapes, sides[0], sides[1])
    manifold = start_gathering(pairs, world, first, last)
    compound = is_part_of_compound(shapes, sides[0]) or is_part_of_compound(shapes, sides[1])
    if compound or (first < last and pairs.previous_warm_start[world, first] == HELD_UNTIL_MOVED):
        remaining = refresh(state, pairs, world, manifold, far)
        if compound or remaining.count < manifold.count:
            manifold = remaining
    both = sides_of(shapes, state, world, sides)
    for candidate in range(found):
        point = wp.transform_point(both.to_a, candidate_on_a(pairs.candidate, world, candidate))
        distance = pairs.candidate[world, candidate].distance
        manifold = add_point(manifold, candidate, point, distance, far)
    if not compound:
        manifold = refresh(state, pairs, world, manifold, far)
    for slot in range(manifold.count):
        row = wanted + slot
        if row < contacts.contact_shapes.shape[1]:
            code = manifold.slots[slot]
            if code < 0:
                write_contact(contacts, pairs, world, row, both, NEW - code)
                before = manifold.predecessors[slot]
                keep_for_matching(contacts, pairs, world, before, row)
                if boxes and before == NOBODY and last > first:
                    # A new point of an existing manifold does not end warm starting of the other points.
                    contacts.contact_warm_start[world, row] = minimum(
                        pairs.previous_warm_start[world, first], 1.0
                    )
            else:
                keep_contact(state, contacts, pairs, world, code, row)
    return wanted + manifold.count
