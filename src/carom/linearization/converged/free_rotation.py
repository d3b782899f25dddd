"""Free rotation by the implicit midpoint rule, linearised: see `kernels.integrators.midpoint`.

With κ, the angular velocity after all torques of the step, in the axes R of the body, that turns by h v:

    I (κ' − κ) = −h ω̄ × I ω̄,  ω̄ = (κ + κ') / 2      free rotation
    v = R ω̄ + Δ                                        Δ by the impulses of rows, which see v
    L⁺ = R I (κ + Rᵀ Δ),  R⁺ = exp(h v) R,  ω⁺ = R⁺ I⁻¹ R⁺ᵀ L⁺

Kernels have linearised the usual motion, with explicit gyroscopic torques, which is corrected here: before
rows are added, so that they see v, and after their equations have been solved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.engine.parameters import MIDPOINT, integrator_of
from carom.layouts.linearization import BASE_DOF
from carom.linearization.inputs import INERTIAL, OFFSETS
from carom.linearization.turns import cross_matrix, left_derivative, quaternion_of, rotation_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.engine.parameters import EngineParameters
    from carom.linearization.inputs import Input
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.tangent import TangentSpace
    from carom.model.builder import WorldArrays

_ROUNDS = 8
_OF_MOMENTS = "inertias", INERTIAL, OFFSETS
_UNIT = np.eye(3)


class FreeRotations:
    """The bodies of a tangent space whose rotation is free."""

    def __init__(self, space: TangentSpace) -> None:
        self._space = space
        kinds = space.firsts()[1]
        single = {body.rows.tree: body.first_link for body in space.bodies if body.joint_count == 0}
        bases = [(dof, int(space.trees[dof])) for dof in np.flatnonzero(kinds == BASE_DOF).tolist()]
        self._bodies = [(dof, single[tree]) for dof, tree in bases if tree in single]
        self._own: dict[int, list[_Rotation]] = {}

    def follow(self, parameters: EngineParameters) -> bool:
        """Begin anew; whether a rotation may be free under these parameters."""
        self._own = {}
        is_midpoint = integrator_of(parameters.integrator, parameters.contact) == MIDPOINT
        return is_midpoint and bool(self._bodies)

    def refuse(self, inputs: Sequence[Input]) -> None:
        """Refuse derivatives by moments of inertia of bodies whose rotation may be free."""
        links = {link for _, link in self._bodies}
        if any(it.kind in _OF_MOMENTS and it.row in links for it in inputs):
            raise NotImplementedError(
                "inertias of bodies of one link have no exact derivatives where they turn by the midpoint "
                'rule (contact="rigid", integrator="midpoint"): use method="differences"'
            )

    def begin(
        self, arrays: WorldArrays, memory: StepMemory, place: int, world: int, time_step: float
    ) -> None:
        """Correct velocities and forces of a place; all forces but those of rows are there."""
        own = self._own[place] = []
        for dof, link in self._bodies:
            moments = arrays.model.numpy["link_inertia"]
            moments = moments[world if len(moments) > 1 else 0, link]
            if moments.min() > 0.0 and not (moments[0] == moments[1] == moments[2]):
                pose = arrays.state.numpy["link_pose"][world, link]
                rotation = rotation_of(np.asarray(pose[3:7], dtype=np.float64))
                own.append(_Rotation.begun(memory, place, dof, moments, rotation, time_step))

    def end(self, memory: StepMemory, place: int, time_step: float) -> None:
        """Correct the derivatives of a place."""
        for rotation in self._own.get(place, ()):
            rotation.end(memory.step[place], len(self._space), time_step)


@dataclass(frozen=True, eq=False, slots=True)
class _Rotation:
    """The rotation of one body.

    Attributes:
        dof: Its first dof.
        moments: Principal moments of inertia [kg m²], (3,).
        turn: R.
        turning: v [rad/s], (3,).
        kicked: κ [rad/s], (3,).
        mean: ω̄ [rad/s], (3,).
        kicks: Derivatives of κ, (3, columns).
        means: Those of ω̄.
    """

    dof: int
    moments: np.ndarray
    turn: np.ndarray
    turning: np.ndarray
    kicked: np.ndarray
    mean: np.ndarray
    kicks: np.ndarray
    means: np.ndarray

    @classmethod
    def begun(
        cls, memory: StepMemory, place: int, dof: int, moments: np.ndarray, turn: np.ndarray, h: float
    ) -> _Rotation:
        """Replace the explicit rotation in the memory of a place."""
        own = slice(dof, dof + 3)
        velocity, force = memory.velocity[place], memory.force[place]
        old, inertia = turn.T @ velocity[0, own], np.diag(moments)
        torque = np.cross(old, moments * old)
        kicked = turn.T @ velocity[1, own] + h * torque / moments
        mean, by_kick = _mean(moments, kicked, h)
        # Of the explicit rotation: velocities after free motion.
        columns = force.shape[2]
        effective = turn @ inertia @ turn.T
        explicit = h * np.linalg.solve(effective, force[0, own])
        rates = np.zeros((3, columns))
        rates[:, len(velocity[0]) + dof : len(velocity[0]) + dof + 3] = _UNIT
        turns = np.zeros((3, columns))
        turns[:, own] = _UNIT
        explicit += rates
        bent = (cross_matrix(old) @ inertia - cross_matrix(moments * old)) / moments[:, None]
        kicks = turn.T @ (explicit + cross_matrix(velocity[1, own]) @ turns)
        kicks += h * bent @ turn.T @ (rates + cross_matrix(velocity[0, own]) @ turns)
        means = by_kick @ kicks
        wanted = turn @ means - cross_matrix(turn @ mean) @ turns
        force[:, own] += effective @ (wanted - explicit) / h
        velocity[1:, own] += turn @ mean - velocity[1, own]
        return cls(dof, moments, turn, velocity[2, own].copy(), kicked, mean, kicks, means)

    def end(self, step: np.ndarray, dofs: int, h: float) -> None:
        """Correct the derivatives of the pose and the angular velocity at the end of the step."""
        own, rates = slice(self.dof, self.dof + 3), slice(dofs + self.dof, dofs + self.dof + 3)
        turn, moments = self.turn, self.moments
        turns = np.zeros((3, step.shape[1]))
        turns[:, own] = _UNIT
        by = rotation_of(quaternion_of(h * self.turning))
        ends = h * left_derivative(h * self.turning) @ step[rates] + by @ turns
        momentum = turn @ (moments * (self.kicked - self.mean + turn.T @ self.turning))
        pushed = step[rates] + cross_matrix(self.turning) @ turns
        momenta = turn @ (moments[:, None] * (self.kicks - self.means + turn.T @ pushed))
        momenta -= cross_matrix(momentum) @ turns
        after = by @ turn
        inverse = after @ np.diag(1.0 / moments) @ after.T
        omega = inverse @ momentum
        step[own] = ends
        step[rates] = inverse @ (momenta + cross_matrix(momentum) @ ends) - cross_matrix(omega) @ ends


def _mean(moments: np.ndarray, kicked: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """The mean angular velocity of a free rotation from κ, and its derivative by κ, (3, 3)."""
    inertia, mean = np.diag(moments), kicked.copy()
    slope = 2.0 * inertia
    for _ in range(_ROUNDS):
        spin = moments * mean
        residual = 2.0 * moments * (mean - kicked) + h * np.cross(mean, spin)
        slope = 2.0 * inertia + h * (cross_matrix(mean) @ inertia - cross_matrix(spin))
        mean = mean - np.linalg.solve(slope, residual)
    spin = moments * mean
    slope = 2.0 * inertia + h * (cross_matrix(mean) @ inertia - cross_matrix(spin))
    return mean, np.linalg.solve(slope, 2.0 * inertia)
