"""The order of trees in the matrices of an island: neighbours are near each other (Cuthill and McKee 1969).

Elimination fills a row of blocks up to the last block that its tree is coupled with, so the factor is as wide
as neighbours are far apart. Trees are visited breadth first along contacts, from one with the fewest of them.
"""

import warp as wp

from carom.kernels.newton.members import place_of
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.structs import Contacts, Model, NewtonWork, PairRows, Shapes
from carom.kernels.types import Index2, Int32, func
from carom.layouts.newton import MEMBERS

# With fewer links between trees any order will do.
_FEWEST = 3


@func
def trees_of(model: Model, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32) -> Index2:
    """Trees of both sides of a contact; those without dofs are the world, -1."""
    pair = contacts.contact_shapes[world, contact]
    a, b = shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]]
    return Index2(
        wp.where(tree_blocks(model, a) > 0, a, Int32(-1)), wp.where(tree_blocks(model, b) > 0, b, Int32(-1))
    )


@func
def add_neighbour(work: NewtonWork, world: Int32, entry: Int32, tree: Int32, other: Int32):
    """Begin the list of a tree's neighbours with another tree."""
    work.neighbour_tree[world, entry] = other
    work.neighbour_next[world, entry] = work.tree_neighbour[world, tree]
    work.tree_neighbour[world, tree] = entry
    work.tree_degree[world, tree] = work.tree_degree[world, tree] + 1


@func
def list_neighbours(
    model: Model,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    first: Int32,
) -> Int32:
    """Write the lists of neighbours of an island whose first contact this is; returns their length in all."""
    contact = first + 0
    while contact >= 0:
        trees = trees_of(model, shapes, contacts, world, contact)
        for side in range(2):
            if trees[side] >= 0:
                work.tree_neighbour[world, trees[side]] = -1
                work.tree_degree[world, trees[side]] = 0
        contact = pair_rows.contact_next[world, contact]
    count = Int32(0)
    last = Index2(-1, -1)
    contact = first + 0
    while contact >= 0 and count + 2 <= work.neighbour_tree.shape[1]:
        trees = trees_of(model, shapes, contacts, world, contact)
        # Contacts of a pair of shapes follow each other.
        is_new = trees[0] != last[0] or trees[1] != last[1]
        if trees[0] >= 0 and trees[1] >= 0 and trees[0] != trees[1] and is_new:
            add_neighbour(work, world, count, trees[0], trees[1])
            add_neighbour(work, world, count + 1, trees[1], trees[0])
            count += 2
            last = trees
        contact = pair_rows.contact_next[world, contact]
    return count


@func
def order_members(
    model: Model,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    root: Int32,
):
    """Give places to the trees of an island without any so far, as far as contacts connect them."""
    first = pair_rows.tree_first_contact[world, root]
    if list_neighbours(model, shapes, contacts, pair_rows, work, world, first) < 2 * _FEWEST:
        return
    start = Int32(-1)
    contact = first + 0
    while contact >= 0:
        trees = trees_of(model, shapes, contacts, world, contact)
        for side in range(2):
            tree = trees[side]
            if tree >= 0:
                degree = work.tree_degree[world, tree]
                if degree > 0 and (start < 0 or degree < work.tree_degree[world, start]):
                    start = tree + 0
        contact = pair_rows.contact_next[world, contact]
    place_of(model, work, world, start)
    member = Int32(0)
    while member < work.count_newton[world, MEMBERS]:
        entry = work.tree_neighbour[world, work.tree_member[world, member]]
        while entry >= 0:
            place_of(model, work, world, work.neighbour_tree[world, entry])
            entry = work.neighbour_next[world, entry]
        member += 1
