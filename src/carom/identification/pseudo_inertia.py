"""Inertial parameters that are physical, and how far apart they are."""

from __future__ import annotations

import numpy as np

from carom.checks import Array

PARAMETERS = 10


class PseudoInertia:
    """How far the ten inertial parameters of a link are from their start, and from bodies that cannot be.

    Parameters are physical, those of some density that is nowhere negative, if and only if the pseudo-inertia
    P = [[S, h], [hᵀ, m]] is positive definite (Wensing, Kim and Slotine, 2018), with the second moments
    S = tr(I)/2 - I, the first moment h and the mass m. P is linear in the parameters. The distance is
    Bregman's divergence of -log det P (Lee, Wensing and Park, 2020): convex, the same in all units and
    frames, and infinite where bodies degenerate.

    Args:
        parameters: At the start, in the order of `carom.algorithms.inertial_parameters`, (10,).

    Raises:
        ValueError: They are not physical.
    """

    def __init__(self, parameters: Array) -> None:
        start = _matrix(parameters)
        try:
            np.linalg.cholesky(start)
        except np.linalg.LinAlgError:
            raise ValueError("the inertia is not that of any body of positive density") from None
        self._inverse: Array = np.asarray(np.linalg.inv(start), dtype=float)
        self._size = float(np.linalg.slogdet(start)[1])
        self._radius = np.sqrt(np.trace(start[:3, :3]) / parameters[0])
        self._mass = float(parameters[0])

    @property
    def scale(self) -> Array:
        """Sizes of the parameters: mass, mass by radius of gyration about the origin, and by its square."""
        sizes = self._mass * self._radius ** np.array([0, 1, 1, 1, 2, 2, 2, 2, 2, 2])
        return np.asarray(sizes, dtype=float)

    def distance(self, parameters: Array) -> tuple[float, Array, Array]:
        """The distance of some physical parameters, its gradient (10,) and second derivatives (10, 10)."""
        found = _matrix(parameters)
        value = np.trace(self._inverse @ found) - (np.linalg.slogdet(found)[1] - self._size) - len(found)
        effects = np.linalg.solve(found, _BASIS)
        gradient = np.einsum("ij,kji->k", self._inverse, _BASIS) - np.trace(effects, axis1=1, axis2=2)
        return float(value), gradient, np.einsum("kij,lji->kl", effects, effects)

    @staticmethod
    def room(parameters: Array, change: Array) -> float:
        """The multiple of a change after which some physical parameters are not physical any more."""
        half = np.linalg.inv(np.linalg.cholesky(_matrix(parameters)))
        least = np.linalg.eigvalsh(half @ _matrix(change) @ half.T)[0]
        return float(-1.0 / least) if least < 0.0 else np.inf


def _matrix(parameters: Array) -> Array:
    mass, moment = parameters[0], parameters[1:4]
    xx, xy, yy, xz, yz, zz = parameters[4:]
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    found = np.empty((4, 4))
    found[:3, :3] = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    found[:3, 3] = found[3, :3] = moment
    found[3, 3] = mass
    return found


_BASIS = np.array([_matrix(one) for one in np.eye(PARAMETERS)])


def centre_and_inertia(parameters: Array) -> tuple[float, Array, Array]:
    """Mass, centre of mass (3,), and inertia about it (3, 3), in the axes of the link frame."""
    mass, centre = float(parameters[0]), parameters[1:4] / parameters[0]
    xx, xy, yy, xz, yz, zz = parameters[4:]
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return mass, centre, inertia - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
