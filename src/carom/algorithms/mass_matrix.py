"""The joint-space inertia matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.kernels import mass_matrix_kernel

if TYPE_CHECKING:
    from carom.body import Body


def mass_matrix(body: Body, positions: Sequence[float] | np.ndarray) -> np.ndarray:
    """Joint-space inertia at the given joint positions, by the composite rigid body algorithm.

    Args:
        body: The body.
        positions: Joint positions in order, shape (n,).

    Returns:
        Symmetric matrix, shape (n, n); of a free body (6 + n, 6 + n), the base first: angular, then
        linear velocity along its own axes.
    """
    space = body.world.query_space()
    space.coordinates(body).take_joints_of_resting_base(positions)
    tree = body.rows.tree
    space.run(mass_matrix_kernel, tree)
    count = int(space.model["tree_dof_count"][tree])
    blocks = (count + 3) // 4
    first = int(space.model["tree_first_block"][tree])
    rows = space.scratch["block_factor"][0, first : first + count * blocks]
    return rows.reshape(count, 4 * blocks)[:, :count].copy()
