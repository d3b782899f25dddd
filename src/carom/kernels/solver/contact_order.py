"""The order in which an island's manifolds are relaxed.

If sweeps end before convergence, the result depends on the order of rows, so reproducing Bullet's motion
needs Bullet's order. Bullet sorts all manifolds by island, with an unstable quicksort.
"""

import warp as wp

from carom.kernels.solver.activity import can_move, is_asleep, pushed_tree
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, func
from carom.layouts.contacts import THERE

# Stack of ranges that are still to be sorted, as pairs of bounds. As the longer range is pushed each time, it
# has at most log2(n) ranges for n manifolds.
Bounds = wp.types.vector(64, int)
# End of a list.
NONE = wp.constant(-1)


@func
def same_shapes(contacts: Contacts, world: Int32, contact: Int32, pair: Index4) -> bool:
    """Whether a contact, -1 for none, is between the shapes of `pair`."""
    if contact < 0:
        return False
    other = contacts.contact_shapes[world, contact]
    return other[0] == pair[0] and other[1] == pair[1]


@func
def gather_manifolds(
    model: Model, state: State, shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32
) -> Int32:
    """List the manifolds that act on trees that can move and are awake; returns their number.

    On entry, `tree_first_contact` of the root of an island has to be the last tree of the island.
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
    """Sort the first `count` manifolds by island: Hoare's quicksort with the middle element as pivot."""
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
        # The shorter range is sorted next; the other is pushed on the stack.
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
    """Make the linked list of contacts of each island, manifold by manifold."""
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
