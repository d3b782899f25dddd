"""Islands: groups of trees that contacts or user constraints join, solved one after the other.

Union-find over the trees; then each root gets linked lists of its constraints, in ascending order, and
contacts.
"""

import warp as wp

from carom.kernels.solver.activity import can_move, is_asleep, link_moves
from carom.kernels.solver.contact_order import list_contacts
from carom.kernels.solver.warm_starting import ANCHORED, contact_traits, find_resting_islands
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, func

_NONE = wp.constant(-1)


@func
def island_root(state: State, world: Int32, tree: Int32) -> Int32:
    """Root of the island of a tree; shortens the way there."""
    root = tree + 0
    while state.tree_island[world, root] != root:
        above = state.tree_island[world, root]
        state.tree_island[world, root] = state.tree_island[world, above]
        root = state.tree_island[world, root]
    return root


@func
def unite(model: Model, state: State, world: Int32, a: Int32, b: Int32):
    """Put two trees into one island, unless one of them cannot move."""
    if can_move(model, a) and can_move(model, b):
        root_a = island_root(state, world, a)
        root_b = island_root(state, world, b)
        state.tree_island[world, wp.max(root_a, root_b)] = wp.min(root_a, root_b)


@func
def unite_tied(settings: Settings, model: Model, state: State, users: UserConstraints, world: Int32):
    """Put trees that user constraints tie together into one island."""
    for user in range(settings.user_count):
        if users.user_enabled[world, user] != 0:
            unite(model, state, world, users.user_tree_a[user], users.user_tree_b[user])


@func
def note_contact(pair_rows: PairRows, world: Int32, tree: Int32, touches: Int32):
    """Note that a tree has a contact, and of what kind."""
    pair_rows.tree_contacts[world, tree] = pair_rows.tree_contacts[world, tree] | touches


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
    """Join trees that touch or are tied together, and list the constraints and contacts of each island.

    Those of trees that are asleep are left out.
    """
    contact_count = contacts.count_contacts[world, 0]
    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = model.tree[tree].batch
        pair_rows.tree_contacts[world, tree] = 0
    for contact in range(contact_count):
        pair = contacts.contact_shapes[world, contact]
        moves_a = link_moves(model, pair[2])
        moves_b = link_moves(model, pair[3])
        touches = contact_traits(settings, shapes, contacts, world, contact)
        if not moves_a or not moves_b:
            touches = touches | ANCHORED
        if moves_a:
            note_contact(pair_rows, world, shapes.shape_tree[pair[0]], touches)
        if moves_b:
            note_contact(pair_rows, world, shapes.shape_tree[pair[1]], touches)
        if moves_a and moves_b:
            unite(model, state, world, shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]])
    unite_tied(settings, model, state, users, world)

    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = island_root(state, world, tree)
        pair_rows.tree_first_constraint[world, tree] = _NONE
    constraint = settings.constraint_count - 1
    while constraint >= 0:
        tree = model.constraint[constraint].tree
        if not is_asleep(state, world, tree):
            root = state.tree_island[world, tree]
            pair_rows.constraint_next[world, constraint] = pair_rows.tree_first_constraint[world, root]
            pair_rows.tree_first_constraint[world, root] = constraint
        constraint -= 1
    list_contacts(settings, model, state, shapes, contacts, pair_rows, world)
    find_resting_islands(settings, model, state, pair_rows, world)


@func
def may_be_pushed(model: Model, pair_rows: PairRows, world: Int32, tree: Int32) -> bool:
    """Whether contacts, user constraints, motors or limits can act on a tree."""
    return pair_rows.tree_contacts[world, tree] != 0 or model.tree[tree].constraint_count > 0
