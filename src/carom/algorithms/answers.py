"""What functions about derivatives, momenta and motions of links return, for one body or for many worlds.

Where a record is of one body, its arrays are as described; of a body in n worlds, an axis of length n comes
before the others. `dofs` counts all velocity coordinates: those of a free base, three angular and three
linear ones in its own axes, come before those of the joints.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.checks import Array
from carom.layouts.mechanism import CENTROIDAL_COLUMNS, CENTROIDAL_NUMBERS, LINK_MOTION

_ROWS = 6


class InverseDynamicsDerivatives(NamedTuple):
    """Derivatives of the forces that a motion takes.

    Rows are forces in the order of the velocities, so those of a free base are torque before force; columns
    are positions, velocities and accelerations.

    Attributes:
        dtau_dq: By positions, (dofs, dofs).
        dtau_dv: By velocities, (dofs, dofs).
        dtau_da: By accelerations: the mass matrix, with armature, (dofs, dofs).
    """

    dtau_dq: Array
    dtau_dv: Array
    dtau_da: Array


class ForwardDynamicsDerivatives(NamedTuple):
    """Accelerations for given forces, and their derivatives.

    Attributes:
        accelerations: The accelerations, (dofs,).
        da_dq: By positions, (dofs, dofs).
        da_dv: By velocities, (dofs, dofs).
        da_dtau: By forces: the inverse of the mass matrix, (dofs, dofs).
    """

    accelerations: Array
    da_dq: Array
    da_dv: Array
    da_dtau: Array


class CentroidalDynamics(NamedTuple):
    """Centre of mass, centroidal momentum and energies of a body, in world axes.

    Momenta and matrices of six rows have linear before angular rows; angular momentum is about the centre of
    mass. Links that cannot move, as the fixed base, do not count.

    Attributes:
        mass: Mass [kg], ().
        center_of_mass: Position of the centre of mass [m], (3,).
        momentum: Linear [N s] and angular [N m s] momentum, (6,).
        momentum_rate: Its derivative in time, for the velocities and accelerations given: all external forces
            and their torque about the centre of mass, gravity included, (6,).
        kinetic_energy: Kinetic energy, with that of armature [J], ().
        potential_energy: Minus mass times gravity times centre of mass [J], ().
        dh_dv: The centroidal map: momentum per velocity, (6, dofs); also `momentum_rate` per acceleration.
        dh_dq: Derivatives of the momentum by positions, (6, dofs).
        drate_dq: Derivatives of `momentum_rate` by positions, (6, dofs).
        drate_dv: Derivatives of `momentum_rate` by velocities, (6, dofs).
    """

    mass: Array
    center_of_mass: Array
    momentum: Array
    momentum_rate: Array
    kinetic_energy: Array
    potential_energy: Array
    dh_dv: Array
    dh_dq: Array
    drate_dq: Array
    drate_dv: Array

    @property
    def jacobian_center_of_mass(self) -> Array:
        """Velocity of the centre of mass per velocity, (3, dofs); zeros if nothing can move."""
        mass = self.mass[..., None, None]
        return self.dh_dv[..., :3, :] / np.where(mass > 0.0, mass, 1.0)


class LinkMotions(NamedTuple):
    """Motions of k link frames in world axes; linear ones are those of the frame's origin.

    Attributes:
        linear_velocities: [m/s], (k, 3).
        angular_velocities: [rad/s], (k, 3).
        linear_accelerations: Derivatives of the linear velocities (classical accelerations) [m/s²], (k, 3).
        angular_accelerations: Derivatives of the angular velocities [rad/s²], (k, 3).
    """

    linear_velocities: Array
    angular_velocities: Array
    linear_accelerations: Array
    angular_accelerations: Array


class LinkMotionDerivatives(NamedTuple):
    """Derivatives of velocity and acceleration of a link frame, in world axes, linear before angular rows.

    Attributes:
        dv_dq: Velocity by positions, (6, dofs).
        dv_dv: Velocity by velocities, the link's Jacobian, and acceleration by accelerations, (6, dofs).
        da_dq: Acceleration by positions, (6, dofs).
        da_dv: Acceleration by velocities, (6, dofs).
    """

    dv_dq: Array
    dv_dv: Array
    da_dq: Array
    da_dv: Array


def square_matrices(numbers: np.ndarray, dofs: int) -> list[np.ndarray]:
    """Three matrices (..., dofs, dofs), one after the other in numbers (..., 3 dofs²)."""
    matrices = numbers.reshape(*numbers.shape[:-1], 3, dofs, dofs)
    return [matrices[..., k, :, :] for k in range(3)]


def inverse_derivatives_of(answer: np.ndarray, dofs: int) -> InverseDynamicsDerivatives:
    """The record of answers (..., numbers) of `inverse_derivatives_kernel`."""
    return InverseDynamicsDerivatives(*square_matrices(answer, dofs))


def forward_derivatives_of(answer: np.ndarray, dofs: int) -> ForwardDynamicsDerivatives:
    """The record of answers (..., numbers) of `forward_derivatives_kernel`."""
    by_position, by_velocity, by_force = square_matrices(answer[..., dofs:], dofs)
    return ForwardDynamicsDerivatives(answer[..., :dofs], -by_position, -by_velocity, by_force)


def centroidal_of(answer: np.ndarray, dofs: int) -> CentroidalDynamics:
    """The record of answers (..., numbers) of `centroidal_kernel`."""
    matrices = answer[..., CENTROIDAL_NUMBERS:].reshape(*answer.shape[:-1], CENTROIDAL_COLUMNS, _ROWS, dofs)
    return CentroidalDynamics(
        *(answer[..., 0], answer[..., 1:4], answer[..., 4:10], answer[..., 10:16]),
        *(answer[..., 16], answer[..., 17]),
        *(matrices[..., k, :, :] for k in range(CENTROIDAL_COLUMNS)),
    )


def motions_of(answer: np.ndarray) -> list[np.ndarray]:
    """The arrays of `LinkMotions` (..., links, 3) of answers of `link_motions_kernel`, the base first."""
    motions = answer.reshape(*answer.shape[:-1], -1, LINK_MOTION)
    return [motions[..., k : k + 3] for k in range(0, LINK_MOTION, 3)]


def link_motions_of(answer: np.ndarray, links: list[int]) -> LinkMotions:
    """The record, for links by index, of answers (..., numbers) of `link_motions_kernel`."""
    rows = [1 + link for link in links]
    return LinkMotions(*(motion[..., rows, :] for motion in motions_of(answer)))


def link_derivatives_of(answer: np.ndarray, dofs: int) -> LinkMotionDerivatives:
    """The record of answers (..., numbers) of `link_derivatives_kernel`."""
    return LinkMotionDerivatives(*motion_matrices(answer, dofs))


def motion_matrices(answer: np.ndarray, dofs: int) -> list[np.ndarray]:
    """The matrices (..., 6, dofs) of answers of `link_derivatives_kernel`."""
    matrices = answer.reshape(*answer.shape[:-1], 4, _ROWS, dofs)
    return [matrices[..., k, :, :] for k in range(4)]
