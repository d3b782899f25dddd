"""Contacts that last: what a contact point knew in the last step is passed on to its successor."""

import warp as wp

from carom.collision.candidates import candidate_distance, candidate_normal, candidate_point
from carom.model.contact_structs import Contacts, Pairs, Shapes
from carom.model.real import Index4, Int32, Vector3, Vector4, func, real
from carom.model.structs import State

# Columns of `Contacts.count_contacts`: contacts there are, contacts the last collision would have made.
THERE, WANTED = 0, 1


@func
def keep_previous(contacts: Contacts, pairs: Pairs, world: Int32) -> Int32:
    """Put the contacts of the last step aside; returns their number."""
    count = contacts.count_contacts[world, THERE]
    for row in range(count):
        pairs.previous_shapes[world, row] = contacts.contact_shapes[world, row]
        pairs.previous_local_a[world, row] = contacts.contact_local_a[world, row]
        pairs.previous_local_b[world, row] = contacts.contact_local_b[world, row]
        pairs.previous_point_a[world, row] = contacts.contact_point_a[world, row]
        pairs.previous_point_b[world, row] = contacts.contact_point_b[world, row]
        pairs.previous_normal[world, row] = contacts.contact_normal[world, row]
        pairs.previous_direction1[world, row] = contacts.contact_direction1[world, row]
        pairs.previous_direction2[world, row] = contacts.contact_direction2[world, row]
        pairs.previous_distance[world, row] = contacts.contact_distance[world, row]
        pairs.previous_impulse[world, row] = contacts.contact_impulse[world, row]
        pairs.previous_age[world, row] = contacts.contact_age[world, row]
        pairs.previous_taken[world, row] = 0
    return count


@func
def return_previous(contacts: Contacts, pairs: Pairs, world: Int32, count: Int32):
    """Bring the contacts of the last step back, so that the collision can be repeated with more room."""
    for row in range(count):
        contacts.contact_shapes[world, row] = pairs.previous_shapes[world, row]
        contacts.contact_local_a[world, row] = pairs.previous_local_a[world, row]
        contacts.contact_local_b[world, row] = pairs.previous_local_b[world, row]
        contacts.contact_point_a[world, row] = pairs.previous_point_a[world, row]
        contacts.contact_point_b[world, row] = pairs.previous_point_b[world, row]
        contacts.contact_normal[world, row] = pairs.previous_normal[world, row]
        contacts.contact_direction1[world, row] = pairs.previous_direction1[world, row]
        contacts.contact_direction2[world, row] = pairs.previous_direction2[world, row]
        contacts.contact_distance[world, row] = pairs.previous_distance[world, row]
        contacts.contact_impulse[world, row] = pairs.previous_impulse[world, row]
        contacts.contact_age[world, row] = pairs.previous_age[world, row]
    contacts.count_contacts[world, THERE] = count


@func
def skip_contacts(
    pairs: Pairs, world: Int32, first: Int32, count: Int32, pair: Index4, equal: Int32
) -> Int32:
    """The first of `count` sorted previous contacts, from `first` on, that comes after what is skipped.

    Args:
        pairs: Holds the previous contacts.
        world: The world.
        first: Where to start.
        count: Number of previous contacts.
        pair: A pair of shapes.
        equal: 1 to skip the contacts of this pair as well as those of pairs before it, 0 not to.
    """
    row = first
    skipping = row < count
    while skipping:
        shapes = pairs.previous_shapes[world, row]
        skipping = shapes[0] < pair[0] or (shapes[0] == pair[0] and shapes[1] < pair[1] + equal)
        if skipping:
            row += 1
            skipping = row < count
    return row


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
            away = wp.min(
                wp.length_sq(pairs.previous_local_a[world, row] - local_a),
                wp.length_sq(pairs.previous_local_b[world, row] - local_b),
            )
            if away < least:
                least = away
                nearest = row
    return nearest


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
    first: Int32,
    last: Int32,
    far: real,
):
    """Write a candidate as contact `row`, with the impulses of its predecessor in [first, last)."""
    link_a = shapes.shape_link[pair[0]]
    link_b = shapes.shape_link[pair[1]]
    normal = candidate_normal(pairs.candidate_terms, world, candidate)
    distance = candidate_distance(pairs.candidate_terms, world, candidate)
    point_b = candidate_point(pairs.candidate_terms, world, candidate)
    point_a = point_b + normal * distance
    local_a = wp.transform_point(wp.transform_inverse(state.link_pose[world, link_a]), point_a)
    local_b = wp.transform_point(wp.transform_inverse(state.link_pose[world, link_b]), point_b)
    contacts.contact_shapes[world, row] = Index4(pair[0], pair[1], link_a, link_b)
    contacts.contact_local_a[world, row] = local_a
    contacts.contact_local_b[world, row] = local_b
    contacts.contact_point_a[world, row] = point_a
    contacts.contact_point_b[world, row] = point_b
    contacts.contact_normal[world, row] = normal
    contacts.contact_distance[world, row] = distance
    before = predecessor(pairs, world, first, last, local_a, local_b, far)
    if before >= 0:
        contacts.contact_impulse[world, row] = pairs.previous_impulse[world, before]
        contacts.contact_direction1[world, row] = pairs.previous_direction1[world, before]
        contacts.contact_direction2[world, row] = pairs.previous_direction2[world, before]
        contacts.contact_age[world, row] = pairs.previous_age[world, before] + 1
        pairs.previous_taken[world, before] = 1
    else:
        contacts.contact_impulse[world, row] = Vector4(0.0, 0.0, 0.0, 0.0)
        contacts.contact_direction1[world, row] = Vector3(0.0, 0.0, 0.0)
        contacts.contact_direction2[world, row] = Vector3(0.0, 0.0, 0.0)
        contacts.contact_age[world, row] = 0
