"""Contacts of a world: from pairs of shapes whose bounds meet.

If pairs or contacts do not fit, `State.status_entry` says so: detection has to be repeated with more room,
from the contacts that there were, before anything else is done with them.
"""

import warp as wp

from carom.kernels.contact.contact_margins import (
    breaking_distance,
    contact_margin,
    meets_beside,
    region_margin,
)
from carom.kernels.contact.gathering import AT_ONCE, find_new_point, gather
from carom.kernels.contact.manifold import keep_previous, skip_contacts, write_new_contact
from carom.kernels.contact.narrow_phase import collide_shapes
from carom.kernels.contact.sides import in_order_of_sides
from carom.kernels.structs import Contacts, Model, Pairs, Shapes, State
from carom.kernels.types import Index4, Int32, func, real
from carom.layouts.codes import ASLEEP
from carom.layouts.contacts import PAIRS, THERE
from carom.layouts.status import CONTACTS_WANTED, OVERFLOW, PAIRS_WANTED, STATUS

# A point that is as near as this to where it was has not been moved [m].
UNMOVED = real(1.0e-9)


@func
def is_at_rest(shapes: Shapes, model: Model, state: State, world: Int32, shape: Int32) -> bool:
    """Whether the link of a shape is asleep or cannot move."""
    return (
        state.tree_activity[world, shapes.shape_tree[shape]] == ASLEEP
        or model.link[shapes.shape_link[shape]].nearest_dof < 0
    )


@func
def is_where_it_was(state: State, contacts: Contacts, world: Int32, row: Int32) -> bool:
    """Whether both points of a contact that is still there from the last step are where they were."""
    links = contacts.contact_shapes[world, row]
    point_a = wp.transform_point(state.link_pose[world, links[2]], contacts.contact_local_a[world, row])
    point_b = wp.transform_point(state.link_pose[world, links[3]], contacts.contact_local_b[world, row])
    return (
        wp.length_sq(point_a - contacts.contact_point_a[world, row]) < UNMOVED * UNMOVED
        and wp.length_sq(point_b - contacts.contact_point_b[world, row]) < UNMOVED * UNMOVED
    )


@func
def can_stay(
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    world: Int32,
    pair: Index4,
    wanted: Int32,
    first: Int32,
    last: Int32,
) -> bool:
    """Whether the contacts [first, last) of a pair from the last step are still right.

    They are if both shapes are at rest and nobody has moved them. The next row to write being theirs,
    they have not been overwritten.
    """
    if wanted != first:
        return False
    if not (
        is_at_rest(shapes, model, state, world, pair[0]) and is_at_rest(shapes, model, state, world, pair[1])
    ):
        return False
    for row in range(first, last):
        if not is_where_it_was(state, contacts, world, row):
            return False
    return last > first


@func
def make_contacts(
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    kept: Int32,
) -> Int32:
    """Contacts of all pairs; returns how many there are, those beyond the capacity included.

    The first of the previous contacts is at `kept`.
    """
    end = kept + contacts.count_contacts[world, THERE]
    wanted = Int32(0)
    first = kept + 0
    for i in range(pairs.count_pairs[world, PAIRS]):
        pair = pairs.pair_shapes[world, i]
        first = skip_contacts(pairs, world, first, end, pair, 0)
        last = skip_contacts(pairs, world, first, end, pair, 1)
        if can_stay(shapes, model, state, contacts, world, pair, wanted, first - kept, last - kept):
            wanted += last - first
            first = last
            continue
        found, count = find_candidates(shapes, pairs, world, pair, first, last)
        wanted = add_manifold(shapes, state, contacts, pairs, world, pair, found, count, first, last, wanted)
        first = last
    return wanted


@func
def find_candidates(shapes: Shapes, pairs: Pairs, world: Int32, pair: Index4, first: Int32, last: Int32):
    """Write the candidates of a pair, whose contacts of the last substep are [first, last).

    Returns:
        What `find_new_point` returned; the number of candidates if that is `AT_ONCE`, else 0.
    """
    if last == first and not (
        meets_beside(shapes, pairs, world, pair[0], pair[1])
        and meets_beside(shapes, pairs, world, pair[1], pair[0])
    ):
        return Int32(AT_ONCE), Int32(0)
    max_distance = contact_margin(shapes, pairs, world, pair[0], pair[1], last > first)
    sides = in_order_of_sides(shapes, pair)
    found = find_new_point(shapes, pairs, world, sides, max_distance, first, last)
    count = Int32(0)
    if found == AT_ONCE:
        around = region_margin(shapes, pairs, world, pair[0], pair[1], last > first)
        count = collide_shapes(shapes, pairs, world, sides[0], sides[1], max_distance, around)
    return found, count


@func
def add_manifold(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    pair: Index4,
    found: Int32,
    count: Int32,
    first: Int32,
    last: Int32,
    wanted: Int32,
) -> Int32:
    """Write the contacts that come of the candidates of a pair; those beyond the capacity are counted only.

    Args:
        shapes: All shapes.
        state: Poses of the links.
        contacts: Where they go.
        pairs: Candidates and previous contacts.
        world: The world.
        pair: The pair.
        found: What `find_candidates` returned.
        count: As well.
        first: First previous contact of the pair.
        last: End of these.
        wanted: Number of contacts of the pairs before.

    Returns:
        Number of contacts, these included.
    """
    sides = in_order_of_sides(shapes, pair)
    far = breaking_distance(shapes, pair[0], pair[1])
    if found != AT_ONCE:
        return gather(shapes, state, contacts, pairs, world, wanted, sides, found, first, last, far)
    for candidate in range(count):
        if wanted < contacts.contact_shapes.shape[1]:
            write_new_contact(
                shapes, state, contacts, pairs, world, wanted, sides, candidate, first, last, far
            )
        wanted += 1
    return wanted


@func
def report_overflow(state: State, world: Int32, pairs_wanted: Int32, contacts_wanted: Int32):
    """Record that pairs or contacts did not fit, and the number needed."""
    state.status_entry[world, STATUS] = OVERFLOW
    state.status_entry[world, PAIRS_WANTED] = pairs_wanted
    state.status_entry[world, CONTACTS_WANTED] = contacts_wanted


@func
def find_contacts(shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs, world: Int32):
    """Contacts of all pairs, if all of them fit; those that persist keep their impulses."""
    if pairs.count_pairs[world, PAIRS] > pairs.pair_shapes.shape[1]:
        report_overflow(state, world, pairs.count_pairs[world, PAIRS], 0)
        return
    kept = keep_previous(contacts, pairs, world)
    accept_contacts(state, contacts, world, make_contacts(shapes, model, state, contacts, pairs, world, kept))


@func
def accept_contacts(state: State, contacts: Contacts, world: Int32, wanted: Int32):
    """Let the contacts that have been written be there, if all of them did fit."""
    if wanted > contacts.contact_shapes.shape[1]:
        report_overflow(state, world, 0, wanted)
        return
    contacts.count_contacts[world, THERE] = wanted
