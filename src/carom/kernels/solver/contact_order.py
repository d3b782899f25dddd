"""The order in which an island's manifolds are relaxed.

If sweeps end before convergence, the result depends on the order of rows, so reproducing Bullet's motion
needs Bullet's order. Bullet sorts all manifolds by island, with an unstable quicksort. Manifolds without
contacts take part in it; there is one for each overlap (`contact.overlaps`).
"""

import warp as wp

from carom.kernels.solver.activity import can_move, is_asleep, link_moves, pushed_tree
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Index4, Int32, func
from carom.layouts.contacts import OVERLAPS, SORTED, THERE

# Stack of ranges that are still to be sorted, as pairs of bounds. As the longer range is pushed each time, it
# has at most log2(n) ranges for n manifolds.
Bounds = wp.types.vector(64, int)
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
def with_links(shapes: Shapes, overlap: Index4) -> Index4:
    """The shapes of an overlap and their links, as in `Contacts.contact_shapes`."""
    return Index4(overlap[0], overlap[1], shapes.shape_link[overlap[0]], shapes.shape_link[overlap[1]])


@func
def is_between(contacts: Contacts, world: Int32, contact: Int32, overlap: Index4) -> bool:
    """Whether a contact exists and is between two shapes, of which the first has the lower row."""
    if contact >= contacts.count_contacts[world, THERE]:
        return False
    pair = contacts.contact_shapes[world, contact]
    return wp.min(pair[0], pair[1]) == overlap[0] and wp.max(pair[0], pair[1]) == overlap[1]


@func
def find_first_contacts(contacts: Contacts, pair_rows: PairRows, world: Int32):
    """Find the first contact of each overlap; both are sorted by shapes."""
    contact = Int32(0)
    for row in range(contacts.count_contacts[world, OVERLAPS]):
        overlap = contacts.overlap_shapes[world, row]
        touching = is_between(contacts, world, contact, overlap)
        pair_rows.order_first[world, row] = wp.where(touching, contact, Int32(NONE))
        while touching:
            contact += 1
            touching = is_between(contacts, world, contact, overlap)


@func
def root_of(pair_rows: PairRows, world: Int32, tree: Int32) -> Int32:
    """Root of a tree's island among those by which manifolds are sorted; compresses the path to it."""
    root = tree + 0
    while pair_rows.tree_first_contact[world, root] != root:
        above = pair_rows.tree_first_contact[world, root]
        pair_rows.tree_first_contact[world, root] = pair_rows.tree_first_contact[world, above]
        root = pair_rows.tree_first_contact[world, root]
    return root


@func
def join(pair_rows: PairRows, world: Int32, a: Int32, b: Int32):
    """Join the islands of two trees; as in Bullet, b's root stays a root."""
    pair_rows.tree_first_contact[world, root_of(pair_rows, world, a)] = root_of(pair_rows, world, b)


@func
def join_trees(
    settings: Settings,
    model: Model,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Find Bullet's islands: trees that overlap or that user constraints tie together."""
    count = contacts.count_contacts[world, OVERLAPS]
    for tree in range(settings.tree_count):
        pair_rows.tree_first_contact[world, tree] = tree
    for row in range(count):
        pair_rows.order_overlap[world, contacts.overlap_shapes[world, row][2]] = row
    for place in range(count):
        pair = with_links(shapes, contacts.overlap_shapes[world, pair_rows.order_overlap[world, place]])
        if link_moves(model, pair[2]) and link_moves(model, pair[3]):
            join(pair_rows, world, shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]])
    for user in range(settings.user_count):
        a = users.user_tree_a[user]
        b = users.user_tree_b[user]
        if users.user_enabled[world, user] != 0 and can_move(model, a) and can_move(model, b):
            join(pair_rows, world, a, b)


@func
def gather_manifolds(
    model: Model, state: State, shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32
) -> Int32:
    """List the manifolds of trees that can move and are awake, in their order; returns their number."""
    total = Int32(0)
    for row in range(contacts.count_contacts[world, OVERLAPS]):
        manifold = contacts.overlap_shapes[world, row][3]
        if manifold >= 0:
            pair_rows.order_overlap[world, manifold] = row
            total += 1
    count = Int32(0)
    for place in range(total):
        row = pair_rows.order_overlap[world, place]
        tree = pushed_tree(shapes, model, with_links(shapes, contacts.overlap_shapes[world, row]))
        if tree >= 0 and not is_asleep(state, world, tree):
            pair_rows.order_overlap[world, count] = row
            pair_rows.order_island[world, count] = root_of(pair_rows, world, tree)
            count += 1
    return count


@func
def exchange_manifolds(pair_rows: PairRows, world: Int32, i: Int32, j: Int32):
    """Swap two manifolds."""
    overlap = pair_rows.order_overlap[world, i]
    island = pair_rows.order_island[world, i]
    pair_rows.order_overlap[world, i] = pair_rows.order_overlap[world, j]
    pair_rows.order_island[world, i] = pair_rows.order_island[world, j]
    pair_rows.order_overlap[world, j] = overlap
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
def sort_overlaps(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Bring `Contacts.overlap_sorted` up to date.

    It depends on the overlaps only, and is kept until they change, if nothing sleeps and no user constraints
    exist. In other cases SORTED is negative.
    """
    lasts = settings.user_count == 0
    for tree in range(settings.tree_count):
        lasts = lasts and not is_asleep(state, world, tree)
    if lasts and contacts.count_contacts[world, SORTED] > 0:
        return
    join_trees(settings, model, shapes, contacts, users, pair_rows, world)
    count = gather_manifolds(model, state, shapes, contacts, pair_rows, world)
    sort_manifolds(pair_rows, world, count)
    for place in range(count):
        contacts.overlap_sorted[world, place] = pair_rows.order_overlap[world, place]
    contacts.count_contacts[world, SORTED] = wp.where(lasts, count + 1, -1 - count)


@func
def list_contacts(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Make the linked list of contacts of each island, manifold by manifold."""
    sort_overlaps(settings, model, state, shapes, contacts, users, pair_rows, world)
    find_first_contacts(contacts, pair_rows, world)
    for tree in range(settings.tree_count):
        pair_rows.tree_first_contact[world, tree] = NONE
    place = wp.abs(contacts.count_contacts[world, SORTED]) - 1
    while place > 0:
        place -= 1
        first = pair_rows.order_first[world, contacts.overlap_sorted[world, place]]
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
