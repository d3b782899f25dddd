"""Inverse dynamics: which forces cause a given motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.kernels import inverse_dynamics_kernel
from carom.algorithms.query import Query
from carom.description.transform import rotation_matrix

if TYPE_CHECKING:
    from carom.body import Body


def inverse_dynamics(
    body: Body, positions: Sequence[float], velocities: Sequence[float], accelerations: Sequence[float]
) -> np.ndarray:
    """Generalized forces that give a body the stated accelerations, by recursive Newton-Euler.

    Gravity counts, damping and applied forces do not.

    Args:
        body: The body.
        positions: Joint positions in order, shape (n,); of a free body, base position (3) and
            quaternion (4) of its inertial frame before them.
        velocities: Joint rates, shape (n,); of a free body, angular (3) and linear (3) velocity of
            the base along its own axes before them.
        accelerations: Their derivatives, shape as `velocities`; the base's along its own axes.

    Returns:
        Joint forces [N m or N], shape (n,); of a free body, force (3) and torque (3) on the base
        along its own axes before them.
    """
    query = Query(body)
    q, v, a = (np.asarray(values, dtype=float) for values in (positions, velocities, accelerations))
    if body.fixed_base:
        first = body.first_position
        query.place_base(body.world.position[first : first + 7])
    else:
        x, y, z, w = q[3:7]
        to_world = np.array(rotation_matrix((x, y, z, w)))
        query.place_base(q[:7])
        query.move_base(to_world @ v[:3], to_world @ v[3:6], to_world @ a[:3], to_world @ a[3:6])
        q, v, a = q[7:], v[6:], a[6:]
    query.joint_position[:] = q
    query.joint_velocity[:] = v
    query.joint_acceleration[:] = a
    query.run(*query.space.launch(inverse_dynamics_kernel, with_settings=True))
    force = query.generalized_force
    if body.fixed_base:
        return force[6:]
    return np.concatenate([to_world.T @ force[3:6], to_world.T @ force[:3], force[6:]])
