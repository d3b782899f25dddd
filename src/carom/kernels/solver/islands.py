"""Islands: groups of trees joined by contacts or user constraints, each of which is solved separately.

They are found by union-find over the trees. The root of each island then gets linked lists of the island's
constraints, in ascending order, and contacts.
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
    """Root of the island of a tree; compresses the path to it."""
    root = tree + 0
    while state.tree_island[world, root] != root:
        above = state.tree_island[world, root]
        state.tree_island[world, root] = state.tree_island[world, above]
        root = state.tree_island[world, root]
    return root


@func
def unite(model: Model, state: State, world: Int32, a: Int32, b: Int32):
    """Join the islands of two trees, unless one of the trees cannot move."""
    if can_move(model, a) and can_move(model, b):
        root_a = island_root(state, world, a)
        root_b = island_root(state, world, b)
        state.tree_island[world, wp.max(root_a, root_b)] = wp.min(root_a, root_b)


@func
def unite_tied(settings: Settings, model: Model, state: State, users: UserConstraints, world: Int32):
    """Put trees that user constraints join into one island."""
    for user in range(settings.user_count):
        if users.user_enabled[world, user] != 0:
            unite(model, state, world, users.user_tree_a[user], users.user_tree_b[user])


@func
def note_contact(pair_rows: PairRows, world: Int32, tree: Int32, touches: Int32):
    """Add the bits of a contact, `contact_traits`, to those of a tree."""
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
    """Find islands, and list the constraints and contacts of each; also mark islands at rest.

    Constraints and contacts of trees that are asleep are left out.
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
    list_contacts(settings, model, state, shapes, contacts, users, pair_rows, world)
    find_resting_islands(settings, model, state, pair_rows, world)


@func
def may_be_pushed(model: Model, pair_rows: PairRows, world: Int32, tree: Int32) -> bool:
    """Whether contacts, user constraints, motors or limits can act on a tree."""
    return pair_rows.tree_contacts[world, tree] != 0 or model.tree[tree].constraint_count > 0
