"""Contacts of a world, computed from the pairs of shapes whose bounds meet.

If the pairs or contacts exceed the capacity, `State.status_entry` records it. Then detection has to be
repeated with larger arrays, from the contacts before it, before any contact is used.
"""

import warp as wp

from carom.kernels.contact.contact_margins import (
    contact_margin,
    meets_beside,
    region_margin,
)
from carom.kernels.contact.gathering import AT_ONCE, find_new_points
from carom.kernels.contact.growing import gather
from carom.kernels.contact.manifold import keep_previous, sides_of, skip_contacts, write_new_contact
from carom.kernels.contact.narrow_phase import collide_shapes, has_yielding_contacts
from carom.kernels.contact.overlaps import update_overlaps
from carom.kernels.contact.sides import in_order_of_sides
from carom.kernels.structs import Contacts, Model, Pairs, Settings, Shapes, State
from carom.kernels.types import Index2, Int32, Vector3, called_func, func, real
from carom.layouts.codes import ASLEEP
from carom.layouts.contacts import MEETING, PAIRS, THERE
from carom.layouts.status import CONTACTS_WANTED, OVERFLOW, PAIRS_WANTED, STATUS

# A contact point counts as not moved if it is nearer than this to its last position [m].
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
    """Whether both points of a contact of the last step have kept their world positions."""
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
    pair: Index2,
    wanted: Int32,
    first: Int32,
    last: Int32,
) -> bool:
    """Whether a pair's contacts [first, last) of the last step are still valid and in the right rows.

    They are valid if both shapes are at rest and have not been moved. They are in the right rows, and not
    overwritten, if `first` is the next row to write.
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


@called_func
def make_contacts(
    shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs, world: Int32, kept: Int32
) -> Int32:
    """Write the contacts of all pairs; returns their number, including those beyond the capacity.

    `kept` is the row of the first previous contact.
    """
    end = kept + contacts.count_contacts[world, THERE]
    wanted = Int32(0)
    first = kept + 0
    for i in range(pairs.count_pairs[world, PAIRS]):
        pair = pairs.pair_shapes[world, i]
        if pairs.pair_nearness[world, i] != MEETING:
            continue
        first = skip_contacts(pairs, world, first, end, pair, 0)
        last = skip_contacts(pairs, world, first, end, pair, 1)
        if can_stay(shapes, model, state, contacts, world, pair, wanted, first - kept, last - kept):
            wanted += last - first
            first = last
            continue
        far = pairs.pair_breaking[world, i]
        found, count = find_candidates(shapes, pairs, world, pair, far, first, last)
        wanted = add_manifold(
            shapes, state, contacts, pairs, world, pair, far, found, count, first, last, wanted
        )
        first = last
    return wanted


@func
def last_normal(
    shapes: Shapes, pairs: Pairs, world: Int32, sides: Index2, first: Int32, last: Int32
) -> Vector3:
    """The normal of a pair whose contacts yield and that overlapped in the last substep, else 0.

    [first, last) are the contacts that it had.
    """
    if last > first and has_yielding_contacts(shapes, world, sides[0]):
        if has_yielding_contacts(shapes, world, sides[1]) and pairs.previous_distance[world, first] <= 0.0:
            return pairs.previous_normal[world, first]
    return Vector3(0.0, 0.0, 0.0)


@func
def find_candidates(
    shapes: Shapes, pairs: Pairs, world: Int32, pair: Index2, far: real, first: Int32, last: Int32
):
    """Write the candidates of a pair, whose contacts of the last substep are [first, last).

    `far` is the breaking distance of its manifold [m].

    Returns:
        The result of `find_new_points`, and the number of candidates if that result is `AT_ONCE`, else 0.
    """
    if last == first and not (
        meets_beside(shapes, pairs, world, pair[0], pair[1])
        and meets_beside(shapes, pairs, world, pair[1], pair[0])
    ):
        return Int32(AT_ONCE), Int32(0)
    max_distance = contact_margin(shapes, pairs, world, pair[0], pair[1], far, last > first)
    sides = in_order_of_sides(shapes, pair)
    found = find_new_points(shapes, pairs, world, sides, max_distance, first, last)
    count = Int32(0)
    if found == AT_ONCE:
        around = region_margin(pairs, world, pair[0], pair[1], far, last > first)
        normal = last_normal(shapes, pairs, world, sides, first, last)
        count = collide_shapes(shapes, pairs, world, sides[0], sides[1], max_distance, around, normal)
    return found, count


@func
def add_manifold(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    pair: Index2,
    far: real,
    found: Int32,
    count: Int32,
    first: Int32,
    last: Int32,
    wanted: Int32,
) -> Int32:
    """Write the contacts of a pair from its candidates; contacts beyond the capacity are only counted.

    `far` is the breaking distance of its manifold [m], `found` and `count` are the results of
    `find_candidates`, [first, last) the previous contacts of the pair,
    and `wanted` is the number of contacts of the earlier pairs. Returns the number with those of this pair.
    """
    sides = in_order_of_sides(shapes, pair)
    if found != AT_ONCE:
        return gather(shapes, state, contacts, pairs, world, wanted, sides, found, first, last, far)
    if count == 0:
        return wanted
    both = sides_of(shapes, state, world, sides)
    for candidate in range(count):
        if wanted < contacts.contact_shapes.shape[1]:
            write_new_contact(contacts, pairs, world, wanted, both, candidate, first, last, far)
        wanted += 1
    return wanted


@func
def report_overflow(state: State, world: Int32, pairs_wanted: Int32, contacts_wanted: Int32):
    """Record that pairs or contacts did not fit, and the number needed."""
    state.status_entry[world, STATUS] = OVERFLOW
    state.status_entry[world, PAIRS_WANTED] = pairs_wanted
    state.status_entry[world, CONTACTS_WANTED] = contacts_wanted


@func
def accept_pairs(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
) -> bool:
    """Update the overlaps to the pairs found; false, after a report, if one or the other do not fit."""
    wanted = pairs.count_pairs[world, PAIRS]
    if wanted <= pairs.pair_shapes.shape[1]:
        wanted = update_overlaps(settings, shapes, model, state, contacts, pairs, world)
        if wanted == 0:
            return True
    report_overflow(state, world, wanted, 0)
    return False


@func
def find_contacts(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
):
    """Find the contacts of all pairs, if all of them fit; contacts that persist keep their impulses."""
    if not accept_pairs(settings, shapes, model, state, contacts, pairs, world):
        return
    kept = keep_previous(contacts, pairs, world)
    accept_contacts(state, contacts, world, make_contacts(shapes, model, state, contacts, pairs, world, kept))


@func
def accept_contacts(state: State, contacts: Contacts, world: Int32, wanted: Int32):
    """Set the number of contacts to those written if all of them fit; else report the overflow."""
    if wanted > contacts.contact_shapes.shape[1]:
        report_overflow(state, world, 0, wanted)
        return
    contacts.count_contacts[world, THERE] = wanted
