"""Steps whose velocities end in (M + h D) Δv' = M Δv, linearised: MuJoCo's Euler, implicitfast and implicit.

Kernels have linearised v + Δv, to which explicit forces and all rows lead. With K = M + h D,

    K dΔv' = dM (Δv − Δv') + M dΔv − h dD Δv'

where dM x is that of inverse dynamics at an acceleration x. Bias forces c are quadratic in velocities, so
those of D = ∂c/∂v are D x = (c(v + x) − c(v − x)) / 2, whose derivatives are those of inverse dynamics, too.
"""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING

import numpy as np

from carom.engine.parameters import EULER, IMPLICIT, IMPLICIT_FAST, EngineParameters
from carom.linearization.free_motion import OF_INERTIA, FreeMotion
from carom.linearization.integrators.implicit_dampings import Dampings
from carom.linearization.integrators.motion_answers import MotionAnswers
from carom.linearization.integrators.positions import changes_after
from carom.linearization.taken_step import TakenStep

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.linearization.inputs import Input
    from carom.linearization.integrators.frame_motions import Carried, FrameMotions
    from carom.linearization.step_kernels import Mechanisms
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.stepping import Copies
    from carom.linearization.tangent import TangentSpace
    from carom.scene.core.body_core import BodyCore


class ImplicitEnds:
    """Corrects derivatives of steps of the worlds of `copies`.

    Args:
        space: The tangent space.
        inputs: Controls and parameters.
        copies: The worlds, which take the steps.
        mechanisms: Mechanisms of their bodies.
        frames: Bases that move by their frames, whose turning carries the centre of mass along.
    """

    def __init__(
        self,
        space: TangentSpace,
        inputs: Sequence[Input],
        copies: Copies,
        mechanisms: Mechanisms,
        frames: FrameMotions,
    ) -> None:
        self._frames = frames
        self._space, self._inputs, self._copies = space, inputs, copies
        self._answers = MotionAnswers(mechanisms)
        self._of_inertia = [column for column, it in enumerate(inputs) if it.kind in OF_INERTIA]
        self._of_mass = any(it.kind in (*OF_INERTIA, "armature") for it in inputs)

    def follow(self, parameters: EngineParameters) -> bool:
        """Whether steps under these parameters end so in any world."""
        if parameters.integrator == EULER:
            return bool(self._copies.engine.arrays.model.numpy["tree_joint_terms"].any())
        return parameters.integrator in (IMPLICIT_FAST, IMPLICIT)

    def end(self, memory: StepMemory, place: int, taken: TakenStep, world: int) -> None:
        """Correct the derivatives of a place.

        Raises:
            NotImplementedError: Something that damps has no exact derivatives.
        """
        kind = taken.parameters.integrator
        space, step, h = self._space, memory.step[place], taken.time_step
        dofs, width = len(space), memory.step.shape[1]
        terms = taken.model["tree_joint_terms"]
        corrected = [
            (body, slice(first, first + size))
            for body, (first, size) in zip(space.bodies, space.places, strict=True)
            if kind != EULER or terms[body.rows.tree] != 0.0
        ]
        if not corrected:
            return
        dampings = Dampings(space, self._copies, memory, place, taken)
        dampings.find(self._inputs, with_forces=kind != EULER)
        inertia, damping = np.array(memory.effective[place]), np.zeros((dofs, dofs))
        for along, armature in dampings.armature:
            inertia += armature * np.outer(along, along)
        for arm in dampings.arms:
            damping += arm.damping * np.outer(arm.along, arm.along)
        damping[np.diag_indices(dofs)] += taken.model["dof_implicit_damping"][space.dofs]
        # As in MuJoCo, rotations of a lone free body are implicit in any case.
        turning = [
            (body, own)
            for body, own in corrected
            if kind == IMPLICIT or (kind == IMPLICIT_FAST and body.joint_count == 0)
        ]
        is_carried = bool(turning) and self._frames.follow(taken.parameters)
        still = np.zeros((1, dofs))
        for body, own in turning:
            self._refuse_drag(body, taken)
            rates = taken.velocity[None, own]
            damping[own, own] += self._answers.of(body, taken, own, world, rates, still[:, own])[1][0]
        carried = [
            (own, it)
            for it in (self._frames.at(taken.position, taken.velocity) if is_carried else ())
            for _, own in turning
            if own.start == it.dof
        ]
        for own, it in carried:
            damping[own, it.turns] += inertia[own, it.shifts] @ it.by_omega
        before = np.zeros((dofs, step.shape[1]))
        before[:, dofs : 2 * dofs] = np.eye(dofs)
        change = taken.ends[1] - taken.velocity
        after = taken.state["dof_velocity"][space.dofs]
        for body, own in corrected:
            moving = np.flatnonzero(np.diag(inertia)[own] > 0.0) + own.start
            system = (inertia + h * damping)[np.ix_(moving, moving)]
            wanted = np.zeros(dofs)
            wanted[moving] = np.linalg.solve(system, inertia[moving] @ _only(change, own))
            x = _only(change, own) - wanted
            right = inertia[:, own] @ (step[dofs + own.start : dofs + own.stop] - before[own])
            by_position, _ = self._answers.of(body, taken, own, world, still[:, own], x[None, own])
            right[own, own] += by_position[0]
            bent = np.zeros_like(right)
            if any(it is body for it, _ in turning):
                self._add_turning(bent, body, own, taken, world, wanted)
            for it in (it for part, it in carried if part == own):
                self._add_carried(bent, it, body, own, taken, world, wanted, inertia)
            dampings.add_changes(bent, wanted, self._inputs)
            right -= h * bent
            if self._inputs:
                self._add_inputs(right[:, width:], taken, x, wanted, own, turning)
            limit = taken.model["tree_max_velocity"][body.rows.tree]
            found = np.zeros((dofs, step.shape[1]))
            found[moving] = np.linalg.solve(system, right[moving])
            found[own] += before[own]
            found[np.abs(after) >= limit] = 0.0
            step[dofs + own.start : dofs + own.stop] = found[own]
        moved = np.eye(dofs, step.shape[1])
        step[:dofs] = changes_after(space, after, moved, step[dofs : 2 * dofs], h)

    def _add_turning(
        self,
        bent: np.ndarray,
        body: BodyCore,
        own: slice,
        taken: TakenStep,
        world: int,
        wanted: np.ndarray,
    ) -> None:
        """Add how the D of bias forces times `wanted` changes."""
        dofs, size = len(self._space), own.stop - own.start
        rates = taken.velocity[own] + np.array([[1.0], [-1.0]]) * wanted[own]
        both = self._answers.of(body, taken, own, world, rates, np.zeros((2, size)))
        for part, answer in zip((own, slice(dofs + own.start, dofs + own.stop)), both, strict=True):
            bent[own, part] += 0.5 * (answer[0] - answer[1])

    def _add_carried(
        self,
        bent: np.ndarray,
        it: Carried,
        body: BodyCore,
        own: slice,
        taken: TakenStep,
        world: int,
        wanted: np.ndarray,
        inertia: np.ndarray,
    ) -> None:
        """Add how M times the change of s by `wanted` changes, see `frame_motions`."""
        dofs = len(self._space)
        change, by_turn, by_omega = self._frames.damping(it, wanted)
        kicked, still = np.zeros((1, dofs)), np.zeros((1, own.stop - own.start))
        kicked[0, it.shifts] = change
        by_position, _ = self._answers.of(body, taken, own, world, still, kicked[:, own])
        bent[own, own] += by_position[0]
        of_shifts = inertia[own, it.shifts]
        bent[own, it.turns] += of_shifts @ by_turn
        bent[own, dofs + it.dof : dofs + it.dof + 3] += of_shifts @ by_omega
        if self._inputs and self._of_mass:
            motion, columns = FreeMotion(self._space, taken), bent.shape[1] - len(self._inputs)
            bent[own, columns:] += motion.mass_input_derivatives(kicked[0], self._inputs)[own]

    def _add_inputs(
        self,
        right: np.ndarray,
        taken: TakenStep,
        x: np.ndarray,
        wanted: np.ndarray,
        own: slice,
        turning: Sequence[tuple[BodyCore, slice]],
    ) -> None:
        """Add how M x and −h D `wanted` change with inputs to (n, inputs)."""
        h, space = taken.time_step, self._space
        for column, given in enumerate(self._inputs):
            if given.field == "dof_implicit_damping" and own.start <= given.row < own.stop:
                right[given.row, column] -= h * wanted[given.row]
        if self._of_mass:
            motion = FreeMotion(space, taken)
            right[own] += motion.mass_input_derivatives(x, self._inputs)[own]
        if self._of_inertia and any(it == own for _, it in turning):
            parts: list[np.ndarray] = []
            for sign in (1.0, -1.0):
                faster = copy(taken)
                faster.velocity = taken.velocity + sign * wanted
                parts.append(FreeMotion(space, faster).bias_input_derivatives(self._inputs))
            columns = self._of_inertia
            right[own, columns] -= 0.5 * h * (parts[0] - parts[1])[own][:, columns]

    def _refuse_drag(self, body: BodyCore, taken: TakenStep) -> None:
        tree = body.rows.tree
        if taken.model["tree_linear_damping"][tree] or taken.model["tree_angular_damping"][tree]:
            raise NotImplementedError(
                f"air damping of {body.name!r} has no exact derivatives with "
                f'integrator={taken.parameters.integrator!r}: use method="differences", or '
                'integrator="discrete"'
            )


def _only(vector: np.ndarray, own: slice) -> np.ndarray:
    """A vector (n,) with zeros but for some dofs."""
    found = np.zeros_like(vector)
    found[own] = vector[own]
    return found
