"""Coriolis matrix, gravity forces, and both together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.sweeps import sweeps_of
from carom.checks import Array
from carom.native.gates import alone
from carom.native.kernels import coriolis_kernel

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


@alone("world.call_lock")
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
    answer, dofs = _ask(body, positions, velocities)
    return answer[: dofs * dofs].reshape(dofs, dofs).copy()


@alone("world.call_lock")
def gravity_forces(body: Body, positions: Numbers) -> Array:
    """The forces (dofs,) that hold a body at rest against gravity [N m or N].

    Arguments, errors and the order of forces are those of `compute_coriolis_matrix`.
    """
    answer, dofs = _ask(body, positions, None)
    return answer[dofs * dofs :].copy()


@alone("world.call_lock")
def bias_forces(body: Body, positions: Numbers, velocities: Numbers) -> Array:
    """The forces C v + g (dofs,), for gravity and velocities [N m or N].

    Arguments, errors and the order of forces are those of `compute_coriolis_matrix`.
    """
    answer, _ = _ask(body, positions, velocities)
    return bias_of(answer, np.asarray(velocities, dtype=float))


def bias_of(answer: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """C v + g of answers (..., numbers) of `coriolis_kernel`, at velocities (..., dofs)."""
    dofs = velocities.shape[-1]
    matrices = answer[..., : dofs * dofs].reshape(*answer.shape[:-1], dofs, dofs)
    return (matrices * velocities[..., None, :]).sum(axis=-1) + answer[..., dofs * dofs :]


def _ask(body: Body, positions: Numbers, velocities: Numbers | None) -> tuple[np.ndarray, int]:
    sweeps = sweeps_of(body)
    size = sweeps.dofs * (sweeps.dofs + 1)
    return sweeps.ask(coriolis_kernel, size, 0, positions=positions, velocities=velocities), sweeps.dofs
