"""Making manifold blocks from contacts, and storing their impulses; see `rigid_manifolds`."""

import warp as wp

from carom.kernels.solver.articulated_manifold_rows import clear_matrices, write_articulated_contact
from carom.kernels.solver.contact_terms import keep_contact_impulse
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.solver.rigid_manifold_rows import write_rigid_rows
from carom.kernels.solver.rigid_manifolds import ManifoldBlocks, ManifoldSides
from carom.kernels.solver.warm_starting import SOLVED, SOLVED_AND_HOLDS, holds
from carom.kernels.structs import (
    Contacts,
    Model,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
)
from carom.kernels.types import Index4, Int32, func

# An empty struct would be written twice: where it is made, and where it is stored.
_CLEAR = """
    auto* bytes = reinterpret_cast<char*>(&wp::index(rows, world, row));
    #pragma clang loop vectorize(enable)
    for (unsigned i = 0; i < sizeof(wp::index(rows, world, row)); ++i)
        bytes[i] = 0;
"""


@wp.func_native(_CLEAR)
def clear_block(rows: ManifoldBlocks, world: Int32, row: Int32):
    """Set all numbers of a manifold block to zero."""
    ...


@wp.func_native(_CLEAR)
def clear_side(rows: ManifoldSides, world: Int32, row: Int32):
    """As `clear_block`, of the matrices of one of its bodies."""
    ...


@func
def tree_place(model: Model, tree: Int32) -> Int32:
    """First block of a tree in `delta_velocity`; 0 for the world, -1."""
    return Int32(0) if tree < 0 else model.tree[tree].first_delta


@func
def write_manifold_block(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    members: Index4,
    count: Int32,
    a: Int32,
    b: Int32,
    matrices: Int32,
    temporary: Int32,
):
    """Write the rows of the `count` contacts in `members`, of trees a and b, from their `PairRows.terms`.

    `matrices` is the first block of their matrices in `PairRows.matrix_block`, -1 if both trees are rigid
    bodies. Blocks from `temporary` on, for rows over two trees, are workspace.
    """
    clear_block(pair_rows.manifold_block, world, manifold_block)
    pair_rows.manifold_block[world, manifold_block].place = Index4(
        tree_place(model, a), tree_blocks(model, a), tree_place(model, b), tree_blocks(model, b)
    )
    pair_rows.manifold_block[world, manifold_block].matrices = matrices
    pair_rows.manifold_block[world, manifold_block].members = members
    pair_rows.manifold_block[world, manifold_block].count = count
    if matrices < 0:
        for body in range(2):
            clear_side(pair_rows.side, world, 2 * manifold_block + body)
        write_rigid_rows(settings, model, state, scratch, shapes, pair_rows, world, manifold_block, a, b)
        return
    clear_matrices(pair_rows, world, manifold_block)
    contact = Int32(0)
    while contact < count:
        write_articulated_contact(
            settings, model, state, scratch, shapes, pair_rows, pair_rows.terms[world, contact], world,
            manifold_block, contact, temporary,
        )  # fmt: skip
        contact += 1


@func
def keep_manifold_impulses(
    contacts: Contacts, pair_rows: PairRows, world: Int32, manifold_block: Int32, outcome: Int32
):
    """Store the impulses of a manifold block's contacts, and the `outcome` of solving them."""
    normal = pair_rows.manifold_block[world, manifold_block].normal_impulse
    lateral = pair_rows.manifold_block[world, manifold_block].friction_impulse
    friction = pair_rows.manifold_block[world, manifold_block].friction
    members = pair_rows.manifold_block[world, manifold_block].members
    if outcome == SOLVED and holds(pair_rows, world, manifold_block):
        outcome = Int32(SOLVED_AND_HOLDS)
    for i in range(pair_rows.manifold_block[world, manifold_block].count):
        keep_contact_impulse(
            contacts, world, members[i], normal[i], lateral[2 * i], lateral[2 * i + 1], friction[i], outcome
        )
