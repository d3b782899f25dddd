"""Centre of mass, centroidal momentum, energies, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.answers import CentroidalDynamics, centroidal_of
from carom.algorithms.questions import Question, sweep_question
from carom.algorithms.sweeps import Views
from carom.checks import Array
from carom.layouts.mechanism import (
    CENTER_NUMBERS,
    CENTROIDAL_COLUMNS,
    CENTROIDAL_NUMBERS,
    MOMENTUM_NUMBERS,
)
from carom.native.kernels import center_kernel, centroidal_kernel, momentum_kernel

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


_NUMBERS, _ROWS = int(CENTROIDAL_NUMBERS), int(CENTROIDAL_COLUMNS) * 6
_AHEAD, _BEFORE = int(MOMENTUM_NUMBERS), int(CENTER_NUMBERS)


def centroidal_size(dofs: int) -> int:
    """Length of an answer of `centroidal_kernel`."""
    return _NUMBERS + _ROWS * dofs


def center_question(views: Views) -> Question:
    """A question to `center_kernel`."""
    return sweep_question(center_kernel, lambda of: _BEFORE + 4 * of.dofs, views)


def _momentum_question(views: Views) -> Question:
    return sweep_question(momentum_kernel, lambda of: _AHEAD + 6 * of.dofs, views)


_ALL = sweep_question(centroidal_kernel, lambda of: centroidal_size(of.dofs), lambda answer, _: [answer])
_MOMENTUM = _momentum_question(lambda answer, _: [answer[:6]])
_KINETIC = _momentum_question(lambda answer, _: [answer[6:7].reshape(())])
_MAP = _momentum_question(lambda answer, of: [answer[_AHEAD:].reshape(6, of.dofs)])
_CENTER = center_question(lambda answer, _: [answer[:3]])
_POTENTIAL = center_question(lambda answer, _: [answer[3:4].reshape(())])
_SPEEDS = center_question(lambda answer, of: [answer[_BEFORE : _BEFORE + 3 * of.dofs].reshape(3, of.dofs)])


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
    answer = _ALL(body, positions, velocities, accelerations)
    return centroidal_of(answer, (len(answer) - _NUMBERS) // _ROWS)


def center_of_mass(body: Body, positions: Numbers) -> Array:
    """Centre of mass of the links that can move, in world axes [m], (3,); see `centroidal_dynamics`."""
    return _CENTER(body, positions)


def jacobian_center_of_mass(body: Body, positions: Numbers) -> Array:
    """Velocity of the centre of mass in world axes per velocity, (3, dofs); see `centroidal_dynamics`."""
    return _SPEEDS(body, positions)


def centroidal_momentum(body: Body, positions: Numbers, velocities: Numbers) -> Array:
    """Linear [N s] and angular [N m s] momentum about the centre of mass, in world axes, (6,).

    See `centroidal_dynamics`.
    """
    return _MOMENTUM(body, positions, velocities)


def compute_centroidal_map(body: Body, positions: Numbers) -> Array:
    """The matrix A (6, dofs) with A v = `centroidal_momentum`; see `centroidal_dynamics`."""
    return _MAP(body, positions)


def kinetic_energy(body: Body, positions: Numbers, velocities: Numbers) -> float:
    """Kinetic energy, with that of armature [J]; see `centroidal_dynamics`."""
    return _KINETIC(body, positions, velocities)


def potential_energy(body: Body, positions: Numbers) -> float:
    """Potential energy in gravity, 0 at the world's origin [J]; see `centroidal_dynamics`."""
    return _POTENTIAL(body, positions)
