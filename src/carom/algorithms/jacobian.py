"""Jacobians of points on links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.kernels import jacobian_kernel

if TYPE_CHECKING:
    from carom.body import Body


def jacobian(
    body: Body,
    link: int,
    local_position: Sequence[float] | np.ndarray,
    positions: Sequence[float] | np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular Jacobian of a point on a link.

    Args:
        body: The body.
        link: Index of the link; -1 is the base.
        local_position: The point: offset from the link frame's origin (of the base: from its centre
            of mass) along the axes of the inertial frame [m].
        positions: Joint positions in order, shape (n,).

    Returns:
        Matrices J with velocity = J rates, in axes of the base's inertial frame, each of shape
        (3, n); of a free body (3, 6 + n), the base first: angular, then linear.
    """
    space = body.world.query_space()
    at = space.coordinates(body)
    at.take_joints_of_resting_base(positions)
    space.answer["point_on_link"][0, 0] = local_position
    space.run(jacobian_kernel, body.rows.tree, body.first_link + 1 + link)
    return space.answer["dof_linear"][0, at.dofs].T.copy(), space.answer["dof_angular"][0, at.dofs].T.copy()
