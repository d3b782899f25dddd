"""Centre of mass, centroidal momentum, energies, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.answers import CentroidalDynamics, centroidal_of
from carom.algorithms.sweeps import sweeps_of
from carom.checks import Array
from carom.layouts.mechanism import CENTROIDAL_COLUMNS, CENTROIDAL_NUMBERS
from carom.native.gates import alone
from carom.native.kernels import centroidal_kernel

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


@alone("world.call_lock")
def centroidal_dynamics(
    body: Body,
    positions: Numbers,
    velocities: Numbers | None = None,
    accelerations: Numbers | None = None,
) -> CentroidalDynamics:
    """Centre of mass, momentum about it, its rate, energies, the centroidal map, and derivatives.

    All of them are computed together; the other functions of this module return single ones.

    Args:
        body: The body; its links that cannot move, as a fixed base, do not count.
        positions: As in `inverse_dynamics_derivatives`, which also says what a small change of them is.
        velocities: Likewise; 0 by default.
        accelerations: Likewise; 0 by default.

    Returns:
        The record, in world axes.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the answer overflows.
    """
    sweeps = sweeps_of(body)
    answer = sweeps.ask(
        *(centroidal_kernel, centroidal_size(sweeps.dofs), 0),
        positions=positions,
        velocities=velocities,
        changes=accelerations,
    )
    return centroidal_of(answer, sweeps.dofs)


def centroidal_size(dofs: int) -> int:
    """Length of an answer of `centroidal_kernel`."""
    return int(CENTROIDAL_NUMBERS) + int(CENTROIDAL_COLUMNS) * 6 * dofs


def center_of_mass(body: Body, positions: Numbers) -> Array:
    """Centre of mass of the links that can move, in world axes [m], (3,); see `centroidal_dynamics`."""
    return centroidal_dynamics(body, positions).center_of_mass


def jacobian_center_of_mass(body: Body, positions: Numbers) -> Array:
    """Velocity of the centre of mass in world axes per velocity, (3, dofs); see `centroidal_dynamics`."""
    return centroidal_dynamics(body, positions).jacobian_center_of_mass


def centroidal_momentum(body: Body, positions: Numbers, velocities: Numbers) -> Array:
    """Linear [N s] and angular [N m s] momentum about the centre of mass, in world axes, (6,).

    See `centroidal_dynamics`.
    """
    return centroidal_dynamics(body, positions, velocities).momentum


def compute_centroidal_map(body: Body, positions: Numbers) -> Array:
    """The matrix A (6, dofs) with A v = `centroidal_momentum`; see `centroidal_dynamics`."""
    return centroidal_dynamics(body, positions).dh_dv


def kinetic_energy(body: Body, positions: Numbers, velocities: Numbers) -> float:
    """Kinetic energy, with that of armature [J]; see `centroidal_dynamics`."""
    return float(centroidal_dynamics(body, positions, velocities).kinetic_energy)


def potential_energy(body: Body, positions: Numbers) -> float:
    """Potential energy in gravity, 0 at the world's origin [J]; see `centroidal_dynamics`."""
    return float(centroidal_dynamics(body, positions).potential_energy)
