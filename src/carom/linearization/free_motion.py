"""Derivatives of the equations of motion of the bodies in a step, at a given acceleration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.dynamics_derivatives import inverse_dynamics_derivatives
from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.regressor import joint_torque_regressor
from carom.layouts.codes import BASE_POSITIONS, PD_KD, PD_KP, PD_MAX_FORCE, PD_POSITION, PD_VELOCITY
from carom.linearization.inputs import INERTIAL
from carom.linearization.spatial import Spatial, link_forces
from carom.linearization.turns import cross_matrix, matrix_of

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace
    from carom.scene.body import Body

_PARTS = 10
_ANGULAR, _LINEAR = slice(0, 3), slice(3, 6)


class FreeMotion:
    """The equations of motion of all bodies, M (v⁺ - v) / h = forces + Jᵀ λ / h, and their derivatives.

    Attributes:
        effective: Effective mass matrix M, with armature, damping and springs, (n, n).
        inverse: Its inverse; zeros where nothing can move.
        spatial: Motion subspaces of each body.
    """

    def __init__(self, space: TangentSpace, taken: TakenStep) -> None:
        self._space = space
        self._taken = taken
        count, h = len(space), taken.time_step
        self.spatial: list[Spatial] = []
        for body, (first, size) in zip(space.bodies, space.places, strict=True):
            own = slice(first, first + size)
            links = slice(body.first_link, body.first_link + 1 + body.joint_count)
            columns = taken.angular[own], taken.linear[own]
            self.spatial.append(Spatial(body, taken.link_pose[links], columns))
            if taken.model["dof_stiffness"][body.rows.first["dof"]] != 0.0:
                raise NotImplementedError(
                    f"body {body.name!r} has a spring at its free base, which has no exact derivatives"
                )
        dofs = space.dofs
        self._stiffness, self._damping = (
            taken.model["dof_stiffness"][dofs],
            taken.model["dof_implicit_damping"][dofs],
        )
        self._yielding = self._damping + h * self._stiffness
        self._stretch, self._stretch_q = space.stretch(taken.position, taken.model["position_spring"])
        self.effective: np.ndarray = np.zeros((count, count))
        self.inverse: np.ndarray = np.zeros((count, count))
        self._forces_q, self._forces_v = np.zeros((count, count)), np.zeros((count, count))
        self._add_forces()

    def derivatives(self, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of velocities by positions and velocities before, (n, n), at constant impulses.

        Also finds `effective` and `inverse`.

        Args:
            after: The velocities after the step with these impulses, (n,).
        """
        space, taken, h = self._space, self._taken, self._taken.time_step
        by_q, by_v = self._forces_q.copy(), self._forces_v.copy()
        accelerations = (after - taken.velocity) / h
        known = self.effective.any()
        for body, (first, size), spatial in zip(space.bodies, space.places, self.spatial, strict=True):
            own = slice(first, first + size)
            dtau = _inverse_derivatives(body, taken, own, accelerations[own], spatial)
            by_q[own, own] -= dtau[0]
            by_v[own, own] -= dtau[1]
            if not known:
                self.effective[own, own] = dtau[2] + np.diag(h * self._yielding[own])
                self.inverse[own, own] = _inverse(self.effective[own, own])
        return h * self.inverse @ by_q, np.eye(len(space)) + h * self.inverse @ by_v

    def _add_forces(self) -> None:
        """Find the derivatives of forces that do not depend on accelerations."""
        space, taken = self._space, self._taken
        by_q, by_v = self._forces_q, self._forces_v
        for body, (first, size), spatial in zip(space.bodies, space.places, self.spatial, strict=True):
            own = slice(first, first + size)
            links = slice(body.first_link, body.first_link + 1 + body.joint_count)
            tree = body.rows.tree
            damping = taken.model["tree_linear_damping"][tree], taken.model["tree_angular_damping"][tree]
            masses = taken.model["link_mass"][links]
            constant = taken.link_wrench[links].copy()
            carried = taken.model["link_gravity_compensation"][links] * masses
            constant[:, :3] -= carried[:, None] * taken.gravity
            _, by_q[own, own], by_v[own, own] = link_forces(
                *(spatial, taken.velocity[own], masses, taken.model["link_inertia"][links]),
                *(damping, constant),
            )
        by_q -= self._stiffness[:, None] * self._stretch_q
        by_v -= np.diag(self._yielding + taken.model["dof_damping"][space.dofs])
        drive = taken.drive
        if drive is not None:
            pushed = _explicit_pd(taken.joint_position, taken.velocity, drive)
            by_q -= np.diag(pushed * drive[:, PD_KP])
            by_v -= np.diag(pushed * drive[:, PD_KD])

    def input_derivatives(self, after: np.ndarray, inputs: Sequence[Input]) -> np.ndarray:
        """Derivatives of velocities by inputs, (n, inputs), as `derivatives`, which comes before."""
        return self._taken.time_step * self.inverse @ self._input_forces(after, inputs)

    def mass_input_derivatives(self, response: np.ndarray, inputs: Sequence[Input]) -> np.ndarray:
        """Derivatives of M response by inputs, (n, inputs), for a constant `response` (n,)."""
        velocity, h = self._taken.velocity, self._taken.time_step
        return self._input_forces(velocity, inputs) - self._input_forces(velocity + h * response, inputs)

    def _input_forces(self, after: np.ndarray, inputs: Sequence[Input]) -> np.ndarray:
        """Derivatives of the forces, less those that the motion takes, by inputs, (n, inputs)."""
        space, taken, h = self._space, self._taken, self._taken.time_step
        found = np.zeros((len(space), len(inputs)))
        accelerations = (after - taken.velocity) / h
        regressors: dict[int, np.ndarray] = {}
        for column, given in enumerate(inputs):
            row = given.row
            if given.kind == "torques":
                found[row, column] = 1.0
            elif given.kind == "armature":
                found[row, column] = -accelerations[row]
            elif given.kind == "stiffness":
                found[row, column] = -(self._stretch[row] + h * after[row])
            elif given.kind == "damping":
                explicit = given.field == "dof_damping"
                found[row, column] = -(taken.velocity if explicit else after)[row]
            elif given.kind in ("masses", "inertias", INERTIAL):
                place = next(
                    k for k, body in enumerate(space.bodies) if 0 <= row - body.first_link <= body.joint_count
                )
                first, size = space.places[place]
                own = slice(first, first + size)
                body = space.bodies[place]
                if place not in regressors:
                    regressors[place] = _regressor(body, taken, own, accelerations[own], self.spatial[place])
                found[own, column] = self._by_inertia(
                    given, body, own, regressors[place], self.spatial[place]
                )
        return found

    def mass_derivatives(self, response: np.ndarray) -> np.ndarray:
        """Derivatives of M response by positions, (n, n), for a constant `response` (n,)."""
        found = np.zeros((len(response), len(response)))
        for body, (first, size), spatial in zip(
            self._space.bodies, self._space.places, self.spatial, strict=True
        ):
            own = slice(first, first + size)
            if response[own].any():
                with_it, without = (
                    _inverse_derivatives(body, self._taken, own, response[own] * share, spatial)[0]
                    for share in (1.0, 0.0)
                )
                found[own, own] = with_it - without
        return found

    def _by_inertia(
        self, given: Input, body: Body, own: slice, regressor: np.ndarray, spatial: Spatial
    ) -> np.ndarray:
        """Generalized forces (dofs,) by a mass or a moment of inertia."""
        taken, link = self._taken, given.row - body.first_link
        parts = regressor[:, _PARTS * link : _PARTS * (link + 1)]
        if given.kind == INERTIAL:
            return -parts[:, given.place[1]]
        frame = body.link_inertial_frame(link - 1)
        masses = np.zeros(1 + body.joint_count)
        inertias = np.zeros((1 + body.joint_count, 3))
        constant = np.zeros((1 + body.joint_count, 6))
        if given.kind == "masses":
            centre = np.array(frame.position)
            about = centre @ centre * np.eye(3) - np.outer(centre, centre)
            forces = -parts @ np.concatenate([[1.0], centre, _six(about)])
            masses[link] = 1.0
            constant[link, :3] = -taken.model["link_gravity_compensation"][given.row] * taken.gravity
        else:
            axis = given.place[1]
            turn = matrix_of(np.array(frame.orientation))[:, axis]
            forces = -parts[:, 4:] @ _six(np.outer(turn, turn))
            inertias[link, axis] = 1.0
        tree = body.rows.tree
        damping = taken.model["tree_linear_damping"][tree], taken.model["tree_angular_damping"][tree]
        pushed, _, _ = link_forces(spatial, taken.velocity[own], masses, inertias, damping, constant)
        return forces + pushed


def _six(matrix: np.ndarray) -> np.ndarray:
    """Entries xx, xy, yy, xz, yz, zz."""
    return matrix[(0, 0, 1, 0, 1, 2), (0, 1, 1, 2, 2, 2)]


def _inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverse of an effective mass matrix, with zeros where nothing can move."""
    moving = np.diag(matrix) > 0.0
    if moving.all():
        return np.linalg.inv(matrix)
    found = np.zeros_like(matrix)
    found[np.ix_(moving, moving)] = np.linalg.inv(matrix[np.ix_(moving, moving)])
    return found


def _explicit_pd(positions: np.ndarray, velocities: np.ndarray, drive: np.ndarray) -> np.ndarray:
    """1 where explicit PD control is within its greatest force, else 0."""
    bound = drive[:, PD_MAX_FORCE]
    force = drive[:, PD_KP] * (drive[:, PD_POSITION] - positions) + drive[:, PD_KD] * (
        drive[:, PD_VELOCITY] - velocities
    )
    return np.where((bound > 0.0) & (np.abs(force) < bound), 1.0, 0.0)


def _in_own_axes(
    body: Body, taken: TakenStep, own: slice, accelerations: np.ndarray, spatial: Spatial
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
    """Positions, velocities, accelerations and the base's rotation, as the algorithms take them."""
    first = body.first_position
    count = BASE_POSITIONS + sum(body.position_count)
    position = taken.position[first : first + count]
    velocity = taken.velocity[own].copy()
    changes = accelerations.copy()
    if body.fixed_base:
        return position[BASE_POSITIONS:], velocity, changes, None
    turn = spatial.rotations[0]
    for vector in (velocity, changes):
        vector[_ANGULAR], vector[_LINEAR] = vector[_ANGULAR] @ turn, vector[_LINEAR] @ turn
    return position, velocity, changes, turn


def _inverse_derivatives(
    body: Body, taken: TakenStep, own: slice, accelerations: np.ndarray, spatial: Spatial
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Derivatives of the forces that a motion takes by positions, velocities and accelerations.

    Those of a free base are along axes of the world, which the algorithms have along its own.
    """
    position, velocity, changes, turn = _in_own_axes(body, taken, own, accelerations, spatial)
    found = inverse_dynamics_derivatives(body, position, velocity, changes)
    if turn is None:
        return found.dtau_dq, found.dtau_dv, found.dtau_da
    forces = np.array(inverse_dynamics(body, position, velocity, changes))
    dq = found.dtau_dq.copy()
    for part in (_ANGULAR, _LINEAR):
        # Vectors of the world turn the other way for a base that turns.
        dq[:, _ANGULAR] += found.dtau_dv[:, part] @ cross_matrix(velocity[part])
        dq[:, _ANGULAR] += found.dtau_da[:, part] @ cross_matrix(changes[part])
    # `inverse_dynamics` has the force first.
    dq[_ANGULAR, _ANGULAR] -= cross_matrix(forces[_LINEAR])
    dq[_LINEAR, _ANGULAR] -= cross_matrix(forces[_ANGULAR])
    whole = np.eye(len(velocity))
    whole[_ANGULAR, _ANGULAR] = whole[_LINEAR, _LINEAR] = turn
    return whole @ dq @ whole.T, whole @ found.dtau_dv @ whole.T, whole @ found.dtau_da @ whole.T


def _regressor(
    body: Body, taken: TakenStep, own: slice, accelerations: np.ndarray, spatial: Spatial
) -> np.ndarray:
    position, velocity, changes, turn = _in_own_axes(body, taken, own, accelerations, spatial)
    found = joint_torque_regressor(body, position, velocity, changes).copy()
    if turn is not None:
        found[_ANGULAR], found[_LINEAR] = turn @ found[_ANGULAR], turn @ found[_LINEAR]
    return found
