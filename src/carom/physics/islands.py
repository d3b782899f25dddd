"""Islands: groups of trees that contacts or user constraints join, solved one after the other.

Union-find over the trees; then each root gets linked lists of its constraints and contacts, in
ascending order.
"""

import warp as wp

from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Int32, func
from carom.model.structs import Model, Settings, State
from carom.physics.activity import is_asleep

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
def can_move(model: Model, tree: Int32) -> bool:
    """Whether a tree has dofs; the world, -1, has none."""
    if tree < 0:
        return False
    return model.tree[tree].dof_count > 0


@func
def unite(model: Model, state: State, world: Int32, a: Int32, b: Int32):
    """Put two trees into one island, unless one of them cannot move."""
    if can_move(model, a) and can_move(model, b):
        root_a = island_root(state, world, a)
        root_b = island_root(state, world, b)
        state.tree_island[world, wp.max(root_a, root_b)] = wp.min(root_a, root_b)


@func
def moving_tree(model: Model, a: Int32, b: Int32) -> Int32:
    """The first of two trees that can move."""
    if can_move(model, a):
        return a
    return b


@func
def build_islands(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    world: Int32,
):
    """Join trees that touch or are tied together, and list the constraints and contacts of each island.

    Those of trees that are asleep are left out.
    """
    contact_count = contacts.count_contacts[world, 0]
    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = model.tree[tree].batch
        couplings.tree_touches[world, tree] = 0
    for contact in range(contact_count):
        pair = contacts.contact_shapes[world, contact]
        tree_a = shapes.shape_tree[pair[0]]
        tree_b = shapes.shape_tree[pair[1]]
        unite(model, state, world, tree_a, tree_b)
        couplings.tree_touches[world, tree_a] = 1
        couplings.tree_touches[world, tree_b] = 1
    for user in range(settings.user_count):
        unite(model, state, world, users.user_tree_a[user], users.user_tree_b[user])

    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = island_root(state, world, tree)
        couplings.tree_first_constraint[world, tree] = _NONE
        couplings.tree_first_contact[world, tree] = _NONE
    constraint = settings.constraint_count - 1
    while constraint >= 0:
        tree = model.constraint[constraint].tree
        if not is_asleep(state, world, tree):
            root = state.tree_island[world, tree]
            couplings.constraint_next[world, constraint] = couplings.tree_first_constraint[world, root]
            couplings.tree_first_constraint[world, root] = constraint
        constraint -= 1
    contact = contact_count - 1
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        tree = moving_tree(model, shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]])
        if not is_asleep(state, world, tree):
            root = state.tree_island[world, tree]
            couplings.contact_next[world, contact] = couplings.tree_first_contact[world, root]
            couplings.tree_first_contact[world, root] = contact
        contact -= 1


@func
def may_be_pushed(model: Model, couplings: Couplings, world: Int32, tree: Int32) -> bool:
    """Whether contacts, user constraints, motors or limits can act on a tree."""
    return couplings.tree_touches[world, tree] != 0 or model.tree[tree].constraint_count > 0
