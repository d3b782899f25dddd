"""Coriolis matrix, gravity forces, and both together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.centroidal import center_question
from carom.algorithms.questions import sweep_question
from carom.algorithms.sweeps import Sweeps
from carom.checks import Array
from carom.native.kernels import coriolis_kernel

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


def _size(of: Sweeps) -> int:
    return of.dofs * (of.dofs + 2)


_MATRIX = sweep_question(
    coriolis_kernel, _size, lambda answer, of: [answer[: of.dofs**2].reshape(of.dofs, of.dofs)]
)
_BIAS = sweep_question(coriolis_kernel, _size, lambda answer, of: [answer[of.dofs * (of.dofs + 1) :]])
_GRAVITY = center_question(lambda answer, of: [answer[len(answer) - of.dofs :]])


def compute_coriolis_matrix(body: Body, positions: Numbers, velocities: Numbers) -> Array:
    """The Coriolis matrix C with M v̇ + C v + g = forces, for which dM/dt - 2 C is skew-symmetric.

    Here v̇ are the derivatives of the velocity's components. For a free base these differ from the
    accelerations of `inverse_dynamics`, the derivative as a vector: a = v̇ + ω x v for the linear velocity v.

    Args:
        body: The body.
        positions: Joint positions in order; for a free body, base position (3) and quaternion (4) of its
            inertial frame before them.
        velocities: Joint rates, shape (dofs,); for a free body, angular (3) and linear (3) velocity of the
            base in its own axes before them.

    Returns:
        Matrix (dofs, dofs); rows are forces in the order of velocities, those of a free base torque before
            force.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the entries overflow.
    """
    return _MATRIX(body, positions, velocities)


def gravity_forces(body: Body, positions: Numbers) -> Array:
    """The forces (dofs,) that hold a body at rest against gravity [N m or N].

    Arguments, errors and the order of forces are those of `compute_coriolis_matrix`.
    """
    return _GRAVITY(body, positions)


def bias_forces(body: Body, positions: Numbers, velocities: Numbers) -> Array:
    """The forces C v + g (dofs,), for gravity and velocities [N m or N].

    Arguments, errors and the order of forces are those of `compute_coriolis_matrix`.
    """
    return _BIAS(body, positions, velocities)
