"""Questions about the motion of a body in a step, to the kernels of mechanisms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.linearization.turns import rotation_of

if TYPE_CHECKING:
    from carom.linearization.taken_step import TakenStep
    from carom.scene.core.body_core import BodyCore

_GRAVITY = 3


def motion_questions(
    body: BodyCore,
    taken: TakenStep,
    own: slice,
    accelerations: np.ndarray,
    velocities: np.ndarray | None = None,
) -> np.ndarray:
    """Questions (k, numbers) about the motion of a body before a step with some accelerations.

    Args:
        body: The body.
        taken: The step.
        own: Its dofs in the tangent space.
        accelerations: (k, dofs), those of a free base in world axes.
        velocities: Likewise; None for those before the step.
    """
    first, count = body.first_position, BASE_POSITIONS + sum(body.position_count)
    size = own.stop - own.start
    behind = _GRAVITY + count + size
    found = np.empty((len(accelerations), behind + size))
    found[:, :_GRAVITY] = taken.gravity
    found[:, _GRAVITY : _GRAVITY + count] = taken.position[first : first + count]
    found[:, _GRAVITY + count : behind] = taken.velocity[own] if velocities is None else velocities
    found[:, behind:] = accelerations
    if not body.fixed_base:
        turn = rotation_of(taken.position[first + 3 : first + BASE_POSITIONS])
        # Two vectors each, angular and linear, of velocity and acceleration.
        for start in (_GRAVITY + count, behind):
            both = found[:, start : start + BASE_VELOCITIES]
            both[:] = (both.reshape(-1, 2, 3) @ turn).reshape(-1, BASE_VELOCITIES)
    return found
