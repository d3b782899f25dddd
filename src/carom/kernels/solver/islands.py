"""Islands: groups of trees, each of which is solved separately.

They are found by union-find over the trees. The root of each island then gets linked lists of the island's
constraints and contacts, in the order in which they are relaxed.
"""

import warp as wp

from carom.kernels.maths.union_find import find_root
from carom.kernels.solver.activity import (
    can_move,
    counts_as_moving,
    is_asleep,
    is_in_force,
    is_left_out,
    link_moves,
    ties_still_links,
)
from carom.kernels.solver.bullet_islands import batch_islands, join_links, number_islands
from carom.kernels.solver.contact_order import list_contacts, sort_manifolds
from carom.kernels.solver.island_sort import sort_constraints
from carom.kernels.solver.warm_starting import ANCHORED, MOVING, contact_traits, find_resting_islands
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, func
from carom.layouts.contacts import SORTED, THERE

_NONE = wp.constant(-1)


@func
def unite(model: Model, state: State, world: Int32, a: Int32, b: Int32):
    """Join the islands of two trees, unless one of the trees cannot move."""
    if can_move(model, a) and can_move(model, b):
        root_a = find_root(state.tree_island, world, a)
        root_b = find_root(state.tree_island, world, b)
        state.tree_island[world, wp.max(root_a, root_b)] = wp.min(root_a, root_b)


@func
def may_unite(model: Model, link: Int32) -> bool:
    """Whether constraints of a link may unite its tree with others: not those of one that is still."""
    return link_moves(model, link) or counts_as_moving(model, link)


@func
def unite_tied(settings: Settings, model: Model, state: State, users: UserConstraints, world: Int32):
    """Put trees that user constraints join into one island; as in Bullet, not by a link that is still."""
    for user in range(settings.user_count):
        a = users.user_link_a[user]
        b = users.user_link_b[user]
        if is_in_force(state, users, world, user) and a >= 0 and b >= 0:
            if may_unite(model, a) and may_unite(model, b):
                unite(model, state, world, users.user_tree_a[user], users.user_tree_b[user])


@func
def note_contact(pair_rows: PairRows, world: Int32, tree: Int32, touches: Int32):
    """Add the bits of a contact, `contact_traits`, to those of a tree."""
    pair_rows.tree_contacts[world, tree] = pair_rows.tree_contacts[world, tree] | touches


@func
def unite_touching(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    world: Int32,
):
    """Put trees that touch into one island, and note what contacts each tree has."""
    for contact in range(contacts.count_contacts[world, THERE]):
        pair = contacts.contact_shapes[world, contact]
        moves_a = link_moves(model, pair[2])
        moves_b = link_moves(model, pair[3])
        touches = contact_traits(settings, model, shapes, contacts, world, contact)
        if not moves_a or not moves_b:
            touches = touches | ANCHORED
        if moves_a:
            note_contact(pair_rows, world, shapes.shape_tree[pair[0]], touches)
        if moves_b:
            note_contact(pair_rows, world, shapes.shape_tree[pair[1]], touches)
        if moves_a and moves_b:
            unite(model, state, world, shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]])


@func
def sort_rows(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Bring the orders of manifolds and constraints, and Bullet's islands, up to date.

    They depend on the overlaps, the user constraints and which trees are present, and are kept until these
    change, if nothing sleeps.
    In other cases SORTED is negative.
    """
    lasts = Int32(1)
    for tree in range(settings.tree_count):
        if is_asleep(state, world, tree):
            lasts = Int32(0)
    if lasts == 1 and contacts.count_contacts[world, SORTED] > 0:
        return
    join_links(settings, model, state, shapes, contacts, users, pair_rows, world)
    number_islands(settings, model, state, pair_rows, world)
    sort_constraints(settings, model, state, users, pair_rows, world)
    manifolds = sort_manifolds(model, state, shapes, contacts, pair_rows, world)
    batch_islands(settings, model, state, users, pair_rows, world, manifolds)
    contacts.count_contacts[world, SORTED] = wp.where(lasts == 1, manifolds + 1, -1 - manifolds)


@func
def merge_moving(settings: Settings, state: State, pair_rows: PairRows, world: Int32):
    """Merge islands of trees that Bullet solves together, except those at rest."""
    for tree in range(settings.tree_count):
        pair_rows.tree_first_moving[world, tree] = _NONE
    for tree in range(settings.tree_count):
        island = state.tree_island[world, tree]
        if pair_rows.tree_rest[world, island] == MOVING and not is_left_out(state, world, tree):
            batch = state.batch_tree[world, island]
            if pair_rows.tree_first_moving[world, batch] == _NONE:
                pair_rows.tree_first_moving[world, batch] = tree
                pair_rows.tree_rest[world, tree] = Int32(MOVING)
            state.tree_island[world, tree] = pair_rows.tree_first_moving[world, batch]


@func
def list_constraints(
    settings: Settings,
    model: Model,
    state: State,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Make the linked list of constraints of each island; those of what cannot move are in none."""
    for tree in range(settings.tree_count):
        pair_rows.tree_first_constraint[world, tree] = _NONE
    place = settings.constraint_count + 0
    while place > 0:
        place -= 1
        constraint = state.batch_constraint[world, place]
        tree = model.constraint[constraint].tree
        moves = model.tree[tree].dof_count > 0 and not ties_still_links(model, users, constraint)
        if moves and not is_left_out(state, world, tree):
            root = state.tree_island[world, tree]
            pair_rows.constraint_next[world, constraint] = pair_rows.tree_first_constraint[world, root]
            pair_rows.tree_first_constraint[world, root] = constraint


@func
def build_islands(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Find islands, and list the constraints and contacts of each; also mark islands at rest.

    Trees that touch or are tied together are one island. Those at rest are solved by themselves; all others
    together with those that Bullet sweeps over together with them. Constraints and contacts of trees that are
    asleep or absent are left out.
    """
    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = tree
        pair_rows.tree_contacts[world, tree] = 0
    unite_touching(settings, model, state, shapes, contacts, pair_rows, world)
    unite_tied(settings, model, state, users, world)
    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = find_root(state.tree_island, world, tree)
    sort_rows(settings, model, state, shapes, contacts, users, pair_rows, world)
    find_resting_islands(settings, model, state, pair_rows, world)
    merge_moving(settings, state, pair_rows, world)
    list_constraints(settings, model, state, users, pair_rows, world)
    list_contacts(settings, model, state, shapes, contacts, pair_rows, world)


@func
def may_be_pushed(model: Model, pair_rows: PairRows, world: Int32, tree: Int32) -> bool:
    """Whether contacts, user constraints, motors or limits can act on a tree."""
    return pair_rows.tree_contacts[world, tree] != 0 or model.tree[tree].constraint_count > 0
