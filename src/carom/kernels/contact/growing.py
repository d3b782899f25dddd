"""A manifold that grows: previous contacts and new points, by Bullet's rules.

A new point takes the place of one within the breaking distance, then a free slot, then that of the point
which the manifold misses least. Points whose sides have parted are dropped.
"""

import warp as wp

from carom.kernels.contact.candidates import candidate_distance, candidate_on_a
from carom.kernels.contact.contact_margins import is_part_of_compound
from carom.kernels.contact.manifold import keep_contact, keep_for_matching, write_contact
from carom.kernels.structs import Contacts, Pairs, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, Vector4, func, real

# The code of new points among the rows of previous contacts: that of candidate i is NEW - i.
NEW = wp.constant(-1)
# Stands for a new point that takes no other's place.
NOBODY = wp.constant(-1)

Points = wp.types.matrix((4, 3), real)


@wp.struct
class Gathered:
    """The manifold as it grows: its first `count` slots are in use."""

    count: Int32
    slots: Index4  # rows of previous contacts, or codes of new points
    distances: Vector4
    points: Points  # on shape a, in the frame of its link
    predecessors: Index4  # of new points: row of the previous contact in whose place it is, or `NOBODY`


@func
def start_gathering(pairs: Pairs, world: Int32, first: Int32, last: Int32) -> Gathered:
    """The manifold of previous contacts [first, last)."""
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
    """The point of a slot on shape a, in the frame of its link."""
    return Vector3(manifold.points[slot, 0], manifold.points[slot, 1], manifold.points[slot, 2])


@func
def refresh(state: State, pairs: Pairs, world: Int32, before: Gathered, far: real) -> Gathered:
    """Drop the points that have parted, along their normal or across it; the last takes a free slot."""
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
    """A measure of the area that a point spans with those of three slots, all on shape a."""
    return wp.length_sq(wp.cross(point - point_of(full, i), point_of(full, k) - point_of(full, j)))


@func
def least_needed(full: Gathered, point: Vector3, distance: real) -> Int32:
    """The one of four slots whose point gives way to a new one: the rest spans most, the deepest stays."""
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
    """Put a new point, on shape a in the frame of its link, where one is near, or else where is room."""
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
    sides: Index4,
    found: Int32,
    first: Int32,
    last: Int32,
    far: real,
) -> Int32:
    """Write a manifold of previous contacts [first, last) and the first `found` candidates.

    Parts of compounds drop points before they add some, others after that, as in Bullet.

    Returns:
        The number of all contacts, which was `wanted` before; those beyond the capacity are not written.
    """
    manifold = start_gathering(pairs, world, first, last)
    compound = is_part_of_compound(shapes, sides[0]) or is_part_of_compound(shapes, sides[1])
    if compound:
        manifold = refresh(state, pairs, world, manifold, far)
    to_link = wp.transform_inverse(state.link_pose[world, shapes.shape_link[sides[0]]])
    for candidate in range(found):
        point = wp.transform_point(to_link, candidate_on_a(pairs.candidate_terms, world, candidate))
        distance = candidate_distance(pairs.candidate_terms, world, candidate)
        manifold = add_point(manifold, candidate, point, distance, far)
    if not compound:
        manifold = refresh(state, pairs, world, manifold, far)
    for slot in range(manifold.count):
        row = wanted + slot
        if row < contacts.contact_shapes.shape[1]:
            code = manifold.slots[slot]
            if code < 0:
                write_contact(shapes, state, contacts, pairs, world, row, sides, NEW - code)
                keep_for_matching(contacts, pairs, world, manifold.predecessors[slot], row)
            else:
                keep_contact(state, contacts, pairs, world, code, row)
    return wanted + manifold.count
