"""Derivatives of inverse dynamics of a body, with the parameters of one of many worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.mechanism import MechanismBatch
from carom.linearization.taken_step import motion_questions
from carom.native.kernels import derivatives_of_motion_kernel
from carom.native.launch import Launch
from carom.native.tables import put_array, put_zeros

if TYPE_CHECKING:
    from carom.linearization.step_kernels import Mechanisms
    from carom.linearization.taken_step import TakenStep
    from carom.scene.core.body_core import BodyCore

_GRAVITY = 3
_PARAMETERS = ("mass", "moment", "inertia", "armature")


class MotionAnswers:
    """Asks how the forces M a + c of bodies change, without gravity.

    Args:
        mechanisms: As of `StepKernels`.
    """

    def __init__(self, mechanisms: Mechanisms) -> None:
        self._mechanisms = mechanisms

    def of(
        self,
        body: BodyCore,
        taken: TakenStep,
        own: slice,
        world: int,
        velocities: np.ndarray,
        accelerations: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the forces by positions and by velocities, each (k, n, n).

        Args:
            body: The body.
            taken: The step, at whose first positions they are.
            own: Dofs of the body in the tangent space.
            world: Number of the world.
            velocities: Velocities of the dofs, (k, n).
            accelerations: Accelerations, likewise.
        """
        size, count = own.stop - own.start, len(velocities)
        questions = motion_questions(body, taken, own, accelerations, velocities)
        questions[:, :_GRAVITY] = 0.0
        structs, varied = self._mechanisms(body)
        batch: Any = MechanismBatch()
        put_array(batch, "question", questions.ravel())
        answer = put_zeros(batch, "answer", 3 * count * size * size)
        for name in _PARAMETERS:
            if varied is None:
                put_zeros(batch, name, 0)
            else:
                put_array(batch, name, getattr(varied, name))
        numbers = (world, int(varied is not None), 0)
        Launch(derivatives_of_motion_kernel, count, [*structs[0], batch, *numbers])()
        found = answer.reshape(count, 3, size, size)
        return found[:, 0], found[:, 1]
