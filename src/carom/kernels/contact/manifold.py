"""Contact matching: contacts take over impulses and friction anchors from those of the last step."""

import math

import warp as wp

from carom.kernels.contact.candidates import (
    candidate_distance,
    candidate_normal,
    candidate_on_a,
    candidate_point,
)
from carom.kernels.maths.min_max import minimum
from carom.kernels.structs import Contacts, Pairs, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, func, real
from carom.layouts.contacts import NONE_KEPT, START_CONTACTS, THERE

_HALF_ROOT = real(math.sqrt(0.5))


@func
def friction_direction(normal: Vector3) -> Vector3:
    """A unit vector perpendicular to `normal`, a function of it alone."""
    if wp.abs(normal[2]) > _HALF_ROOT:
        scale = 1.0 / wp.sqrt(normal[1] * normal[1] + normal[2] * normal[2])
        return Vector3(0.0, -normal[2] * scale, normal[1] * scale)
    scale = 1.0 / wp.sqrt(normal[0] * normal[0] + normal[1] * normal[1])
    return Vector3(-normal[1] * scale, normal[0] * scale, 0.0)


@func
def keep_previous(contacts: Contacts, pairs: Pairs, world: Int32) -> Int32:
    """Copy the contacts of the last substep, for new ones to be matched with.

    Those at the start of a step stay there until it ends, to be restored if it is abandoned.

    Returns:
        Where the first of them is put.
    """
    count = contacts.count_contacts[world, THERE]
    first = Int32(0)
    if pairs.count_pairs[world, START_CONTACTS] == NONE_KEPT:
        pairs.count_pairs[world, START_CONTACTS] = count
    else:
        first = contacts.contact_shapes.shape[1]
    for row in range(count):
        kept = first + row
        pairs.previous_shapes[world, kept] = contacts.contact_shapes[world, row]
        pairs.previous_normal[world, kept] = contacts.contact_normal[world, row]
        pairs.previous_direction1[world, kept] = contacts.contact_direction1[world, row]
        pairs.previous_direction2[world, kept] = contacts.contact_direction2[world, row]
        pairs.previous_distance[world, kept] = contacts.contact_distance[world, row]
        pairs.previous_local_a[world, kept] = contacts.contact_local_a[world, row]
        pairs.previous_local_b[world, kept] = contacts.contact_local_b[world, row]
        pairs.previous_point_a[world, kept] = contacts.contact_point_a[world, row]
        pairs.previous_point_b[world, kept] = contacts.contact_point_b[world, row]
        pairs.previous_anchor_a[world, kept] = contacts.contact_anchor_a[world, row]
        pairs.previous_anchor_b[world, kept] = contacts.contact_anchor_b[world, row]
        pairs.previous_impulse[world, kept] = contacts.contact_impulse[world, row]
        pairs.previous_warm_start[world, kept] = contacts.contact_warm_start[world, row]
        pairs.previous_taken[world, kept] = 0
    return first


@func
def restore_contacts(contacts: Contacts, pairs: Pairs, world: Int32):
    """Restore the contacts of the start of a step, if they were saved."""
    count = pairs.count_pairs[world, START_CONTACTS]
    if count == NONE_KEPT:
        return
    for row in range(count):
        contacts.contact_shapes[world, row] = pairs.previous_shapes[world, row]
        contacts.contact_normal[world, row] = pairs.previous_normal[world, row]
        contacts.contact_direction1[world, row] = pairs.previous_direction1[world, row]
        contacts.contact_direction2[world, row] = pairs.previous_direction2[world, row]
        contacts.contact_distance[world, row] = pairs.previous_distance[world, row]
        contacts.contact_local_a[world, row] = pairs.previous_local_a[world, row]
        contacts.contact_local_b[world, row] = pairs.previous_local_b[world, row]
        contacts.contact_point_a[world, row] = pairs.previous_point_a[world, row]
        contacts.contact_point_b[world, row] = pairs.previous_point_b[world, row]
        contacts.contact_anchor_a[world, row] = pairs.previous_anchor_a[world, row]
        contacts.contact_anchor_b[world, row] = pairs.previous_anchor_b[world, row]
        contacts.contact_impulse[world, row] = pairs.previous_impulse[world, row]
        contacts.contact_warm_start[world, row] = pairs.previous_warm_start[world, row]
    contacts.count_contacts[world, THERE] = count


@func
def skip_contacts(pairs: Pairs, world: Int32, first: Int32, end: Int32, pair: Index4, equal: Int32) -> Int32:
    """The first of sorted previous contacts [first, end) that comes after what is skipped.

    Args:
        pairs: Holds the previous contacts.
        world: The world.
        first: Where to start.
        end: End of the previous contacts.
        pair: A pair of shapes.
        equal: 1 to skip the contacts of this pair as well as those of pairs before it, 0 not to.
    """
    row = first
    skipping = row < end
    while skipping:
        skipping = comes_before(pairs, world, row, pair, equal)
        if skipping:
            row += 1
            skipping = row < end
    return row


@func
def comes_before(pairs: Pairs, world: Int32, row: Int32, pair: Index4, equal: Int32) -> bool:
    """Whether a previous contact is one of those that `skip_contacts` skips."""
    shapes = pairs.previous_shapes[world, row]
    lower = wp.min(shapes[0], shapes[1])
    return lower < pair[0] or (lower == pair[0] and wp.max(shapes[0], shapes[1]) < pair[1] + equal)


@func
def predecessor(
    pairs: Pairs, world: Int32, first: Int32, last: Int32, local_a: Vector3, local_b: Vector3, far: real
) -> Int32:
    """The nearest previous contact in [first, last) that has no successor yet; -1 if all are far away.

    A contact that slides keeps its place on one of the two bodies at least.
    """
    nearest = Int32(-1)
    least = far * far
    for row in range(first, last):
        if pairs.previous_taken[world, row] == 0:
            away = minimum(
                wp.length_sq(pairs.previous_local_a[world, row] - local_a),
                wp.length_sq(pairs.previous_local_b[world, row] - local_b),
            )
            if away < least:
                least = away
                nearest = row
    return nearest


@func
def keep_for_matching(contacts: Contacts, pairs: Pairs, world: Int32, before: Int32, row: Int32):
    """Give contact `row` the impulses and friction anchor of the previous contact `before`; -1 for none."""
    if before >= 0:
        contacts.contact_anchor_a[world, row] = pairs.previous_anchor_a[world, before]
        contacts.contact_anchor_b[world, row] = pairs.previous_anchor_b[world, before]
        contacts.contact_impulse[world, row] = pairs.previous_impulse[world, before]
        contacts.contact_warm_start[world, row] = pairs.previous_warm_start[world, before]
        pairs.previous_taken[world, before] = 1
    else:
        contacts.contact_anchor_a[world, row] = contacts.contact_local_a[world, row]
        contacts.contact_anchor_b[world, row] = contacts.contact_local_b[world, row]
        contacts.contact_impulse[world, row] = Vector3(0.0, 0.0, 0.0)
        contacts.contact_warm_start[world, row] = 0.0


@func
def write_place(
    contacts: Contacts,
    world: Int32,
    row: Int32,
    shapes: Index4,
    local_a: Vector3,
    local_b: Vector3,
    point_a: Vector3,
    point_b: Vector3,
    normal: Vector3,
    distance: real,
):
    """Write where a contact is, and its friction directions."""
    contacts.contact_shapes[world, row] = shapes
    contacts.contact_local_a[world, row] = local_a
    contacts.contact_local_b[world, row] = local_b
    contacts.contact_point_a[world, row] = point_a
    contacts.contact_point_b[world, row] = point_b
    contacts.contact_distance[world, row] = distance
    direction = friction_direction(normal)
    contacts.contact_normal[world, row] = normal
    contacts.contact_direction1[world, row] = direction
    contacts.contact_direction2[world, row] = wp.cross(normal, direction)


@func
def write_contact(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    row: Int32,
    pair: Index4,
    candidate: Int32,
):
    """Write where a candidate is as contact `row`; impulses come from `keep_for_matching`."""
    link_a = shapes.shape_link[pair[0]]
    link_b = shapes.shape_link[pair[1]]
    point_a = candidate_on_a(pairs.candidate_terms, world, candidate)
    point_b = candidate_point(pairs.candidate_terms, world, candidate)
    write_place(
        contacts,
        world,
        row,
        Index4(pair[0], pair[1], link_a, link_b),
        wp.transform_point(wp.transform_inverse(state.link_pose[world, link_a]), point_a),
        wp.transform_point(wp.transform_inverse(state.link_pose[world, link_b]), point_b),
        point_a,
        point_b,
        candidate_normal(pairs.candidate_terms, world, candidate),
        candidate_distance(pairs.candidate_terms, world, candidate),
    )


@func
def write_new_contact(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    row: Int32,
    pair: Index4,
    candidate: Int32,
    first: Int32,
    last: Int32,
    far: real,
):
    """Write a candidate as contact `row`, with the impulses of its predecessor in [first, last)."""
    write_contact(shapes, state, contacts, pairs, world, row, pair, candidate)
    before = predecessor(
        pairs,
        world,
        first,
        last,
        contacts.contact_local_a[world, row],
        contacts.contact_local_b[world, row],
        far,
    )
    keep_for_matching(contacts, pairs, world, before, row)
    if before < 0 and last > first:
        # A new point of a manifold that was there before does not end the warm starting of the others.
        contacts.contact_warm_start[world, row] = minimum(pairs.previous_warm_start[world, first], 1.0)


@func
def keep_contact(state: State, contacts: Contacts, pairs: Pairs, world: Int32, before: Int32, row: Int32):
    """Write the previous contact `before` as contact `row`, its points where they are on their links now."""
    shapes = pairs.previous_shapes[world, before]
    normal = pairs.previous_normal[world, before]
    local_a = pairs.previous_local_a[world, before]
    local_b = pairs.previous_local_b[world, before]
    point_a = wp.transform_point(state.link_pose[world, shapes[2]], local_a)
    point_b = wp.transform_point(state.link_pose[world, shapes[3]], local_b)
    distance = wp.dot(point_a - point_b, normal)
    write_place(contacts, world, row, shapes, local_a, local_b, point_a, point_b, normal, distance)
    keep_for_matching(contacts, pairs, world, before, row)
