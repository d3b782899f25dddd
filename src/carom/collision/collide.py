"""Collision detection of a world: from link poses to contacts."""

import warp as wp

from carom.collision.broad_phase import find_pairs
from carom.collision.hierarchy import PAIRS
from carom.collision.manifold import REPEATED, THERE, WANTED, keep_previous, skip_contacts, write_contact
from carom.collision.narrow_phase import touch
from carom.collision.reach import breaking_distance, contact_reach
from carom.collision.sides import in_order_of_sides
from carom.model.contact_structs import Contacts, Pairs, Shapes
from carom.model.real import Int32, func, kernel
from carom.model.structs import Model, Settings, State


@func
def make_contacts(
    shapes: Shapes, state: State, contacts: Contacts, pairs: Pairs, world: Int32, previous_count: Int32
) -> Int32:
    """Contacts of all pairs; returns how many there are, those beyond the capacity included."""
    room = contacts.contact_shapes.shape[1]
    wanted = Int32(0)
    first = Int32(0)
    for i in range(pairs.count_pairs[world, PAIRS]):
        pair = pairs.pair_shapes[world, i]
        first = skip_contacts(pairs, world, first, previous_count, pair, 0)
        last = skip_contacts(pairs, world, first, previous_count, pair, 1)
        reach = contact_reach(shapes, pairs, world, pair[0], pair[1], last > first)
        sides = in_order_of_sides(shapes, pair)
        count = touch(shapes, pairs, world, sides[0], sides[1], reach)
        far = breaking_distance(shapes, pair[0], pair[1])
        for candidate in range(count):
            if wanted < room:
                write_contact(
                    shapes, state, contacts, pairs, world, wanted, sides, candidate, first, last, far
                )
            wanted += 1
        first = last
    return wanted


@func
def find_contacts(shapes: Shapes, state: State, contacts: Contacts, pairs: Pairs, world: Int32):
    """Contacts of all pairs, if the pairs did fit; those that persist keep their impulses."""
    if pairs.count_pairs[world, PAIRS] <= pairs.pair_shapes.shape[1]:
        previous_count = keep_previous(contacts, pairs, world)
        wanted = make_contacts(shapes, state, contacts, pairs, world, previous_count)
        contacts.count_contacts[world, WANTED] = wanted
        if wanted <= contacts.contact_shapes.shape[1]:
            contacts.count_contacts[world, THERE] = wanted
            contacts.count_contacts[world, REPEATED] = 0
        else:
            contacts.count_contacts[world, THERE] = 0
            contacts.count_contacts[world, REPEATED] = 1


@func
def collide(
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    settings: Settings,
    world: Int32,
):
    """Find all contacts for the present `State.link_pose`; those that persist keep their impulses.

    If pairs or contacts do not fit (see `overflowed`), it has to be repeated with more room before anything
    else is done with the contacts.
    """
    find_pairs(shapes, model, state, settings, pairs, world)
    find_contacts(shapes, state, contacts, pairs, world)


@func
def overflowed(contacts: Contacts, pairs: Pairs, world: Int32) -> bool:
    """Whether the last collision of a world needs more room for pairs or contacts."""
    return (
        pairs.count_pairs[world, PAIRS] > pairs.pair_shapes.shape[1]
        or contacts.count_contacts[world, WANTED] > contacts.contact_shapes.shape[1]
    )


@kernel
def collide_kernel(
    settings: Settings, shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs
):
    """Collision detection of each world, without a step."""
    collide(shapes, model, state, contacts, pairs, settings, wp.tid())
