"""Inverse dynamics: forces for a given motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.mechanism import mechanism_of
from carom.algorithms.not_finite import not_finite
from carom.algorithms.questions import asker_of
from carom.checks import Array
from carom.description.pose import Vector3
from carom.description.transform import conjugate, rotate
from carom.layouts.codes import BASE_POSITIONS
from carom.native.gates import gated
from carom.native.kernel_builtins import Asker

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore

Numbers = Sequence[float] | np.ndarray


def inverse_dynamics(
    body: Body,
    positions: Sequence[float] | np.ndarray,
    velocities: Sequence[float] | np.ndarray,
    accelerations: Sequence[float] | np.ndarray,
    base_orientation: Sequence[float] | None = None,
) -> Array:
    """Generalized forces for given accelerations of a body, by the recursive Newton-Euler algorithm.

    Gravity and armature are included; damping, springs, friction and applied forces are not.

    Args:
        body: The body.
        positions: Joint positions in order, shape (n,); for a free body, base position (3) and quaternion (4)
            of its inertial frame before them.
        velocities: Joint rates, shape (n,); for a free body, angular (3) and linear (3) velocity of the base
            in its own axes before them.
        accelerations: Derivatives of the velocities, same shape; the base's in its own axes.
        base_orientation: Orientation assumed for a fixed base, quaternion of its inertial frame; None for the
            current one.

    Returns:
        Joint forces [N m or N], shape (n,); for a free body, force (3) and torque (3) on the base in its own
        axes before them.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the forces overflow.
    """
    gravity = body.world.parameters.gravity
    if body.fixed_base:
        gravity = _gravity_in_base(body, gravity, base_orientation)
    found = asker_of(body, _asker)(gravity, positions, velocities, accelerations)
    return _checked(body, gravity, positions, velocities, accelerations) if found is None else found


@gated("world.call_lock")
def _checked(
    body: BodyCore, gravity: Vector3, positions: Numbers, velocities: Numbers, accelerations: Numbers
) -> Array:
    mechanism = mechanism_of(body)
    positions_count = mechanism.coordinates + (BASE_POSITIONS if mechanism.free else 0)
    counts = (positions_count, mechanism.dofs, mechanism.dofs)
    if (len(positions), len(velocities), len(accelerations)) != counts:
        raise ValueError(
            f"the arguments do not fit the body, which takes {positions_count} positions "
            f"and {mechanism.dofs} velocities"
        )
    if not mechanism.dofs:
        return np.zeros(0)
    try:
        return mechanism.motion_question.forces(gravity, positions, velocities, accelerations)
    except ValueError:
        numbers = [np.asarray(it, dtype=float) for it in (positions, velocities, accelerations)]
        if all(np.isfinite(it).all() for it in numbers):
            raise not_finite(body, *numbers) from None
        raise


def _asker(body: BodyCore) -> Asker:
    mechanism = mechanism_of(body)
    return mechanism.motion_question.asker(body.world.call_lock)


def _gravity_in_base(body: BodyCore, gravity: Vector3, orientation: Sequence[float] | None) -> Vector3:
    """Gravity in the axes of a fixed base with this orientation, or its own."""
    if orientation is not None:
        x, y, z, w = orientation
        return rotate(conjugate((x, y, z, w)), gravity)
    first = body.first_position
    own = body.world.position_memory[first + 3 : first + BASE_POSITIONS].tobytes()
    known = body.derived.get(_gravity_in_base)
    if known is None or known[:2] != (own, gravity):
        x, y, z, w = body.world.position[first + 3 : first + BASE_POSITIONS].tolist()
        known = own, gravity, rotate(conjugate((x, y, z, w)), gravity)
        body.derived[_gravity_in_base] = known
    return known[2]
