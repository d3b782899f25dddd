"""Joint-space inertia matrix of a tree, its factorisation and its inverse.

Matrices over the n active dofs of a tree are stored by rows of ceil(n/4) blocks of four columns, so that
row operations process four columns at a time. Dofs are numbered from the root, so the factorisation
H = Lᵀ D L causes no fill-in: an entry is zero unless one dof is an ancestor of the other
(R. Featherstone, Efficient factorization of the joint-space inertia matrix for branched kinematic
trees, IJRR 2005). Its pivots D are the articulated inertias of the dofs.

Inner loops use `while`: Warp's `range` costs as much as the body of these loops.
"""

import warp as wp

from carom.kernels.maths.blocks import add_multiple, fill_zero, write_multiple
from carom.kernels.structs import Model, Scratch
from carom.kernels.types import Int32, func, real

# A dof with less articulated inertia than this cannot be accelerated (double precision epsilon).
LEAST_PIVOT = real(2.220446049250313e-16)


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

            row = matrix + (dof - first) * blocks
            fill_zero(scratch.block_factor, row, world, blocks)
            other = dof + 0
            while other >= 0:
                scratch.entry_factor[world, 4 * row + other - first] = wp.dot(
                    scratch.dof[world, other].angular, spin
                ) + wp.dot(scratch.dof[world, other].linear, push)
                other = model.dof[other].parent
            dof += 1

        if link > base:
            parent = model.link[link].parent
            scratch.link[world, parent].composite_mass += mass
            scratch.link[world, parent].composite_first += moment
            scratch.link[world, parent].composite_inertia += inertia


@func
def factorise(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Replace the joint-space inertia in `block_factor` by L, and store the inverses of the pivots D."""
    first = model.tree[tree].first_dof
    count = model.tree[tree].dof_count
    blocks = (count + 3) // 4
    matrix = model.tree[tree].first_block
    k = count - 1
    row = matrix + k * blocks
    while k >= 0:
        pivot = scratch.entry_factor[world, 4 * row + k]
        inverse = real(0.0)
        if pivot >= LEAST_PIVOT:
            inverse = 1.0 / pivot
        scratch.dof[world, first + k].inverse_pivot = inverse
        i = Int32(0)
        target = matrix + 0
        while i < k:
            entry = scratch.entry_factor[world, 4 * row + i]
            if entry != 0.0:
                add_multiple(
                    scratch.block_factor, target, -entry * inverse, scratch.block_factor, row, world,
                    i // 4 + 1,
                )  # fmt: skip
            i += 1
            target += blocks
        # The row of L: last, because the steps above need the unscaled row.
        write_multiple(scratch.block_factor, row, inverse, scratch.block_factor, row, world, k // 4 + 1)
        k -= 1
        row -= blocks


@func
def solve(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Replace the generalized forces in `dof_force` by the accelerations they cause."""
    first = model.tree[tree].first_dof
    count = model.tree[tree].dof_count
    blocks = (count + 3) // 4
    matrix = model.tree[tree].first_block
    k = count - 1
    while k >= 0:
        force = scratch.dof[world, first + k].force
        row = matrix + k * blocks
        i = Int32(0)
        while i < k:
            scratch.dof[world, first + i].force -= scratch.entry_factor[world, 4 * row + i] * force
            i += 1
        k -= 1
    k = Int32(0)
    while k < count:
        acceleration = scratch.dof[world, first + k].force * scratch.dof[world, first + k].inverse_pivot
        row = matrix + k * blocks
        i = Int32(0)
        while i < k:
            acceleration -= scratch.entry_factor[world, 4 * row + i] * scratch.dof[world, first + i].force
            i += 1
        scratch.dof[world, first + k].force = acceleration
        k += 1


@func
def invert(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Fill `block_inverse_mass` with the inverse A of the joint-space inertia.

    L A = D⁻¹ L⁻ᵀ is upper triangular, which gives the rows of A one after the other:
    A[i, c] = -Σ L[i, j] A[j, c] over j < i for c < i; on the diagonal, 1 / D[i] is added.
    """
    first = model.tree[tree].first_dof
    count = model.tree[tree].dof_count
    blocks = (count + 3) // 4
    matrix = model.tree[tree].first_block
    i = Int32(0)
    row = matrix + 0
    while i < count:
        fill_zero(scratch.block_inverse_mass, row, world, blocks)
        j = Int32(0)
        source = matrix + 0
        while j < i:
            entry = scratch.entry_factor[world, 4 * row + j]
            if entry != 0.0:
                add_multiple(
                    scratch.block_inverse_mass, row, -entry, scratch.block_inverse_mass, source, world,
                    i // 4 + 1,
                )  # fmt: skip
            j += 1
            source += blocks
        # Column i of the rows above is not filled yet, so the diagonal is summed separately.
        diagonal = scratch.dof[world, first + i].inverse_pivot
        j = Int32(0)
        source = matrix + 0
        while j < i:
            value = scratch.entry_inverse_mass[world, 4 * row + j]
            diagonal -= scratch.entry_factor[world, 4 * row + j] * value
            scratch.entry_inverse_mass[world, 4 * source + i] = value
            j += 1
            source += blocks
        scratch.entry_inverse_mass[world, 4 * row + i] = diagonal
        i += 1
        row += blocks
