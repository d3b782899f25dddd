"""Forward dynamics, and analytic derivatives of inverse and forward dynamics."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.answers import (
    ForwardDynamicsDerivatives,
    InverseDynamicsDerivatives,
    square_matrices,
)
from carom.algorithms.questions import sweep_question
from carom.algorithms.sweeps import Sweeps
from carom.checks import Array
from carom.native.kernels import (
    forward_derivatives_kernel,
    forward_dynamics_kernel,
    inverse_derivatives_kernel,
)

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


def _count(*multiples: int) -> Callable[[Sweeps], int]:
    """So many vectors and matrices of all dofs, as numbers."""
    vectors, matrices = multiples
    return lambda sweeps: sweeps.dofs * (vectors + matrices * sweeps.dofs)


_INVERSE = sweep_question(
    inverse_derivatives_kernel, _count(0, 3), lambda answer, of: square_matrices(answer, of.dofs)
)
_FORWARD = sweep_question(forward_dynamics_kernel, _count(2, 1), lambda answer, of: [answer[: of.dofs]])
_DERIVATIVES = sweep_question(
    forward_derivatives_kernel,
    _count(1, 3),
    lambda answer, of: [answer[: of.dofs], *square_matrices(answer[of.dofs :], of.dofs)],
)


def inverse_dynamics_derivatives(
    body: Body, positions: Numbers, velocities: Numbers, accelerations: Numbers
) -> InverseDynamicsDerivatives:
    """Derivatives of the forces of `inverse_dynamics`, by spatial algebra (Carpentier and Mansard, 2018).

    They are exact, not finite differences. What is included is what `inverse_dynamics` includes.

    A small change of positions has one number for each velocity: it is the motion in a unit of time with
    these numbers as velocities, as a step integrates it. For a free base these are a rotation vector [rad]
    and a displacement [m], both along its own axes; for a spherical joint a rotation vector along the axes
    of its link; for a planar joint the angle, and displacements along the axes of its link.

    Args:
        body: The body.
        positions: Joint positions in order; for a free body, base position (3) and quaternion (4) of its
            inertial frame before them.
        velocities: Joint rates, shape (dofs,); for a free body, angular (3) and linear (3) velocity of the
            base in its own axes before them.
        accelerations: Derivatives of the velocities, same shape; for the base the derivative of each velocity
            as a vector, in its own axes.

    Returns:
        The matrices. Rows are in the order of velocities, so those of a free base are torque, then force;
            `inverse_dynamics` has the force first.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the entries overflow.
    """
    return InverseDynamicsDerivatives(*_INVERSE(body, positions, velocities, accelerations))


def forward_dynamics(body: Body, positions: Numbers, velocities: Numbers, forces: Numbers) -> Array:
    """Accelerations for given generalized forces: the inverse of `inverse_dynamics`.

    Gravity and armature are included; contacts, damping, springs and friction are not.

    Args:
        body: The body.
        positions: As in `inverse_dynamics_derivatives`.
        velocities: Likewise.
        forces: Joint forces [N m or N], shape (dofs,); for a free body, torque (3) and force (3) on the base
            in its own axes before them.

    Returns:
        Derivatives of the velocities, (dofs,), as `inverse_dynamics` takes them.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the accelerations are not
            finite, as for a joint without inertia.
    """
    return _FORWARD(body, positions, velocities, forces)


def forward_dynamics_derivatives(
    body: Body, positions: Numbers, velocities: Numbers, forces: Numbers
) -> ForwardDynamicsDerivatives:
    """Accelerations of `forward_dynamics`, and their derivatives by positions, velocities and forces.

    Changes of positions are those of `inverse_dynamics_derivatives`; arguments and errors are those of
    `forward_dynamics`.
    """
    accelerations, by_position, by_velocity, by_force = _DERIVATIVES(body, positions, velocities, forces)
    return ForwardDynamicsDerivatives(accelerations, -by_position, -by_velocity, by_force)
