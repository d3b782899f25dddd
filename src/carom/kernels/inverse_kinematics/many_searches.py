"""Inverse kinematics of one body in many worlds: a thread goes through its worlds with one `Search`."""

import warp as wp

from carom.kernels.inverse_kinematics.kinematics import measure_errors, place
from carom.kernels.inverse_kinematics.search import find_coordinates
from carom.kernels.structs import Chain, ChainSizes, Search, SearchBatch
from carom.kernels.types import Int32, func, kernel, real
from carom.layouts.codes import BASE_POSITIONS


@func
def take_question(sizes: ChainSizes, search: Search, batch: SearchBatch, world: Int32):
    """Give the search the targets and options of a world."""
    for index in range(BASE_POSITIONS):
        search.base_pose[index] = batch.base_pose[world * BASE_POSITIONS + index]
    for end in range(sizes.ends):
        search.end_given_position[end] = batch.end_position[world * sizes.ends + end]
        search.end_given_rotation[end] = batch.end_rotation[world * sizes.ends + end]
    for index in range(sizes.coordinates):
        search.coordinate_start[index] = batch.start[world * sizes.coordinates + index]
    for dof in range(sizes.dofs):
        row = world * sizes.dofs + dof
        search.dof[dof].damping = batch.damping[row]
        search.dof[dof].lower = batch.lower[row]
        search.dof[dof].upper = batch.upper[row]
        search.dof[dof].range = batch.range[row]
        search.dof[dof].rest = batch.rest[row]


@kernel
def searches_in_worlds_kernel(
    sizes: ChainSizes,
    chain: Chain,
    search: Search,
    batch: SearchBatch,
    oriented: Int32,
    step_kind: Int32,
    bounded: Int32,
    iterations: Int32,
    further: Int32,
    threshold: real,
    patience: real,
    first_world: Int32,
):
    """Search for joint positions as `inverse_kinematics_kernel`, in each world; also what errors are left."""
    world = first_world + wp.tid()
    take_question(sizes, search, batch, world)
    find_coordinates(
        sizes, chain, search, oriented, step_kind, bounded, iterations, further, threshold, patience
    )
    for index in range(sizes.coordinates):
        batch.best[world * sizes.coordinates + index] = search.coordinate_best[index]
    place(sizes, chain, search, search.coordinate_best)
    errors = measure_errors(sizes, chain, search, oriented)
    batch.residual[2 * world] = errors.distance
    batch.residual[2 * world + 1] = errors.angle
