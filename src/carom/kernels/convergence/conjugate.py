"""Nonsmooth conjugate gradients for islands at rest: they speed up the convergence of the sweeps.

A sweep of projected Gauss-Seidel takes the place of the gradient in the method of Fletcher and Reeves.
After it the impulses are moved further, along a share of the last search direction; the next sweep brings
them back within their bounds (M. Silcowitz-Hansen, S. Niebe, K. Erleben, A nonsmooth nonlinear conjugate
gradient method for interactive contact force problems, The Visual Computer 26, 2010).
"""

import warp as wp

from carom.kernels.solver.rigid_manifolds import push_manifold_block
from carom.kernels.structs import PairRows, Scratch
from carom.kernels.types import Int32, Vector4, Vector8, func, real


@func
def remember_impulses(pair_rows: PairRows, world: Int32, manifold_blocks: Int32):
    """Save the impulses before a sweep."""
    for manifold_block in range(manifold_blocks):
        normal = pair_rows.manifold_block[world, manifold_block].normal_impulse
        friction = pair_rows.manifold_block[world, manifold_block].friction_impulse
        pair_rows.manifold_block[world, manifold_block].normal_before = normal
        pair_rows.manifold_block[world, manifold_block].friction_before = friction


@func
def impulse_changes(pair_rows: PairRows, world: Int32, manifold_block: Int32):
    """Changes of the impulses of a manifold block by the last sweep: normal, friction."""
    normal = pair_rows.manifold_block[world, manifold_block].normal_impulse
    friction = pair_rows.manifold_block[world, manifold_block].friction_impulse
    return (
        normal - pair_rows.manifold_block[world, manifold_block].normal_before,
        friction - pair_rows.manifold_block[world, manifold_block].friction_before,
    )


@func
def go_on(
    scratch: Scratch, pair_rows: PairRows, world: Int32, manifold_blocks: Int32, last_square: real
) -> real:
    """Move the impulses further, so that their total change is conjugate to the last search direction.

    `remember_impulses` was called before the sweep. Returns the squared norm of the change of impulses by the
    sweep; `last_square` is the same of the sweep before, 0 after the first one.
    """
    square = real(0.0)
    for manifold_block in range(manifold_blocks):
        normal, friction = impulse_changes(pair_rows, world, manifold_block)
        square += wp.dot(normal, normal) + wp.dot(friction, friction)
    share = square / last_square if square < last_square else 0.0
    for manifold_block in range(manifold_blocks):
        normal, friction = impulse_changes(pair_rows, world, manifold_block)
        if share > 0.0:
            further = share * pair_rows.manifold_block[world, manifold_block].normal_search
            aside = share * pair_rows.manifold_block[world, manifold_block].friction_search
            pair_rows.manifold_block[world, manifold_block].normal_impulse += further
            pair_rows.manifold_block[world, manifold_block].friction_impulse += aside
            push_manifold_block(scratch, pair_rows, world, manifold_block, further, aside)
            normal += further
            friction += aside
        if share == 0.0 and last_square > 0.0:
            normal = Vector4(0.0, 0.0, 0.0, 0.0)
            friction = Vector8(0.0)
        pair_rows.manifold_block[world, manifold_block].normal_search = normal
        pair_rows.manifold_block[world, manifold_block].friction_search = friction
    return square
