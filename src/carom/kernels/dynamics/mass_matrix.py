"""Joint-space inertia matrix of a tree, its factorisation and its inverse.

Matrices over the n active dofs of a tree are stored by rows of ceil(n/4) blocks of four columns, so that
row operations process four columns at a time. Dofs are numbered from the root, so the factorisation
H = Lᵀ D L causes no fill-in: an entry is zero unless one dof is an ancestor of the other
(R. Featherstone, Efficient factorization of the joint-space inertia matrix for branched kinematic
trees, IJRR 2005). Its pivots D are the articulated inertias of the dofs.

Loops over few dofs use `while`: Warp's `range` costs as much as their bodies.
"""

import warp as wp

from carom.kernels.dynamics.matrix_rows import (
    factorise_rows,
    invert_rows,
    keep_rows,
    solve_rows,
    write_row,
)
from carom.kernels.structs import Model, Scratch
from carom.kernels.types import Int32, func, real

# A dof with less articulated inertia than this cannot be accelerated (double precision epsilon).
MIN_PIVOT = real(2.220446049250313e-16)


@func
def composite_inertia(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Fill `block_factor` with the joint-space inertia matrix (its lower triangle).

    Composite rigid body algorithm: the composite inertia of a link is that of its whole subtree.
    """
    base = model.tree[tree].first_link
    count = model.tree[tree].link_count
    first = model.tree[tree].first_dof
    blocks = (model.tree[tree].dof_count + 3) // 4
    matrix = model.tree[tree].first_block

    for i in range(count):
        link = base + count - 1 - i
        mass = scratch.link[world, link].composite_mass
        moment = scratch.link[world, link].composite_first
        inertia = scratch.link[world, link].composite_inertia

        first_dof = model.link[link].first_dof
        dof = first_dof + 0
        while dof < first_dof + model.link[link].dof_count:
            angular = scratch.dof[world, dof].angular
            linear = scratch.dof[world, dof].linear
            # Momentum of the subtree for a unit rate of this dof.
            spin = inertia * angular + wp.cross(moment, linear)
            push = mass * linear - wp.cross(moment, angular)

            write_row(
                scratch.block_factor, matrix + (dof - first) * blocks, blocks, scratch.dof, model.dof, first,
                dof, world, spin, push,
            )  # fmt: skip
            dof += 1

        if link > base:
            parent = model.link[link].parent
            scratch.link[world, parent].composite_mass += mass
            scratch.link[world, parent].composite_first += moment
            scratch.link[world, parent].composite_inertia += inertia


@func
def keep_inertia(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Copy the joint-space inertia into `mass_block`, where there is room for it."""
    keep_rows(
        scratch.mass_block, scratch.block_factor, model.tree[tree].first_block, world,
        model.tree[tree].dof_count,
    )  # fmt: skip


@func
def factorise(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Replace the joint-space inertia in `block_factor` by L, and store the inverses of the pivots D."""
    factorise_rows(
        scratch.block_factor, model.tree[tree].first_block, scratch.dof, model.tree[tree].first_dof, world,
        model.tree[tree].dof_count, MIN_PIVOT,
    )  # fmt: skip


@func
def solve(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Replace the generalized forces in `dof_force` by the accelerations they cause."""
    solve_rows(
        scratch.block_factor, model.tree[tree].first_block, scratch.dof, model.tree[tree].first_dof, world,
        model.tree[tree].dof_count,
    )  # fmt: skip


@func
def invert(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Fill `block_inverse_mass` with the inverse of the joint-space inertia."""
    invert_rows(
        scratch.block_inverse_mass, scratch.block_factor, model.tree[tree].first_block, scratch.dof,
        model.tree[tree].first_dof, world, model.tree[tree].dof_count,
    )  # fmt: skip
