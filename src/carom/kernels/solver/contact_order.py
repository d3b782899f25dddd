"""The order in which an island's manifolds are relaxed.

If sweeps end before convergence, the result depends on the order of rows, so reproducing Bullet's motion
needs Bullet's order. Bullet sorts all manifolds by island, with an unstable quicksort. Manifolds without
contacts take part in it; there is one for each overlap (`contact.overlaps`).
"""

import warp as wp

from carom.kernels.contact.contact_margins import processing_threshold
from carom.kernels.solver.activity import is_left_out, pushed_tree
from carom.kernels.solver.island_sort import sort_by_island
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State
from carom.kernels.types import Index2, Index4, Int32, func
from carom.layouts.contacts import AS_LINKS, NO_MANIFOLD, OVERLAPS, SORTED, THERE

# End of a list.
NONE = wp.constant(-1)


@func
def same_shapes(contacts: Contacts, world: Int32, contact: Int32, pair: Index4) -> bool:
    """Whether a contact, -1 for none, is between the shapes of `pair`, which is from `contact_shapes`."""
    if contact < 0:
        return False
    other = contacts.contact_shapes[world, contact]
    return other[0] == pair[0] and other[1] == pair[1]


@func
def with_links(shapes: Shapes, pair: Index2) -> Index4:
    """Two shapes and their links, as in `Contacts.contact_shapes`."""
    return Index4(pair[0], pair[1], shapes.shape_link[pair[0]], shapes.shape_link[pair[1]])


@func
def is_between(contacts: Contacts, world: Int32, contact: Int32, overlap: Index2) -> bool:
    """Whether a contact exists and is between two shapes, of which the first has the lower row."""
    if contact >= contacts.count_contacts[world, THERE]:
        return False
    pair = contacts.contact_shapes[world, contact]
    return wp.min(pair[0], pair[1]) == overlap[0] and wp.max(pair[0], pair[1]) == overlap[1]


@func
def find_first_contacts(shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32):
    """Find the first contact of each overlap, and up to which distance each contact is solved.

    Contacts and overlaps are sorted by shapes.
    """
    contact = Int32(0)
    for row in range(contacts.count_contacts[world, OVERLAPS]):
        overlap = contacts.overlap_shapes[world, row]
        touching = is_between(contacts, world, contact, overlap)
        pair_rows.order_first[world, row] = wp.where(touching, contact, Int32(NONE))
        if touching:
            threshold = contacts.overlap_solved_up_to[world, row]
            if threshold == AS_LINKS:
                threshold = processing_threshold(shapes, world, overlap)
            while touching:
                pair_rows.contact_solved_up_to[world, contact] = threshold
                contact += 1
                touching = is_between(contacts, world, contact, overlap)


@func
def gather_manifolds(
    model: Model, state: State, shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32
) -> Int32:
    """List the manifolds of trees that can move and are awake, in their order; returns their number."""
    total = Int32(0)
    for row in range(contacts.count_contacts[world, OVERLAPS]):
        manifold = contacts.overlap_manifold[world, row]
        if manifold != NO_MANIFOLD:
            pair_rows.order_row[world, manifold] = row
            total += 1
    count = Int32(0)
    for place in range(total):
        row = pair_rows.order_row[world, place]
        tree = pushed_tree(shapes, model, with_links(shapes, contacts.overlap_shapes[world, row]))
        if tree >= 0 and not is_left_out(state, world, tree):
            pair_rows.order_row[world, count] = row
            pair_rows.order_island[world, count] = pair_rows.tree_number[world, tree]
            count += 1
    return count


@func
def sort_manifolds(
    model: Model, state: State, shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32
) -> Int32:
    """Write the overlaps to `overlap_sorted` in the order of relaxation; returns their number."""
    count = gather_manifolds(model, state, shapes, contacts, pair_rows, world)
    sort_by_island(pair_rows, world, count)
    for place in range(count):
        contacts.overlap_sorted[world, place] = pair_rows.order_row[world, place]
    return count


@func
def sort_by_links(
    settings: Settings, contacts: Contacts, pair_rows: PairRows, world: Int32, count: Int32
) -> Int32:
    """Sort the manifolds that have contacts by their links, instead of in the order in which bounds have met.

    Args:
        settings: Has the number of links.
        contacts: `overlap_sorted` has all manifolds.
        pair_rows: `order_row` gets those with contacts, sorted by link a, then by link b.
        world: The world.
        count: Number of all manifolds.

    Returns:
        Number of manifolds with contacts.
    """
    touching = Int32(0)
    for place in range(count):
        row = contacts.overlap_sorted[world, place]
        first = pair_rows.order_first[world, row]
        if first >= 0:
            pair = contacts.contact_shapes[world, first]
            pair_rows.order_row[world, touching] = row
            pair_rows.order_island[world, touching] = pair[2] * settings.link_count + pair[3]
            touching += 1
    sort_by_island(pair_rows, world, touching)
    return touching


@func
def list_contacts(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    world: Int32,
):
    """Make the linked list of contacts of each island, manifold by manifold."""
    find_first_contacts(shapes, contacts, pair_rows, world)
    for tree in range(settings.tree_count):
        pair_rows.tree_first_contact[world, tree] = NONE
    place = wp.abs(contacts.count_contacts[world, SORTED]) - 1
    if settings.order_by_links != 0:
        place = sort_by_links(settings, contacts, pair_rows, world, place)
    while place > 0:
        place -= 1
        row = contacts.overlap_sorted[world, place]
        if settings.order_by_links != 0:
            row = pair_rows.order_row[world, place]
        first = pair_rows.order_first[world, row]
        if first >= 0:
            pair = contacts.contact_shapes[world, first]
            root = state.tree_island[world, pushed_tree(shapes, model, pair)]
            contact = first + 1
            while contact < contacts.count_contacts[world, THERE] and same_shapes(
                contacts, world, contact, pair
            ):
                contact += 1
            while contact > first:
                contact -= 1
                pair_rows.contact_next[world, contact] = pair_rows.tree_first_contact[world, root]
                pair_rows.tree_first_contact[world, root] = contact
