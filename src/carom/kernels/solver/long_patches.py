"""Patches of trees of any size; see `patches`.

Their matrices are in `Couplings.run_block`, one after the other, each for tree a and then tree b: the
weighted Jacobians of the normals, a vector for each dof; those of friction, two for each; the responses
to the normals, four vectors for each block of dofs; those to friction, eight.
"""

import warp as wp

from carom.kernels.maths.blocks import add_combination4, add_combination8, combine4, combine8
from carom.kernels.solver.patches import bounded_friction, bounded_normals, friction_residual, normal_residual
from carom.kernels.structs import Couplings, Scratch, Settings
from carom.kernels.types import Index4, Int32, func, real

# Vectors of all matrices of a long patch for each block of dofs of its trees.
RUN_PER_BLOCK = 24


@func
def run_parts(run: Int32, place: Index4) -> Index4:
    """Where the four matrices of a patch start."""
    blocks = place[1] + place[3]
    return Index4(run, run + 4 * blocks, run + 12 * blocks, run + 16 * blocks)


@func
def relax_long_normals(scratch: Scratch, couplings: Couplings, world: Int32, patch: Int32) -> real:
    """Relax the normal rows of a patch; returns the greatest change of velocity squared."""
    place = couplings.patch[world, patch].place
    part = run_parts(couplings.patch[world, patch].run, place)
    wanted = couplings.patch[world, patch].normal_share - wp.cw_mul(
        couplings.patch[world, patch].normal_softness, couplings.patch[world, patch].normal_impulse
    )
    if place[1] > 0:
        wanted -= combine4(couplings.run_block, part[0], scratch.delta_velocity, place[0], world, place[1])
    if place[3] > 0:
        start = part[0] + 4 * place[1]
        wanted -= combine4(couplings.run_block, start, scratch.delta_velocity, place[2], world, place[3])
    couplings.patch[world, patch].normal_wanted = wanted
    change = bounded_normals(couplings, world, patch)
    if place[1] > 0:
        add_combination4(
            scratch.delta_velocity, place[0], change, couplings.run_block, part[2], world, place[1]
        )
    if place[3] > 0:
        start = part[2] + 4 * place[1]
        add_combination4(
            scratch.delta_velocity, place[2], change, couplings.run_block, start, world, place[3]
        )
    return normal_residual(couplings, world, patch, change)


@func
def relax_long_friction(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, patch: Int32
) -> real:
    """Relax the friction rows of a patch; returns as `relax_long_normals`."""
    place = couplings.patch[world, patch].place
    part = run_parts(couplings.patch[world, patch].run, place)
    wanted = couplings.patch[world, patch].friction_share
    if place[1] > 0:
        wanted -= combine8(couplings.run_block, part[1], scratch.delta_velocity, place[0], world, place[1])
    if place[3] > 0:
        start = part[1] + 8 * place[1]
        wanted -= combine8(couplings.run_block, start, scratch.delta_velocity, place[2], world, place[3])
    couplings.patch[world, patch].friction_wanted = wanted
    change = bounded_friction(settings, couplings, world, patch)
    if place[1] > 0:
        add_combination8(
            scratch.delta_velocity, place[0], change, couplings.run_block, part[3], world, place[1]
        )
    if place[3] > 0:
        start = part[3] + 8 * place[1]
        add_combination8(
            scratch.delta_velocity, place[2], change, couplings.run_block, start, world, place[3]
        )
    return friction_residual(couplings, world, patch, change)
