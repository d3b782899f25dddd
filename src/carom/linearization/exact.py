"""The derivatives of one step, by the implicit function theorem over the rows that hold at its end.

Kernels find what follows from inertia, joints, user constraints and contacts, and solve for the impulses;
the host adds forces on links and parameters of inertia where there are any.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.engine.can_collide import has_late_links
from carom.engine.parameters import CONVERGED, RK4
from carom.layouts.contacts import THERE
from carom.layouts.linearization import (
    CONTACT_FRICTION,
    FOUND,
    OVERFLOWED,
    REDUNDANT,
    ROLLING_FRICTION,
    ROW_SLIDES,
    UNMEASURED,
    WANTED,
)
from carom.linearization.converged.free_rotation import FreeRotations
from carom.linearization.converged.softness import add_softness
from carom.linearization.converged.steps_without_slip import StepsWithoutSlip, has_passes
from carom.linearization.converged.switches import Switches
from carom.linearization.free_motion import OF_INERTIA, FreeMotion, needs_host, of_motion
from carom.linearization.integrators.frame_motions import FrameMotions
from carom.linearization.integrators.implicit_ends import ImplicitEnds
from carom.linearization.integrators.runge_kutta import RungeKuttaSteps
from carom.linearization.measured import ContactMotions
from carom.linearization.offsets import refuse_rows
from carom.linearization.path_inertia import PathInertia
from carom.linearization.quality import Qualities, redundant_rows
from carom.linearization.row_names import RowNames, UnmeasuredContactError, raise_problem
from carom.linearization.step_kernels import Mechanisms, StepKernels, lone_mechanisms
from carom.linearization.stepping import greatest
from carom.linearization.taken_step import StepDerivatives, TakenStep

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.stepping import Copies
    from carom.linearization.tangent import TangentSpace
    from carom.model.builder import WorldArrays
    from carom.scene.core.world_core import WorldCore

# Singular values of the rows' equations below this share of the greatest one are those of redundant rows.
_REDUNDANT = 1e-7


class StepLinearizer:
    """Linearises steps of the worlds of `copies`.

    Args:
        space: The tangent space.
        inputs: Controls and parameters.
        copies: The worlds, which take the steps.
        mechanisms: Mechanisms of their bodies.
        threads: Number of threads.
    """

    def __init__(
        self,
        space: TangentSpace,
        inputs: Sequence[Input],
        copies: Copies,
        mechanisms: Mechanisms,
        threads: int,
    ) -> None:
        self._space, self._inputs, self._copies = space, inputs, copies
        self._kernels = StepKernels(space, inputs, copies, mechanisms, threads)
        self._names = RowNames(space)
        torques = [(given.row, column) for column, given in enumerate(inputs) if given.kind == "torques"]
        self._width = 2 * len(space) + len(space.activations)
        # Forces of a place before kernels and host add to them: torques are forces themselves.
        self._pushed = np.zeros((2, len(space), self._width + len(inputs)))
        for row, column in torques:
            self._pushed[:, row, self._width + column] = 1.0
        self._of_motion = of_motion(inputs)
        self._of_inertia = any(it.kind in OF_INERTIA for it in inputs)
        self._contacts = ContactMotions(space, copies)
        self._frames = FrameMotions(space, copies.engine.arrays)
        self._paths = PathInertia(space, copies, self._frames)
        self._switches = Switches(space, copies)
        self._rotations = FreeRotations(space)
        self._ends = ImplicitEnds(space, inputs, copies, mechanisms, self._frames)

        def others(stages: Copies) -> StepLinearizer:
            return StepLinearizer(space, inputs, stages, mechanisms, threads)

        self._stages = RungeKuttaSteps(space, inputs, copies, others, threads)
        self._without_slip = StepsWithoutSlip(
            *(space, inputs, copies, self._kernels, others, self._ends, self._frames, self._names)
        )
        self._redundant: dict[int, tuple[int, ...]] = {}
        self._is_stage = False
        self._describes = True

    @property
    def kernels(self) -> StepKernels:
        """The kernels for its copies."""
        return self._kernels

    @property
    def contacts(self) -> int:
        """The greatest number of contacts in a world after the last step."""
        counts = self._copies.engine.contact_arrays.contacts.numpy["count_contacts"]
        return greatest(counts[:, THERE])

    def start(self, world: int) -> np.ndarray:
        """Positions of all coordinates of a world before its last step."""
        found: np.ndarray = self._copies.scratch(world)["position_start"]
        return found

    def suits(self, space: TangentSpace, inputs: Sequence[Input], copies: Copies) -> bool:
        """Whether it was made for these."""
        return self._kernels.suit(space, inputs, copies)

    def step(
        self, parameters: Any, worlds: np.ndarray | None, smoothing: float, *, described: bool = True
    ) -> StepDerivatives:
        """Perform a step of some worlds, None for all, and differentiate it.

        Args:
            parameters: Parameters of their engine.
            worlds: Numbers of the worlds, (m,).
            smoothing: Softness of all rows, relative to their own.
            described: Whether to name the rows, and to find how far derivatives can be trusted.

        Raises:
            NotImplementedError: Something in the step has no exact derivatives.
            ValueError: Derivatives are not finite.
            carom.errors.SimulationError: A velocity is not finite.
        """
        self._describes = described
        if parameters.integrator == RK4 and not has_passes(parameters):
            numbers = np.arange(self._copies.count) if worlds is None else worlds
            return self._stages.step(parameters, numbers, smoothing, described=described)
        if has_passes(parameters):
            return self._without_slip.step(parameters, smoothing, described=described)
        return self._step(parameters, worlds, smoothing)[0]

    def stage(
        self, parameters: Any, worlds: np.ndarray | None, smoothing: float, *, described: bool
    ) -> tuple[StepDerivatives, np.ndarray]:
        """As `step`, of explicit forces and all rows only, whatever the integrator makes of these.

        Returns:
            The derivatives, and the velocities of the dofs after the step, (m, n).
        """
        self._is_stage, self._describes = True, described
        try:
            return self._step(parameters, worlds, smoothing)
        finally:
            self._is_stage = False

    def _step(
        self, parameters: Any, worlds: np.ndarray | None, smoothing: float
    ) -> tuple[StepDerivatives, np.ndarray]:
        copies = self._copies
        _refuse_others(copies.engine.arrays, of_inertia=self._of_inertia)
        rotating = self._rotations.follow(parameters)
        if rotating:
            self._rotations.refuse(self._inputs)
        by_frame = self._frames.follow(parameters)
        if by_frame:
            self._frames.refuse(self._inputs)
        wrench = copies.engine.arrays.state.numpy["link_wrench"].copy()
        residuals = copies.engine.arrays.state.numpy["tree_residual"]
        residuals.fill(0.0)
        copies.step(worlds)
        residuals = copies.engine.arrays.state.numpy["tree_residual"]
        numbers = np.arange(copies.count) if worlds is None else worlds
        engine = copies.engine
        contacts = engine.contact_arrays.contacts.numpy["count_contacts"][:, THERE]
        memory = self._kernels.prepare(len(numbers), greatest(contacts), smoothing, parameters.contact)
        self._paths.follow()
        hosted = self._of_motion or bool(self._paths) or rotating or by_frame
        hosted = hosted or needs_host(self._space, engine.arrays.model.numpy, wrench)
        found = np.empty((len(numbers), *memory.step.shape[1:]))
        names: list[tuple[tuple[str, str], ...]] = []
        ends = np.empty((len(numbers), len(self._space)))
        qualities = Qualities(_greatest_of_each(residuals if worlds is None else residuals[numbers]))
        for first in range(0, len(numbers), memory.places):
            some = numbers[first : first + memory.places]
            try:
                memory.measured.fill(UNMEASURED)
                memory.near.fill(UNMEASURED)
                names += self._find(memory, parameters, some, wrench, hosted)
            except UnmeasuredContactError:
                self._measure(memory, parameters, some)
                names += self._find(memory, parameters, some, wrench, hosted)
            found[first : first + len(some)] = memory.step[: len(some)]
            ends[first : first + len(some)] = memory.velocity[: len(some), 2]
            if self._describes:
                names_of = self._switches.of
                others = [names_of(memory, place, world) for place, world in enumerate(some.tolist())]
                qualities.add(memory, first, len(some), self._redundant, others)
        by_state, by_input = found[:, :, : self._width], found[:, :, self._width :]
        return StepDerivatives(by_state, by_input, names, qualities), ends

    def _find(
        self, memory: StepMemory, parameters: Any, worlds: np.ndarray, wrench: np.ndarray, on_host: bool
    ) -> list[tuple[tuple[str, str], ...]]:
        count, kernels = len(worlds), self._kernels
        self._redundant.clear()
        rotating = on_host and self._rotations.follow(parameters)
        by_frame, h = on_host and self._frames.follow(parameters), parameters.substep_time
        memory.world[:count] = worlds
        memory.problem.fill(FOUND)
        memory.row_count.fill(0)
        memory.force[:count] = self._pushed
        if on_host:
            kernels.find_motion(count)
            self._check(memory, worlds)
            taken = [
                TakenStep(parameters, self._space, self._copies, wrench, memory.velocity[place], world)
                for place, world in enumerate(worlds.tolist())
            ]
            motions = [FreeMotion(self._space, it) for it in taken]
            for place, motion in enumerate(motions):
                self._add_host(memory, place, motion)
                if rotating:
                    arrays = self._copies.engine.arrays
                    self._rotations.begin(arrays, memory, place, int(worlds[place]), h)
                if by_frame:
                    self._frames.begin(memory, place, taken[place].position, h)
            if self._of_motion or self._paths:
                kernels.add_rows(count)
                self._check(memory, worlds)
                for place, motion in enumerate(motions):
                    self._paths.add(memory, place, motion)
                    if self._of_motion:
                        self._add_to_rows(
                            memory,
                            place,
                            motion,
                            isotropic=parameters.isotropic_friction,
                            converged=parameters.contact in CONVERGED,
                        )
                kernels.finish(count)
            else:
                kernels.solve(count)
        else:
            kernels.find(count)
        self._check(memory, worlds)
        for place in range(count if rotating else 0):
            self._rotations.end(memory, place, h)
        implicit = self._ends.follow(parameters)
        if not self._is_stage and (implicit or by_frame):
            for place, world in enumerate(worlds.tolist()):
                step = TakenStep(
                    *(parameters, self._space, self._copies, wrench, memory.velocity[place]), world
                )
                if implicit:
                    self._ends.end(memory, place, step, world)
                if by_frame:
                    self._frames.end(memory, place, step.position, step.after, h)
        return [self._names(memory, place) for place in range(count)] if self._describes else []

    def _measure(self, memory: StepMemory, parameters: Any, worlds: np.ndarray) -> None:
        """Measure how contacts move of which kernels have asked that; others stay unknown."""
        wanted = memory.measured[: len(worlds)] == WANTED
        self._kernels.make_motions(int(wanted.sum()))
        self._contacts.follow(parameters)
        slot = 0
        for place in np.flatnonzero(wanted.any(axis=1)).tolist():
            contacts = np.flatnonzero(wanted[place])
            motions, known = self._contacts.measure(int(worlds[place]), memory.velocity[place, 0], contacts)
            for contact in np.flatnonzero(known).tolist():
                memory.measured_motion[slot] = motions[contact]
                memory.measured[place, contacts[contact]] = slot
                slot += 1

    def _check(self, memory: StepMemory, worlds: np.ndarray) -> None:
        """Solve equations of rows that are redundant, and raise errors."""
        if not np.count_nonzero(memory.problem):
            return
        for place in np.flatnonzero(memory.problem[: len(worlds)]).tolist():
            problem = int(memory.problem[place])
            if problem == OVERFLOWED:
                fastest = int(np.argmax(np.abs(memory.velocity[place, 0])))
                dof = " ".join(it for it in self._space.labels[fastest] if it)
                raise ValueError(
                    f"in world {worlds[place]} a derivative is not finite; the fastest is {dof} with "
                    f"{memory.velocity[place, 0, fastest]:g}"
                )
            if problem != REDUNDANT:
                raise_problem(problem, self._space, int(memory.problem_of[place]))
            rows = int(memory.row_count[place])
            system = memory.square("system", place, rows)
            self._redundant[place] = redundant_rows(system, _REDUNDANT)
            memory.square("solution", place, rows)[:] = np.linalg.pinv(system, rcond=_REDUNDANT)
            memory.problem[place] = FOUND
            self._kernels.resume(place)

    def _add_host(self, memory: StepMemory, place: int, motion: FreeMotion) -> None:
        """Add what the host adds to the forces of a place."""
        dofs, force = len(self._space), memory.force[place]
        motion.add_forces(force[:, :, :dofs], force[:, :, dofs : 2 * dofs])
        if self._of_motion:
            motion.add_inputs(force[:, :, self._width :], self._inputs)

    def _add_to_rows(
        self, memory: StepMemory, place: int, motion: FreeMotion, *, isotropic: bool, converged: bool
    ) -> None:
        """Add to the rows of a place how they change with parameters of inertia."""
        own = slice(int(memory.row_count[place]))
        refuse_rows(self._space, self._inputs, memory.row_kind[place, own], memory.jacobian[place, own])
        if converged:
            contacts = self._copies.engine.contact_arrays.contacts.numpy

            def mass_changes(response: np.ndarray) -> np.ndarray:
                return motion.mass_input_derivatives(response, self._inputs)

            add_softness(memory, place, contacts, mass_changes, self._width)
            return
        if not isotropic:
            self._add_sliding(memory, place, motion)
        self._add_yielding(memory, place, motion)

    def _add_yielding(self, memory: StepMemory, place: int, motion: FreeMotion) -> None:
        """Add to rows that yield for their own inverse mass how that changes with parameters of inertia."""
        for row in np.flatnonzero(memory.row_yield[place, : int(memory.row_count[place])]).tolist():
            response = memory.inverse[place] @ memory.jacobian[place, row]
            driven = response @ motion.mass_input_derivatives(response, self._inputs)
            softens = memory.row_yield[place, row] * memory.row_impulse[place, row]
            memory.side[place, row, self._width :] += softens * driven

    def _add_sliding(self, memory: StepMemory, place: int, motion: FreeMotion) -> None:
        """Add to the rows of contacts that slide how their directions change with parameters of inertia.

        Two rows slide opposite to the changes of their impulses, for which both effective masses count.
        """
        kinds, status = memory.row_kind[place], memory.row_status[place]
        first = 0
        while first < int(memory.row_count[place]):
            slides = status[first] == ROW_SLIDES and kinds[first] in (CONTACT_FRICTION, ROLLING_FRICTION)
            if not slides:
                first += 1
                continue
            second = first + 1
            for row, other, sign in ((second, first, 1.0), (first, second, -1.0)):
                jacobian = memory.jacobian[place, row]
                response = memory.inverse[place] @ jacobian
                driven = response @ motion.mass_input_derivatives(response, self._inputs)
                along = sign * memory.row_impulse[place, other] * memory.row_asked[place, row]
                memory.side[place, second, self._width :] += along * driven * memory.row_mass[place, row] ** 2
            first += 2


def step_derivatives(
    world: WorldCore,
    space: TangentSpace,
    inputs: Sequence[Input],
    copies: Copies,
    smoothing: float,
    *,
    described: bool = True,
) -> StepDerivatives:
    """Perform a step of a copy of a world, and differentiate it; the copy is at its end afterwards.

    Arguments and errors are those of `StepLinearizer.step`.
    """
    kept = copies.linearizer
    if not isinstance(kept, StepLinearizer) or not kept.suits(space, inputs, copies):
        kept = copies.linearizer = StepLinearizer(space, inputs, copies, lone_mechanisms, 1)
    return kept.step(world.parameters, None, smoothing, described=described)


def _greatest_of_each(numbers: np.ndarray) -> np.ndarray:
    """The greatest of the numbers of each world (m, n), at least 0, (m,)."""
    if len(numbers) == 1:
        # Of few numbers this takes less time than arrays.
        return np.array([max(numbers[0].tolist(), default=0.0)])
    return numbers.max(axis=1, initial=0.0)


def _refuse_others(arrays: WorldArrays, *, of_inertia: bool) -> None:
    model = arrays.model.numpy
    if of_inertia and (model["fluid_density"].any() or model["fluid_viscosity"].any()):
        raise NotImplementedError(
            "masses, inertias and offsets have no exact derivatives where forces of a fluid act: "
            'use method="differences"'
        )
    if has_late_links(arrays):
        raise NotImplementedError(
            "bodies loaded with URDF_GLOBAL_VELOCITIES_MB have no exact derivatives: load them without it, "
            'or use method="differences"'
        )
