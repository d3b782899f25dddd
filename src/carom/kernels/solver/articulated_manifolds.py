"""Manifold blocks of articulated bodies; see `rigid_manifolds`.

Their matrices are in `PairRows.matrix_block`, one after the other, each for tree a and then tree b: the
weighted Jacobians of the normals, one vector of four for each dof; those of friction, two vectors for each;
the responses to the normals, four vectors for each block of dofs; those to friction, eight.

Functions exist in two versions for speed: for rigid and articulated bodies, since matrices of fixed size stay
in registers; for normals and friction, since compilers have to know the width of vectors.
"""

from carom.kernels.maths.blocks import add_combination4, add_combination8, combine4, combine8
from carom.kernels.solver.rigid_manifolds import (
    bounded_normals,
    friction_alone,
    friction_residual,
    normal_residual,
    normals_alone,
    relaxed_friction,
)
from carom.kernels.structs import PairRows, Scratch, Settings
from carom.kernels.types import Index4, Int32, Vector4, Vector8, func, real

# Number of vectors, in all matrices of an articulated manifold block, per block of dofs of its trees.
VECTORS_PER_BLOCK = 24


@func
def matrix_parts(matrices: Int32, place: Index4) -> Index4:
    """First blocks of the four matrices of a manifold block."""
    blocks = place[1] + place[3]
    return Index4(matrices, matrices + 4 * blocks, matrices + 12 * blocks, matrices + 16 * blocks)


@func
def push_articulated(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    normals: Vector4,
    friction: Vector8,
):
    """Move the bodies of a manifold block by changes of its impulses."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    for side in range(2):
        if place[2 * side + 1] > 0:
            add_combination4(
                scratch.delta_velocity, place[2 * side], normals, pair_rows.matrix_block,
                part[2] + 4 * place[1] * side, 1, world, place[2 * side + 1],
            )  # fmt: skip
            add_combination8(
                scratch.delta_velocity, place[2 * side], friction, pair_rows.matrix_block,
                part[3] + 8 * place[1] * side, world, place[2 * side + 1],
            )  # fmt: skip


@func
def relax_articulated_normals(
    scratch: Scratch, pair_rows: PairRows, world: Int32, manifold_block: Int32, before: real
) -> real:
    """Relax the normal rows of a manifold block; returns as `normal_residual`."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    wanted = normals_alone(pair_rows, world, manifold_block)
    for side in range(2):
        if place[2 * side + 1] > 0:
            start = part[0] + 4 * place[1] * side
            wanted -= combine4(
                pair_rows.matrix_block, start, 1, scratch.delta_velocity, place[2 * side], world,
                place[2 * side + 1],
            )  # fmt: skip
    pair_rows.manifold_block[world, manifold_block].normal_wanted = wanted
    change = bounded_normals(pair_rows.manifold_block, world, manifold_block)
    for side in range(2):
        if place[2 * side + 1] > 0:
            start = part[2] + 4 * place[1] * side
            add_combination4(
                scratch.delta_velocity, place[2 * side], change, pair_rows.matrix_block, start, 1, world,
                place[2 * side + 1],
            )  # fmt: skip
    return normal_residual(pair_rows, world, manifold_block, change, before)


@func
def relax_articulated_friction(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    before: real,
) -> real:
    """Relax the friction rows of a manifold block; returns as `friction_residual`."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    wanted = friction_alone(pair_rows, world, manifold_block)
    # Two contacts have the first half of each vector.
    halves = Int32(pair_rows.manifold_block[world, manifold_block].count <= 2)
    first = Vector4(wanted[0], wanted[1], wanted[2], wanted[3])
    for side in range(2):
        if place[2 * side + 1] > 0:
            start = part[1] + 8 * place[1] * side
            if halves == 1:
                first -= combine4(
                    pair_rows.matrix_block, start, 2, scratch.delta_velocity, place[2 * side], world,
                    place[2 * side + 1],
                )  # fmt: skip
            else:
                wanted -= combine8(
                    pair_rows.matrix_block, start, scratch.delta_velocity, place[2 * side], world,
                    place[2 * side + 1],
                )  # fmt: skip
    if halves == 1:
        wanted = Vector8(first[0], first[1], first[2], first[3], wanted[4], wanted[5], wanted[6], wanted[7])
    pair_rows.manifold_block[world, manifold_block].friction_wanted = wanted
    change = relaxed_friction(settings, pair_rows, world, manifold_block)
    for side in range(2):
        if place[2 * side + 1] > 0:
            start = part[3] + 8 * place[1] * side
            if halves == 1:
                add_combination4(
                    scratch.delta_velocity, place[2 * side],
                    Vector4(change[0], change[1], change[2], change[3]), pair_rows.matrix_block, start, 2,
                    world, place[2 * side + 1],
                )  # fmt: skip
            else:
                add_combination8(
                    scratch.delta_velocity, place[2 * side], change, pair_rows.matrix_block, start, world,
                    place[2 * side + 1],
                )  # fmt: skip
    return friction_residual(settings, pair_rows, world, manifold_block, change, before)
