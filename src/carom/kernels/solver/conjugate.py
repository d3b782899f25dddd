"""Conjugate directions: what makes the sweeps over the patches of a calm island converge quickly.

A sweep of projected Gauss-Seidel takes the place of the gradient in the method of Fletcher and Reeves.
After it the impulses go on along what is left of the last direction; the next sweep takes back what their
bounds forbid (M. Silcowitz-Hansen, S. Niebe, K. Erleben, A nonsmooth nonlinear conjugate gradient method
for interactive contact force problems, The Visual Computer 26, 2010).
"""

import warp as wp

from carom.kernels.solver.patches import push_patch
from carom.kernels.structs import Couplings, Scratch
from carom.kernels.types import Int32, Vector4, Vector8, func, real


@func
def remember_impulses(couplings: Couplings, world: Int32, patches: Int32):
    """Keep the impulses from which a sweep starts."""
    patch = Int32(0)
    while patch < patches:
        couplings.patch[world, patch].normal_before = couplings.patch[world, patch].normal_impulse
        couplings.patch[world, patch].friction_before = couplings.patch[world, patch].friction_impulse
        patch += 1


@func
def squared_change(couplings: Couplings, world: Int32, patches: Int32) -> real:
    """How far the last sweep moved the impulses, squared."""
    square = real(0.0)
    patch = Int32(0)
    while patch < patches:
        normal = couplings.patch[world, patch].normal_impulse - couplings.patch[world, patch].normal_before
        friction = (
            couplings.patch[world, patch].friction_impulse - couplings.patch[world, patch].friction_before
        )
        square += wp.dot(normal, normal) + wp.dot(friction, friction)
        patch += 1
    return square


@func
def go_on(scratch: Scratch, couplings: Couplings, world: Int32, patches: Int32, last_square: real) -> real:
    """Move the impulses on along a direction conjugate to the last one.

    Args:
        scratch: Changes of the velocities.
        couplings: The patches; `remember_impulses` was called before the sweep.
        world: The world.
        patches: Their number.
        last_square: What this returned after the sweep before; 0 after the first.

    Returns:
        How far the sweep moved the impulses, squared.
    """
    square = squared_change(couplings, world, patches)
    share = real(0.0)
    if square < last_square:
        share = square / last_square
    patch = Int32(0)
    while patch < patches:
        normal = couplings.patch[world, patch].normal_impulse - couplings.patch[world, patch].normal_before
        friction = (
            couplings.patch[world, patch].friction_impulse - couplings.patch[world, patch].friction_before
        )
        if share > 0.0:
            further = share * couplings.patch[world, patch].normal_search
            aside = share * couplings.patch[world, patch].friction_search
            couplings.patch[world, patch].normal_impulse = (
                couplings.patch[world, patch].normal_impulse + further
            )
            couplings.patch[world, patch].friction_impulse = (
                couplings.patch[world, patch].friction_impulse + aside
            )
            push_patch(scratch, couplings, world, patch, further, aside)
            normal += further
            friction += aside
        if share == 0.0 and last_square > 0.0:
            normal = Vector4(0.0, 0.0, 0.0, 0.0)
            friction = Vector8(0.0)
        couplings.patch[world, patch].normal_search = normal
        couplings.patch[world, patch].friction_search = friction
        patch += 1
    return square
