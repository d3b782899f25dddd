"""Islands as in Bullet, whose rows it sweeps over together: links whose bounds overlap, touching or not.

Bullet numbers all links that can move. Overlaps, in the order of the pair cache, then joints and user
constraints unite their links; the number of an island is that of its root. Rows are sorted by these numbers
(`island_sort`), so their order depends on which link becomes the root.

All this depends on the overlaps and user constraints only; it is kept until they change, if nothing sleeps.
"""

import warp as wp

from carom.kernels.maths.union_find import find_root
from carom.kernels.solver.activity import (
    can_move,
    counts_as_moving,
    is_absent,
    is_in_force,
    is_left_out,
    ties_still_links,
)
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, func
from carom.layouts.contacts import OVERLAPS

NONE = wp.constant(-1)


@func
def join(model: Model, pair_rows: PairRows, world: Int32, a: Int32, b: Int32):
    """Join the islands of two links, if both can move; as in Bullet, b's root stays a root."""
    if a >= 0 and b >= 0 and counts_as_moving(model, a) and counts_as_moving(model, b):
        root = find_root(pair_rows.link_root, world, a)
        pair_rows.link_root[world, root] = find_root(pair_rows.link_root, world, b)


@func
def join_overlapping(model: Model, shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32):
    """Join links whose bounds overlap, in the order of the pair cache."""
    count = contacts.count_contacts[world, OVERLAPS]
    for row in range(count):
        pair_rows.order_row[world, contacts.overlap_place[world, row]] = row
    for place in range(count):
        pair = contacts.overlap_shapes[world, pair_rows.order_row[world, place]]
        join(model, pair_rows, world, shapes.shape_link[pair[0]], shapes.shape_link[pair[1]])


@func
def join_links(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Join all links that Bullet has in one island."""
    for link in range(settings.link_count):
        pair_rows.link_root[world, link] = link
    join_overlapping(model, shapes, contacts, pair_rows, world)
    for tree in range(settings.tree_count):
        before = Int32(NONE)
        first = model.tree[tree].first_link
        for link in range(first, first + model.tree[tree].link_count):
            if counts_as_moving(model, link):
                join(model, pair_rows, world, before, link)
                before = link
    for user in range(settings.user_count):
        if is_in_force(state, users, world, user):
            join(model, pair_rows, world, users.user_link_a[user], users.user_link_b[user])


@func
def number_islands(settings: Settings, model: Model, state: State, pair_rows: PairRows, world: Int32):
    """Write the number of each tree's island to `tree_number`, -1 for those absent or unable to move."""
    for tree in range(settings.tree_count):
        number = Int32(NONE)
        first = model.tree[tree].first_link
        link = first + model.tree[tree].link_count - 1
        if is_absent(state, world, tree) or not can_move(model, tree):
            link = first - 1
        while link >= first:
            if counts_as_moving(model, link):
                number = model.link[find_root(pair_rows.link_root, world, link)].number
                link = first
            link -= 1
        pair_rows.tree_number[world, tree] = number


@func
def count_rows(
    settings: Settings,
    model: Model,
    state: State,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    manifolds: Int32,
):
    """Count manifolds and constraints of each island that is awake in `number_size`; -1 for other numbers."""
    for number in range(settings.link_count):
        pair_rows.number_size[world, number] = NONE
    for tree in range(settings.tree_count):
        number = pair_rows.tree_number[world, tree]
        if number >= 0 and not is_left_out(state, world, tree):
            pair_rows.number_size[world, number] = 0
    for place in range(manifolds):
        pair_rows.number_size[world, pair_rows.order_island[world, place]] += 1
    for constraint in range(settings.constraint_count):
        number = pair_rows.tree_number[world, model.constraint[constraint].tree]
        if ties_still_links(model, users, constraint):
            number = Int32(NONE)
        if number >= 0 and pair_rows.number_size[world, number] >= 0:
            pair_rows.number_size[world, number] += 1


@func
def batch_islands(
    settings: Settings,
    model: Model,
    state: State,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    manifolds: Int32,
):
    """Find which islands are solved together, and write the first tree of each batch to `batch_tree`.

    In order of their numbers, islands are added to a batch until it has more manifolds and constraints than
    the minimum. The manifolds, sorted by island, are the first of `order_row`.
    """
    count_rows(settings, model, state, users, pair_rows, world, manifolds)
    batch = Int32(0)
    size = Int32(0)
    for number in range(settings.link_count):
        own = pair_rows.number_size[world, number]
        pair_rows.number_batch[world, number] = batch
        pair_rows.number_first[world, number] = NONE
        if own >= 0:
            size += own
            if size > settings.minimum_island_size:
                batch = number + 1
                size = Int32(0)
    for tree in range(settings.tree_count):
        state.batch_tree[world, tree] = tree
        number = pair_rows.tree_number[world, tree]
        if number >= 0 and not is_left_out(state, world, tree):
            batch = pair_rows.number_batch[world, number]
            if pair_rows.number_first[world, batch] == NONE:
                pair_rows.number_first[world, batch] = tree
            state.batch_tree[world, tree] = pair_rows.number_first[world, batch]
