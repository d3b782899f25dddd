"""The search of `calculateInverseKinematics` as PyBullet makes it, arrived at the targets or not."""

from carom.kernels.inverse_kinematics.kinematics import advance, copy, fill_jacobian, place
from carom.kernels.inverse_kinematics.pybullet_steps import measure_as_pybullet, normal_step, rest_step
from carom.kernels.inverse_kinematics.search import take_targets
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, kernel, real


@kernel
def pybullet_search_kernel(
    sizes: ChainSizes,
    chain: Chain,
    search: Search,
    oriented: Int32,
    rested: Int32,
    iterations: Int32,
    threshold: real,
):
    """Search for joint positions and write them to `coordinate_best`.

    `oriented` is 1 if the ends have target orientations as well, `rested` 1 if there are limits, ranges and
    rest positions. A step follows each measurement, so there is one more when the distances [m] are within
    the threshold; angles are not asked. All joints turn or slide.
    """
    take_targets(sizes, search)
    for column in range(sizes.columns):
        search.column[column].held = 0
        search.column[column].weight = real(1.0)
    for dof in range(sizes.dofs):
        search.dof[dof].step = real(0.0)
    copy(sizes.coordinates, search.coordinate_start, search.coordinate_best)
    blocks = (1 + oriented) * sizes.ends
    left = iterations
    while left > 0:
        place(sizes, chain, search, search.coordinate_best)
        distance = measure_as_pybullet(sizes, chain, search, oriented)
        fill_jacobian(sizes, chain, search, search.coordinate_best, oriented)
        if rested == 1:
            rest_step(sizes, chain, search, search.coordinate_best, blocks)
        else:
            normal_step(sizes, chain, search, blocks)
        advance(sizes, chain, search, search.coordinate_best, search.coordinate_best)
        left -= 1
        if distance <= threshold:
            left = Int32(0)
