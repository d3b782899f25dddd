"""Derivatives, momenta and motions of links in many worlds: the part of `BodyBatch` about these."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from carom.algorithms.answers import (
    CentroidalDynamics,
    ForwardDynamicsDerivatives,
    InverseDynamicsDerivatives,
    LinkMotionDerivatives,
    LinkMotions,
    centroidal_of,
    forward_derivatives_of,
    inverse_derivatives_of,
    link_derivatives_of,
    link_motions_of,
)
from carom.algorithms.centroidal import centroidal_size
from carom.checks import Array
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import INERTIAL_PARAMETERS, LINK_MOTION
from carom.native.gates import gated
from carom.native.kernels import (
    Kernel,
    centroidal_kernel,
    coriolis_kernel,
    forward_derivatives_kernel,
    forward_dynamics_kernel,
    inverse_derivatives_kernel,
    link_derivatives_kernel,
    link_motions_kernel,
    regressor_kernel,
)
from carom.worlds.chosen import Chosen, Where
from carom.worlds.mechanics import AlgorithmBatch


class DerivativeBatch(AlgorithmBatch):
    """The part of `BodyBatch` that computes derivatives of dynamics and kinematics.

    The functions are those of `carom.algorithms` of the same or the singular name, which describe
    coordinates, small changes of positions, and the order of forces. All of them take:

    - positions, (n, coordinates) for the n worlds chosen or (coordinates,) for all, for a free body after
      position (3) and quaternion (4) of the base's inertial frame; None for the present ones;
    - velocities, likewise (dofs,), for a free body after angular and linear velocity of the base in its own
      axes; None for the present ones;
    - accelerations or forces, likewise (dofs,) or one number;
    - where, a mask (count,) of worlds or their indices; None for all.

    Gravity, masses, inertias and armature are those of each world. A shape that does not fit, a number that
    is not finite, and answers that overflow raise `ValueError`.
    """

    @gated("_scene.call_lock")
    def inverse_dynamics_derivatives(
        self,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> InverseDynamicsDerivatives:
        """Derivatives of inverse dynamics in n worlds; matrices are (n, dofs, dofs)."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        questions = self._questions(worlds, positions, velocities, accelerations)
        answers = self._sweep(inverse_derivatives_kernel, questions, worlds, 3 * dofs**2, "derivative")
        return inverse_derivatives_of(answers, dofs)

    @gated("_scene.call_lock")
    def forward_dynamics(
        self,
        forces: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> Array:
        """Accelerations for forces in n worlds, (n, dofs); without contacts, damping and springs."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        questions = self._questions(worlds, positions, velocities, forces, "forces")
        answers = self._sweep(forward_dynamics_kernel, questions, worlds, dofs * (dofs + 2), "acceleration")
        return answers[:, :dofs].copy()

    @gated("_scene.call_lock")
    def forward_dynamics_derivatives(
        self,
        forces: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> ForwardDynamicsDerivatives:
        """Accelerations and derivatives of forward dynamics in n worlds; matrices are (n, dofs, dofs)."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        questions = self._questions(worlds, positions, velocities, forces, "forces")
        size = dofs * (3 * dofs + 1)
        answers = self._sweep(forward_derivatives_kernel, questions, worlds, size, "derivative")
        return forward_derivatives_of(answers, dofs)

    @gated("_scene.call_lock")
    def coriolis_matrices(
        self,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> Array:
        """Coriolis matrices in n worlds, (n, dofs, dofs), as `carom.algorithms.compute_coriolis_matrix`."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        answers = self._bias(worlds, self._questions(worlds, positions, velocities, 0.0))
        return answers[:, : dofs * dofs].reshape(-1, dofs, dofs).copy()

    @gated("_scene.call_lock")
    def gravity_forces(self, positions: ArrayLike | None = None, where: Where | None = None) -> Array:
        """Forces against gravity in n worlds, (n, dofs)."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        answers = self._bias(worlds, self._questions(worlds, positions, 0.0, 0.0))
        return answers[:, dofs**2 : dofs * (dofs + 1)].copy()

    @gated("_scene.call_lock")
    def bias_forces(
        self,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> Array:
        """Forces for velocities and gravity in n worlds, (n, dofs)."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        questions = self._questions(worlds, positions, velocities, 0.0)
        return self._bias(worlds, questions)[:, dofs * (dofs + 1) :].copy()

    @gated("_scene.call_lock")
    def center_of_mass(self, positions: ArrayLike | None = None, where: Where | None = None) -> Array:
        """Centres of mass of the links that can move in n worlds, in world axes [m], (n, 3)."""
        return self.centroidal_dynamics(0.0, positions, 0.0, where).center_of_mass

    @gated("_scene.call_lock")
    def jacobian_center_of_mass(
        self, positions: ArrayLike | None = None, where: Where | None = None
    ) -> Array:
        """Velocity of the centre of mass per velocity in n worlds, in world axes, (n, 3, dofs)."""
        return self.centroidal_dynamics(0.0, positions, 0.0, where).jacobian_center_of_mass

    @gated("_scene.call_lock")
    def centroidal_dynamics(
        self,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> CentroidalDynamics:
        """Centre of mass, momentum, its rate and map, energies, derivatives: arrays of n worlds."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        questions = self._questions(worlds, positions, velocities, accelerations)
        answers = self._sweep(centroidal_kernel, questions, worlds, centroidal_size(dofs), "momentum")
        return centroidal_of(answers, dofs)

    @gated("_scene.call_lock")
    def link_motions(
        self,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        links: Sequence[int | str] | None = None,
        where: Where | None = None,
    ) -> LinkMotions:
        """Velocities and accelerations of k link frames in n worlds, in world axes, (n, k, 3) each.

        Links are given by index (-1 is the base) or name; None for all but the base.
        """
        worlds, count = self._chosen(where), self._mechanics.links
        chosen = list(range(count - 1)) if links is None else [self._link_index(link) for link in links]
        questions = self._questions(worlds, positions, velocities, accelerations)
        size = int(LINK_MOTION) * count
        answers = self._sweep(link_motions_kernel, questions, worlds, size, "motion", count)
        return link_motions_of(answers, chosen)

    @gated("_scene.call_lock")
    def link_motion_derivatives(
        self,
        link: int | str,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> LinkMotionDerivatives:
        """Derivatives of velocity and acceleration of a link in n worlds; matrices are (n, 6, dofs)."""
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        row = 1 + self._link_index(link)
        questions = self._questions(worlds, positions, velocities, accelerations)
        size = 4 * 6 * dofs
        answers = self._sweep(link_derivatives_kernel, questions, worlds, size, "derivative", row)
        return link_derivatives_of(answers, dofs)

    @gated("_scene.call_lock")
    def joint_torque_regressors(
        self,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> Array:
        """Matrices of forces per inertial parameter in n worlds, (n, dofs, 10 (1 + joints))."""
        worlds, dofs, links = self._chosen(where), self._mechanics.dofs, self._mechanics.links
        width = int(INERTIAL_PARAMETERS) * links
        questions = self._questions(worlds, positions, velocities, accelerations)
        answers = self._sweep(regressor_kernel, questions, worlds, dofs * width, "regressor", links)
        return answers.reshape(-1, dofs, width)

    def _bias(self, worlds: Chosen, questions: np.ndarray) -> np.ndarray:
        dofs = self._mechanics.dofs
        return self._sweep(coriolis_kernel, questions, worlds, dofs * (dofs + 2), "Coriolis matrix")

    def _sweep(
        self, kernel: Kernel, questions: np.ndarray, worlds: Chosen, size: int, name: str, *numbers: int
    ) -> np.ndarray:
        return self._mechanics.sweep(kernel, questions, worlds.numbers, size, name, *numbers)

    def _questions(
        self,
        worlds: Chosen,
        positions: ArrayLike | None,
        velocities: ArrayLike | None,
        changes: ArrayLike,
        name: str = "accelerations",
    ) -> np.ndarray:
        """Gravity, pose of the base, positions, velocities, and accelerations or forces, (n, numbers)."""
        bases, dofs = self._bases(worlds), (self._mechanics.dofs,)
        if positions is not None and not self._body.fixed_base:
            length = int(BASE_POSITIONS) + self._coordinates.stop - self._coordinates.start
            placed = worlds.values(np.asarray(self._take(positions)), (length,), "positions")
            if not placed[:, 3:BASE_POSITIONS].any(axis=1).all():
                raise ValueError("a quaternion of the base is 0")
        else:
            placed = np.concatenate([bases, self._joints(worlds, positions)], axis=1)
        if velocities is None:
            rates = self._present_rates(worlds, bases)
        else:
            rates = worlds.values(np.asarray(self._take(velocities)), dofs, "velocities")
        changed = worlds.values(np.asarray(self._take(changes)), dofs, name)
        gravity = np.asarray(self._engine.parameter("model", "gravity_vector", 0))[worlds.numbers]
        return np.concatenate([gravity, placed, rates, changed], axis=1)
