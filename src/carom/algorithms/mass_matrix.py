"""The joint-space inertia matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.kernels import mass_matrix_kernel
from carom.algorithms.query import Query

if TYPE_CHECKING:
    from carom.body import Body


def mass_matrix(body: Body, positions: Sequence[float]) -> np.ndarray:
    """Joint-space inertia at the given joint positions, by the composite rigid body algorithm.

    Args:
        body: The body.
        positions: Joint positions in order, shape (n,).

    Returns:
        Symmetric matrix, shape (n, n); of a free body (6 + n, 6 + n), the base first: angular, then
        linear velocity along its own axes.
    """
    query = Query(body)
    query.joint_position[:] = positions
    query.run(*query.space.launch(mass_matrix_kernel))
    tree = body.rows.tree
    model = query.space.model
    count = int(model["tree_dof_count"][tree])
    blocks = (count + 3) // 4
    first = int(model["tree_first_block"][tree])
    rows = query.space.scratch["block_factor"][0, first : first + count * blocks]
    lower = np.tril(rows.reshape(count, 4 * blocks)[:, :count])
    return lower + np.tril(lower, -1).T
