"""Jacobians of points on links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.kernels import motion_subspaces_kernel
from carom.algorithms.query import Query

if TYPE_CHECKING:
    from carom.body import Body


def jacobian(
    body: Body, link: int, local_position: Sequence[float], positions: Sequence[float]
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
    query = Query(body)
    query.joint_position[:] = positions
    query.run(*query.space.launch(motion_subspaces_kernel))
    model, scratch = query.space.model, query.space.scratch
    row = body.first_link + 1 + link
    rotation = scratch["link_rotation"][0, row]
    from_com = np.asarray(local_position, dtype=float) - model["link_com_from_pivot"][row]
    point = scratch["link_offset"][0, row] + rotation @ from_com

    first = int(model["tree_first_dof"][body.rows.tree])
    count = int(model["tree_dof_count"][body.rows.tree])
    linear, angular = np.zeros((3, count)), np.zeros((3, count))
    dof = _last_dof(model, row)
    while dof >= 0:
        axis = scratch["dof_angular"][0, dof]
        angular[:, dof - first] = axis
        linear[:, dof - first] = scratch["dof_linear"][0, dof] + np.cross(axis, point)
        dof = int(model["dof_parent"][dof])
    return linear, angular


def _last_dof(model: dict[str, np.ndarray], row: int) -> int:
    """The dof closest to a link among those that move it, -1 if none does."""
    while row >= 0:
        if model["link_dof_count"][row]:
            return int(model["link_first_dof"][row] + model["link_dof_count"][row] - 1)
        row = int(model["link_parent"][row])
    return -1
