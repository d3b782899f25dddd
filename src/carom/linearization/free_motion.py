"""Derivatives of the equations of motion in a step: forces on links, springs, and inputs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.sweeps import sweeps_of
from carom.linearization.inputs import INERTIAL, OFFSETS
from carom.linearization.offsets import OffsetForces
from carom.linearization.spatial import Spatial, link_forces
from carom.linearization.taken_step import motion_questions
from carom.linearization.turns import matrix_of
from carom.native.kernels import regressor_kernel

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.inputs import Input
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace
    from carom.scene.core.body_core import BodyCore

_PARTS = 10
_ANGULAR, _LINEAR = slice(0, 3), slice(3, 6)


# Inputs that change how forces lead to motion, apart from torques.
_OF_MOTION = ("armature", "stiffness", "damping", "masses", "inertias", INERTIAL, OFFSETS)
# Those of them that belong to links.
OF_INERTIA = ("masses", "inertias", INERTIAL, OFFSETS)


class FreeMotion:
    """What the host adds to the equations of motion M (v⁺ - v) / h = forces + Jᵀ λ / h of a linearised step.

    A kernel has written what follows from inertia, joint springs and damping.
    """

    def __init__(self, space: TangentSpace, taken: TakenStep) -> None:
        self._space = space
        self._taken = taken
        self.time_step: float = taken.time_step
        self.parameters: EngineParameters = taken.parameters
        self.position: np.ndarray = taken.position
        self._spatial: list[Spatial] | None = None

    def _stretched(self) -> tuple[np.ndarray, np.ndarray]:
        """How far springs are stretched, and the derivatives by positions."""
        taken = self._taken
        return self._space.stretch(taken.position, taken.model["position_spring"])

    @property
    def spatial(self) -> list[Spatial]:
        """Motion subspaces of each body."""
        if self._spatial is None:
            space, taken = self._space, self._taken
            self._spatial = []
            for body, (first, size) in zip(space.bodies, space.places, strict=True):
                links = slice(body.first_link, body.first_link + 1 + body.joint_count)
                columns = taken.angular[first : first + size], taken.linear[first : first + size]
                self._spatial.append(Spatial(body, taken.link_pose[links], columns))
        return self._spatial

    def add_forces(self, by_q: np.ndarray, by_v: np.ndarray) -> None:
        """Add derivatives of forces on links, and of springs of joints with several positions, (2, n, n)."""
        space, taken = self._space, self._taken
        for place, (body, (first, size)) in enumerate(zip(space.bodies, space.places, strict=True)):
            own = slice(first, first + size)
            links = slice(body.first_link, body.first_link + 1 + body.joint_count)
            tree = body.rows.tree
            linear, angular = (
                taken.model["tree_linear_damping"][tree],
                taken.model["tree_angular_damping"][tree],
            )
            compensated = taken.model["link_gravity_compensation"][links]
            constant = taken.link_wrench[links]
            if not (linear or angular or constant.any() or compensated.any()):
                continue
            masses = taken.model["link_mass"][links]
            constant = constant.copy()
            constant[:, :3] -= (compensated * masses)[:, None] * taken.gravity
            _, pushed_q, pushed_v = link_forces(
                *(self.spatial[place], taken.velocity[own], masses, taken.model["link_inertia"][links]),
                *((linear, angular), constant),
            )
            by_q[:, own, own] += pushed_q
            by_v[:, own, own] += pushed_v
        several = space.several
        stiffness = taken.model["dof_stiffness"][space.dofs[several]]
        if stiffness.any():
            by_q[:, several] -= stiffness[:, None] * self._stretched()[1][several]

    def add_inputs(self, found: np.ndarray, inputs: Sequence[Input]) -> None:
        """Put the derivatives of forces, less those of motion, by inputs into (2, n, inputs).

        The first are with the accelerations of free motion, the second with those of the solver. Torques are
        left out.
        """
        for part, end in zip(found, self._taken.ends, strict=True):
            self._put_inputs(part, end, inputs)

    def mass_input_derivatives(self, response: np.ndarray, inputs: Sequence[Input]) -> np.ndarray:
        """Derivatives of M response by inputs, (n, inputs), for a constant `response` (n,)."""
        velocity, h = self._taken.velocity, self._taken.time_step
        found = np.zeros((2, len(self._space), len(inputs)))
        for part, end in zip(found, (velocity, velocity + h * response), strict=True):
            self._put_inputs(part, end, inputs)
        return found[0] - found[1]

    def bias_input_derivatives(self, inputs: Sequence[Input]) -> np.ndarray:
        """Derivatives of forces at rest of acceleration, c and minus those on links, by inputs, likewise."""
        found = np.zeros((len(self._space), len(inputs)))
        self._put_inputs(found, self._taken.velocity, inputs)
        return -found

    def _put_inputs(self, found: np.ndarray, after: np.ndarray, inputs: Sequence[Input]) -> None:
        """Put the derivatives of the forces, less those that the motion takes, by inputs into (n, inputs)."""
        space, taken, h = self._space, self._taken, self._taken.time_step
        accelerations = (after - taken.velocity) / h
        regressors: dict[int, np.ndarray] = {}
        offsets: dict[int, OffsetForces] = {}
        stretch: np.ndarray | None = None
        for column, given in enumerate(inputs):
            row = given.row
            if given.kind == "armature":
                found[row, column] = -accelerations[row]
            elif given.kind == "stiffness":
                stretch = self._stretched()[0] if stretch is None else stretch
                found[row, column] = -stretch[row] if taken.is_explicit else -(stretch[row] + h * after[row])
            elif given.kind == "damping":
                explicit = taken.is_explicit or given.field == "dof_damping"
                found[row, column] = -(taken.velocity if explicit else after)[row]
            elif given.kind in OF_INERTIA:
                place = next(
                    k for k, body in enumerate(space.bodies) if 0 <= row - body.first_link <= body.joint_count
                )
                first, size = space.places[place]
                own = slice(first, first + size)
                body, spatial = space.bodies[place], self.spatial[place]
                if given.kind == OFFSETS:
                    if place not in offsets:
                        offsets[place] = OffsetForces(body, taken, own, accelerations[own], spatial)
                    found[own, column] = offsets[place].derivative(given)
                    continue
                if place not in regressors:
                    regressors[place] = _regressor(body, taken, own, accelerations[own], spatial)
                found[own, column] = self._by_inertia(given, body, own, regressors[place], spatial)

    def _by_inertia(
        self, given: Input, body: BodyCore, own: slice, regressor: np.ndarray, spatial: Spatial
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


def needs_host(space: TangentSpace, model: dict[str, np.ndarray], wrench: np.ndarray) -> bool:
    """Whether `FreeMotion.add_forces` adds anything in one of the worlds of a model."""
    # Of small arrays this takes less time than `any`.
    count = np.count_nonzero
    names = ("tree_linear_damping", "tree_angular_damping", "link_gravity_compensation")
    if count(wrench) or any(count(model[name]) for name in names):
        return True
    if not len(space.several):
        return False
    return bool(count(model["dof_stiffness"][:, space.dofs[space.several]]))


def of_motion(inputs: Sequence[Input]) -> bool:
    """Whether `FreeMotion.add_inputs` adds anything."""
    return any(it.kind in _OF_MOTION for it in inputs)


def _regressor(
    body: BodyCore, taken: TakenStep, own: slice, accelerations: np.ndarray, spatial: Spatial
) -> np.ndarray:
    """Forces per inertial parameter; those of a free base along axes of the world."""
    question = motion_questions(body, taken, own, accelerations[None])
    sweeps = sweeps_of(body)
    width = _PARTS * sweeps.links
    answers = sweeps.answers(regressor_kernel, sweeps.dofs * width, sweeps.links, questions=question)
    found = answers.reshape(sweeps.dofs, width)
    if not body.fixed_base:
        turn = spatial.rotations[0]
        found[_ANGULAR], found[_LINEAR] = turn @ found[_ANGULAR], turn @ found[_LINEAR]
    return found
