"""Inverse dynamics: which forces cause a given motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.kernels import inverse_dynamics_kernel
from carom.algorithms.query import reals
from carom.description.transform import rotation_matrix
from carom.model.codes import BASE_POSITIONS, BASE_VELOCITIES

if TYPE_CHECKING:
    from carom.body import Body

_AT_REST = reals((0.0,) * BASE_VELOCITIES)


def inverse_dynamics(
    body: Body,
    positions: Sequence[float] | np.ndarray,
    velocities: Sequence[float] | np.ndarray,
    accelerations: Sequence[float] | np.ndarray,
    base_orientation: Sequence[float] | None = None,
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
        base_orientation: How a fixed base is taken to be turned, quaternion of its inertial frame;
            None for how it is.

    Returns:
        Joint forces [N m or N], shape (n,); of a free body, force (3) and torque (3) on the base
        along its own axes before them.
    """
    space = body.world.query_space()
    at = space.coordinates(body)
    if body.fixed_base:
        first = body.first_position
        at.base_position[:] = body.world.position_memory[first : first + BASE_POSITIONS]
        if base_orientation is not None:
            at.base_position[3:] = reals(base_orientation)
        at.joint_position[:] = reals(positions)
        at.velocity[:] = _AT_REST + reals(velocities)
        at.acceleration[:] = _AT_REST + reals(accelerations)
        space.run(inverse_dynamics_kernel, body.rows.tree)
        return -at.force[BASE_VELOCITIES:]

    q, v, a = (np.asarray(values, dtype=float) for values in (positions, velocities, accelerations))
    x, y, z, w = q[3:7]
    to_world = np.array(rotation_matrix((x, y, z, w)))
    at.base_position[:] = reals(q[:BASE_POSITIONS])
    at.joint_position[:] = reals(q[BASE_POSITIONS:])
    for target, values in ((at.velocity, v), (at.acceleration, a)):
        target[:] = reals(np.concatenate([to_world @ values[:3], to_world @ values[3:6], values[6:]]))
    space.run(inverse_dynamics_kernel, body.rows.tree)
    return -np.concatenate([at.force[3:6] @ to_world, at.force[:3] @ to_world, at.force[6:]])
