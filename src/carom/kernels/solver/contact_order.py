"""The order in which an island's manifolds are relaxed.

A sweep that stops early depends on the order of its rows, so Bullet's motion needs Bullet's order: it
sorts all manifolds by island with a quicksort that does not keep the order of equals.
"""

import warp as wp

from carom.kernels.solver.activity import can_move, is_asleep, pushed_tree
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, func
from carom.layouts.contacts import THERE

# Room for the bounds of parts that are still to be sorted; the longer part waits, so 32 would do.
Bounds = wp.types.vector(64, int)
# End of a list.
NONE = wp.constant(-1)


@func
def same_shapes(contacts: Contacts, world: Int32, contact: Int32, pair: Index4) -> bool:
    """Whether a contact, if it is one, is between the shapes of `pair`."""
    if contact < 0:
        return False
    other = contacts.contact_shapes[world, contact]
    return other[0] == pair[0] and other[1] == pair[1]


@func
def gather_manifolds(
    model: Model, state: State, shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32
) -> Int32:
    """List the manifolds that can push a tree that is not asleep; returns their number.

    `tree_first_contact` of the root of an island has to be the last tree of it.
    """
    count = Int32(0)
    contact_count = contacts.count_contacts[world, THERE]
    contact = Int32(0)
    while contact < contact_count:
        pair = contacts.contact_shapes[world, contact]
        tree = pushed_tree(shapes, model, pair)
        if tree >= 0 and not is_asleep(state, world, tree):
            pair_rows.order_first[world, count] = contact
            pair_rows.order_island[world, count] = pair_rows.tree_first_contact[
                world, state.tree_island[world, tree]
            ]
            count += 1
        contact += 1
        while contact < contact_count and same_shapes(contacts, world, contact, pair):
            contact += 1
    return count


@func
def exchange_manifolds(pair_rows: PairRows, world: Int32, i: Int32, j: Int32):
    """Swap two manifolds."""
    first = pair_rows.order_first[world, i]
    island = pair_rows.order_island[world, i]
    pair_rows.order_first[world, i] = pair_rows.order_first[world, j]
    pair_rows.order_island[world, i] = pair_rows.order_island[world, j]
    pair_rows.order_first[world, j] = first
    pair_rows.order_island[world, j] = island


@func
def sort_manifolds(pair_rows: PairRows, world: Int32, count: Int32):
    """Sort the first `count` manifolds by island: Hoare's quicksort around the middle element."""
    bounds = Bounds()
    waiting = Int32(0)
    low = Int32(0)
    high = count - 1
    while low < high:
        i = low + 0
        j = high + 0
        pivot = pair_rows.order_island[world, (low + high) // 2]
        while i <= j:
            while pair_rows.order_island[world, i] < pivot:
                i += 1
            while pivot < pair_rows.order_island[world, j]:
                j -= 1
            if i <= j:
                exchange_manifolds(pair_rows, world, i, j)
                i += 1
                j -= 1
        # Go on with the shorter part; the other waits.
        if j - low < high - i:
            bounds[waiting] = i
            bounds[waiting + 1] = high
            high = j + 0
        else:
            bounds[waiting] = low
            bounds[waiting + 1] = j
            low = i + 0
        waiting += 2
        while low >= high and waiting > 0:
            waiting -= 2
            low = bounds[waiting]
            high = bounds[waiting + 1]


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
    """Give the root of each island the list of its contacts, manifold by manifold."""
    for tree in range(settings.tree_count):
        if can_move(model, tree):
            pair_rows.tree_first_contact[world, state.tree_island[world, tree]] = tree
    count = gather_manifolds(model, state, shapes, contacts, pair_rows, world)
    sort_manifolds(pair_rows, world, count)
    for tree in range(settings.tree_count):
        pair_rows.tree_first_contact[world, tree] = NONE
    while count > 0:
        count -= 1
        first = pair_rows.order_first[world, count]
        pair = contacts.contact_shapes[world, first]
        root = state.tree_island[world, pushed_tree(shapes, model, pair)]
        contact = first + 1
        while contact < contacts.count_contacts[world, THERE] and same_shapes(contacts, world, contact, pair):
            contact += 1
        while contact > first:
            contact -= 1
            pair_rows.contact_next[world, contact] = pair_rows.tree_first_contact[world, root]
            pair_rows.tree_first_contact[world, root] = contact
