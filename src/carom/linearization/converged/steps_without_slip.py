"""Steps with passes without slip, linearised: that without them first, in a copy, then what passes change."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from carom.engine.parameters import COMPLIANT, RK4
from carom.linearization.converged.noslip import FirstProblem, SecondProblem, motion_force
from carom.linearization.inputs import CONTROLS
from carom.linearization.quality import Qualities
from carom.linearization.stepping import Copies
from carom.linearization.taken_step import StepDerivatives, TakenStep

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from carom.engine.parameters import EngineParameters
    from carom.linearization.inputs import Input
    from carom.linearization.integrators.frame_motions import FrameMotions
    from carom.linearization.integrators.implicit_ends import ImplicitEnds
    from carom.linearization.row_names import RowNames
    from carom.linearization.step_kernels import StepKernels
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.tangent import TangentSpace


def has_passes(parameters: EngineParameters) -> bool:
    """Whether steps under these parameters have passes without slip."""
    return bool(parameters.noslip_iterations) and parameters.contact == COMPLIANT


class Stages(Protocol):
    """What linearises steps of a copy up to their end: a `StepLinearizer`."""

    @property
    def kernels(self) -> StepKernels:
        """Kernels for the copy."""
        ...

    @property
    def contacts(self) -> int:
        """Number of contacts of the copy."""
        ...

    def start(self, world: int) -> np.ndarray:
        """Positions of the copy before its last step."""
        ...

    def stage(
        self, parameters: Any, worlds: np.ndarray | None, smoothing: float, *, described: bool
    ) -> tuple[StepDerivatives, np.ndarray]:
        """As `StepLinearizer.stage`."""
        ...


class StepsWithoutSlip:
    """Linearises steps of one copy of a world that have passes without slip.

    Args:
        space: The tangent space.
        inputs: Controls and parameters.
        copies: The copy.
        kernels: Kernels for it.
        others: Makes what linearises steps of other copies.
        ends: What integrators do at the end of a step.
        frames: Bases that move by their frames.
        names: Names of rows.
    """

    def __init__(
        self,
        space: TangentSpace,
        inputs: Sequence[Input],
        copies: Copies,
        kernels: StepKernels,
        others: Callable[[Copies], Stages],
        ends: ImplicitEnds,
        frames: FrameMotions,
        names: RowNames,
    ) -> None:
        self._space, self._inputs, self._copies = space, inputs, copies
        self._kernels, self._others, self._ends, self._names = kernels, others, ends, names
        self._frames = frames
        self._second = SecondProblem(space, copies, kernels, frames)
        self._yielding: tuple[Copies, Stages] | None = None

    def step(self, parameters: EngineParameters, smoothing: float, *, described: bool) -> StepDerivatives:
        """As `StepLinearizer.step`."""
        self._refuse(parameters, smoothing)
        copies, dofs = self._copies, len(self._space)
        copies.apply_forces()
        plain = copy(parameters)
        plain.noslip_iterations = 0
        linearizer = self._follow(plain)
        found, _ = linearizer.stage(plain, None, 0.0, described=described)
        kernels, old = linearizer.kernels, linearizer.kernels.memory
        assert old is not None
        count = int(old.row_count[0])
        rows = [it[0, :count].copy() for it in (old.row_kind, old.row_status, old.row_dof, old.row_switch)]
        first = FirstProblem(
            kinds=rows[0],
            numbers=rows[2],
            jacobian=old.jacobian[0, :count].copy(),
            impulses=old.row_impulse[0, :count].copy(),
            impulse_changes=old.side[0, :count].copy(),
            velocity=old.velocity[0, 2].copy(),
            change=found_of(found)[dofs : 2 * dofs],
            force=motion_force(kernels, old),
        )
        by_frame, h = self._frames.follow(parameters), parameters.substep_time
        if by_frame:
            self._frames.shift(old, 0, linearizer.start(0), h)
        wrench = copies.engine.arrays.state.numpy["link_wrench"].copy()
        copies.step()
        memory = self._kernels.prepare(1, linearizer.contacts, 0.0, parameters.contact)
        memory.world.fill(0)
        self._measure_as(memory, old)
        change, status, away = self._second.solve(first, memory, (kernels, old), parameters)
        # The kernel takes changes of velocities for those by forces, and finds what follows from them.
        unit = np.eye(dofs, change.shape[1], dofs)
        memory.force[0, 0] = memory.effective[0] @ (change - unit) / parameters.substep_time
        there, memory.row_count[0] = int(memory.row_count[0]), 0
        self._kernels.finish(1)
        memory.row_count[0] = there
        taken = TakenStep(parameters, self._space, copies, wrench, memory.velocity[0])
        if self._ends.follow(parameters):
            self._ends.end(memory, 0, taken, 0)
        if by_frame:
            self._frames.end(memory, 0, taken.position, taken.after, h)
        names, qualities = found.rows, found.qualities
        if described:
            own = status >= 0
            old.row_count[0], old.row_kind[0, :count], old.row_dof[0, :count] = count, rows[0], rows[2]
            old.row_status[0, :count] = np.where(own, status, rows[1])
            old.row_switch[0, :count] = np.where(own, np.where(np.isnan(away), -1.0, away), rows[3])
            names = [self._names(old, 0)]
            known = found.qualities[0]
            qualities = Qualities(np.square(found.qualities.residuals))
            qualities.add(old, 0, 1, {0: known.redundant}, [known.others])
        result, width = memory.step[:1].copy(), memory.step.shape[1]
        return StepDerivatives(result[:, :, :width], result[:, :, width:], names, qualities)

    def _follow(self, plain: EngineParameters) -> Stages:
        """What linearises steps of a copy of the copy, in its state, under parameters without passes."""
        known = self._yielding
        if known is not None:
            known[0].parameters = plain
            if known[0].follow(self._copies.engine, 0.0):
                return known[1]
        copies = Copies.of_engine(self._copies.engine, plain, 1)
        self._yielding = copies, self._others(copies)
        return self._yielding[1]

    def _measure_as(self, memory: StepMemory, old: StepMemory) -> None:
        """Let contacts move as those of the first problem do, where that was measured."""
        count = min(memory.measured.shape[1], old.measured.shape[1])
        memory.measured[:, :count] = old.measured[:, :count]
        if len(old.measured_motion):
            self._kernels.make_motions(len(old.measured_motion))
            memory.measured_motion[: len(old.measured_motion)] = old.measured_motion

    def _refuse(self, parameters: EngineParameters, smoothing: float) -> None:
        others = [it.kind for it in self._inputs if it.kind not in CONTROLS]
        reason = ""
        if others:
            reason = f"derivatives by {others[0]}"
        elif parameters.integrator == RK4:
            reason = "steps of RK4"
        elif smoothing:
            reason = "smoothed derivatives"
        elif self._copies.count > 1:
            reason = "steps of several worlds"
        if reason:
            raise NotImplementedError(
                f'{reason} are not exact with noslip_iterations: use method="differences", or '
                "world.change_parameters(noslip_iterations=0)"
            )


def found_of(found: StepDerivatives) -> np.ndarray:
    """Derivatives of the state of one world by its state and by inputs, (nx, columns)."""
    return np.hstack([found.by_state[0], found.by_input[0]])
