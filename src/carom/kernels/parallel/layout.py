"""Dividing the workspace of a world among its islands."""

import warp as wp

from carom.kernels.parallel.workspace import (
    JACOBIAN,
    MANIFOLD_BLOCK,
    MATRICES,
    PAIR_ROW,
    ROW,
    SINGLE,
    TERMS,
    UNIT,
    VISIT,
    Window,
)
from carom.kernels.solver.articulated_manifolds import VECTORS_PER_BLOCK
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.solver.units import next_unit, places_of_single, twists
from carom.kernels.solver.warm_starting import is_rigid
from carom.kernels.structs import (
    Contacts,
    IslandWork,
    Model,
    PairRows,
    Settings,
    Shapes,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, func
from carom.layouts.codes import MAX_ROWS_PER_CONSTRAINT, USER
from carom.layouts.pair_rows import ROWS_PER_PAIR


@func
def room_for_constraints(
    model: Model, users: UserConstraints, pair_rows: PairRows, world: Int32, root: Int32
) -> Window:
    """Maximum room for the motors, limits and user constraints of an island."""
    room = Window()
    constraint = pair_rows.tree_first_constraint[world, root]
    while constraint >= 0:
        if model.constraint[constraint].kind != USER:
            room[ROW] += MAX_ROWS_PER_CONSTRAINT
            room[VISIT] += MAX_ROWS_PER_CONSTRAINT
        else:
            user = model.constraint[constraint].link
            blocks = tree_blocks(model, users.user_tree_a[user]) + tree_blocks(model, users.user_tree_b[user])
            room[VISIT] += ROWS_PER_PAIR
            room[PAIR_ROW] += ROWS_PER_PAIR
            room[JACOBIAN] += ROWS_PER_PAIR * blocks
        constraint = pair_rows.constraint_next[world, constraint]
    return room


@func
def room_for_contacts(
    settings: Settings,
    model: Model,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    world: Int32,
    root: Int32,
) -> Window:
    """Maximum room for the contacts of an island.

    All articulated manifold blocks write their rows to the same place, one block after the other.
    """
    room = Window()
    temporary = Int32(0)
    contact = pair_rows.tree_first_contact[world, root]
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        a = shapes.shape_tree[pair[0]]
        b = shapes.shape_tree[pair[1]]
        blocks = tree_blocks(model, a) + tree_blocks(model, b)
        rigid = is_rigid(model, a) and is_rigid(model, b)
        members, count = next_unit(shapes, contacts, pair_rows, world, contact, rigid)
        room[UNIT] += 1
        room[TERMS] = wp.max(room[TERMS], count)
        if count == 1:
            places = places_of_single(settings, rigid, twists(shapes, contacts, world, contact))
            room[SINGLE] += places
            if places == 0:
                room[PAIR_ROW] += ROWS_PER_PAIR
                room[JACOBIAN] += ROWS_PER_PAIR * blocks
        else:
            room[MANIFOLD_BLOCK] += 1
            if not rigid:
                room[MATRICES] += VECTORS_PER_BLOCK * blocks
                temporary = wp.max(temporary, ROWS_PER_PAIR * blocks)
        contact = pair_rows.contact_next[world, members[count - 1]]
    if temporary > 0:
        room[PAIR_ROW] += ROWS_PER_PAIR
        room[JACOBIAN] += temporary
    return room


@func
def lay_out_islands(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    work: IslandWork,
    world: Int32,
):
    """Give each island a window of its own, in the order of their roots."""
    free = Window()
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            room = room_for_constraints(model, users, pair_rows, world, tree) + room_for_contacts(
                settings, model, shapes, contacts, pair_rows, world, tree
            )
            work.tree_window[world, tree] = free
            work.tree_room[world, tree] = room
            free += room
