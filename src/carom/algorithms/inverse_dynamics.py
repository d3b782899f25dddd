"""Inverse dynamics: which forces cause a given motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.moving_tree import moving_tree
from carom.description.transform import conjugate, rotation_matrix
from carom.model.codes import BASE_POSITIONS, BASE_VELOCITIES

if TYPE_CHECKING:
    from carom.body import Body


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
    tree = moving_tree(body)
    if body.fixed_base:
        first = body.first_position
        own = body.world.position[first + 3 : first + BASE_POSITIONS]
        x, y, z = _gravity_seen_from(body, own if base_orientation is None else base_orientation)
        tree.set_resting_base((x, y, z))
        return np.array(tree.forces(positions, velocities, accelerations))

    v, a = np.asarray(velocities, dtype=float), np.asarray(accelerations, dtype=float)
    tree.set_base_motion(*v[:3], *a[:3], *(a[3:6] - _gravity_seen_from(body, positions[3:7])))
    forces = np.array(
        tree.forces(positions[BASE_POSITIONS:], v[BASE_VELOCITIES:], a[BASE_VELOCITIES:]), dtype=float
    )
    return np.concatenate([forces[3:6], forces[:3], forces[6:]])


def _gravity_seen_from(body: Body, orientation: Sequence[float] | np.ndarray) -> np.ndarray:
    """Gravity in a frame, by the frame's quaternion."""
    x, y, z, w = orientation
    return np.array(rotation_matrix(conjugate((x, y, z, w)))) @ body.world.parameters.gravity
