"""Steps after passes without slip, linearised: see `kernels.newton.noslip`.

Where passes have ended, friction solves a second problem. With v and λ of the first, in which it yields, and
δ by how much its impulses have changed, v⁺ and x = F v⁺ − k F v₀, what friction asks of velocities:

    M (v⁺ − v) = Fᵀ δ
    x = 0                                  friction that sticks
    λ + δ = −b μ y / |y|,  y = μ x         of a cone that slides, b its normal impulse in λ
    λ + δ = ± bound                        of rows of a pyramid, and of the dry friction of joints

Bounds follow from the first problem, whose derivatives are those of a step without passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import ConstraintKind
from carom.layouts.linearization import (
    CONTACT_FRICTION,
    CONTACT_ROW,
    FOUND,
    FRICTION_ROW,
    ROLLING_FRICTION,
    SHAPE_KINDS,
    SPINNING_FRICTION,
)
from carom.linearization.converged.friction_laws import Cone, DryFriction, Pyramid

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.converged.friction_laws import Law
    from carom.linearization.integrators.frame_motions import FrameMotions
    from carom.linearization.step_kernels import StepKernels
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.stepping import Copies
    from carom.linearization.tangent import TangentSpace

_FRICTION = CONTACT_FRICTION, ROLLING_FRICTION, SPINNING_FRICTION
# Least and greatest impedance, as in `kernels.dynamics.yielding`.
_LEAST, _GREATEST = 1e-4, 0.9999
# Equations are solved where no residual is greater, relative to the greatest right side.
_SOLVED = 1e-6
# Forces by an impulse of 1 N s that is not known, and shares of such impulses, below this are none.
_SAME = 1e-9
# Singular values below this share of the greatest are those of redundant friction.
_REDUNDANT = 1e-10


class NotSettledError(NotImplementedError):
    """Passes without slip have not ended at a solution."""

    def __init__(self, passes: int, reason: str) -> None:
        super().__init__(
            f"the {passes} passes of noslip_iterations have not ended at a solution ({reason}), so that the "
            "step has no exact derivatives: raise noslip_iterations, linearise with tight=True, or use "
            'method="differences"'
        )


@dataclass(frozen=True, eq=False, slots=True)
class FirstProblem:
    """What is known of the step without passes.

    Attributes:
        kinds, numbers: Of its rows, (r,).
        jacobian: J, (r, n).
        impulses: λ, (r,).
        impulse_changes: Derivatives of λ, (r, columns).
        velocity: v, (n,).
        change: Derivatives of v, (n, columns).
        force: Derivatives of forces of the motion at v, (n, columns).
    """

    kinds: np.ndarray
    numbers: np.ndarray
    jacobian: np.ndarray
    impulses: np.ndarray
    impulse_changes: np.ndarray
    velocity: np.ndarray
    change: np.ndarray
    force: np.ndarray


@dataclass(frozen=True, eq=False, slots=True)
class _Answer:
    """Rows of contacts with given impulses, see `kernels.newton.linear_noslip`; rows as in the first problem.

    Attributes:
        residuals: x, (r,).
        side: Derivatives of x at constant velocities after the step, with the opposite sign, (r, columns).
        coefficients: Of friction, (r,); of a normal 1 for a cone, 0 for a pyramid.
        softens: Of a normal, derivatives of the softness by positions, relative to it, (r, n).
        force: Derivatives of the forces of the given impulses, (n, columns).
    """

    residuals: np.ndarray
    side: np.ndarray
    coefficients: np.ndarray
    softens: np.ndarray
    force: np.ndarray


class SecondProblem:
    """Finds how velocities change after passes without slip, in one copy of a world.

    Args:
        space: The tangent space.
        copies: The copy, whose steps have these passes.
        kernels: Those for it.
        frames: Bases that move by their frames.
    """

    def __init__(
        self, space: TangentSpace, copies: Copies, kernels: StepKernels, frames: FrameMotions
    ) -> None:
        self._space, self._copies, self._kernels, self._frames = space, copies, kernels, frames

    def solve(
        self,
        first: FirstProblem,
        memory: StepMemory,
        yielding: tuple[StepKernels, StepMemory],
        parameters: EngineParameters,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Derivatives of velocities after a step that the copy has performed.

        Args:
            first: The first problem.
            memory: Memory of the kernels for the copy.
            yielding: Kernels and memory of the first problem.
            parameters: Parameters of the engine.

        Returns:
            The derivatives (n, columns), and of each row of the first problem its status now, and how far it
            is from where that changes; -1 for other rows than those of friction.

        Raises:
            NotImplementedError: Passes have not ended at a solution, or a contact has no exact derivatives.
        """
        h, passes = parameters.substep_time, parameters.noslip_iterations
        force = motion_force(self._kernels, memory)
        if self._frames.follow(parameters):
            self._frames.shift(memory, 0, self._copies.scratch(0)["position_start"], h)
        after = memory.velocity[0, 2].copy()
        effective, inverse = memory.effective[0], memory.inverse[0]
        contacts = np.flatnonzero(np.isin(first.kinds, (CONTACT_ROW, *_FRICTION)))
        nothing = np.zeros(len(first.kinds))
        old = _asked(*yielding, first, contacts, nothing)
        quiet = _asked(self._kernels, memory, first, contacts, nothing)
        residuals, kept = self._residuals(first, quiet, memory, h)
        laws = self._laws(first, old, quiet)
        impulses, unknown = self._impulses(
            first, laws, residuals, effective @ (after - first.velocity), passes
        )
        changes = impulses - first.impulses
        for row in unknown.T:
            # Forces do not depend on how impulses are shared among rows that are redundant, or are not known.
            pulled = _asked(self._kernels, memory, first, contacts, row).force - quiet.force
            if np.abs(pulled).max(initial=0.0) * h > _SAME:
                raise NotImplementedError(
                    "impulses of friction that is redundant are not known after noslip_iterations, so that "
                    'the step has no exact derivatives: use method="differences"'
                )
        now = _asked(self._kernels, memory, first, contacts, changes)
        moved = force - first.force + now.force - quiet.force
        change = first.change + h * inverse @ moved
        rows = np.array([row for law in laws for row in law.rows], dtype=np.int64)
        status, away = np.full(len(first.kinds), -1), np.full(len(first.kinds), -1.0)
        if not len(rows):
            return change, status, away
        jacobian = first.jacobian[rows]
        response = inverse @ jacobian.T
        side = now.side[rows]
        for place, row in enumerate(rows.tolist()):
            if row in kept:
                side[place] = 0.0
                side[place, len(self._space) + int(first.numbers[row])] = kept[row]
        mobility, free = jacobian @ response, jacobian @ change - side
        system, right = np.eye(len(rows)), np.empty_like(free)
        place = 0
        for law in laws:
            own = slice(place, place + len(law.rows))
            place = own.stop
            shared = np.abs(unknown[law.rows]).max(axis=1, initial=0.0) > _SAME
            told = np.where(shared, np.nan, impulses[law.rows])
            linear = law.linear(residuals[law.rows], first.impulse_changes[law.rows], told)
            if linear.reason:
                raise NotSettledError(passes, linear.reason)
            system[own] = linear.by_residual @ mobility[own]
            system[own, own] += linear.by_impulse
            right[own] = linear.right - linear.by_residual @ free[own]
            status[law.rows], away[law.rows] = linear.status, linear.distance
        found = np.linalg.lstsq(system, right, rcond=_REDUNDANT)[0]
        if np.abs(system @ found - right).max() > _SOLVED * max(np.abs(right).max(), 1e-300):
            raise NotImplementedError(
                "friction that sticks at more places than it takes contradicts itself where they move, so "
                'that a step with noslip_iterations has no exact derivatives: use method="differences"'
            )
        return change + response @ found, status, away

    def _residuals(
        self, first: FirstProblem, now: _Answer, memory: StepMemory, time_step: float
    ) -> tuple[np.ndarray, dict[int, float]]:
        """The residuals of all rows of friction (r,), and by rows of dry friction what it keeps."""
        residuals, kept = now.residuals.copy(), {}
        for row in np.flatnonzero(first.kinds == FRICTION_ROW).tolist():
            dof = int(first.numbers[row])
            kept[row] = self._kept(dof, time_step)
            residuals[row] = memory.velocity[0, 2, dof] - kept[row] * memory.velocity[0, 0, dof]
        return residuals, kept

    def _impulses(
        self, first: FirstProblem, laws: list[Law], residuals: np.ndarray, push: np.ndarray, passes: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Impulses of all rows after passes that have pushed the dofs by `push`.

        Those of lateral friction are known, and others where it slides; those of rolling and spinning
        friction that sticks, and of dry friction, follow.

        Returns:
            The impulses (r,), and combinations of them that are not known, (r, combinations).
        """
        known = self._copies.engine.contact_arrays.contacts.numpy["contact_impulse"][0]
        impulses, left = first.impulses.copy(), list[int]()
        for law in laws:
            by_law = law.impulses(residuals[law.rows])
            for row, impulse in zip(law.rows.tolist(), by_law.tolist(), strict=True):
                if first.kinds[row] == CONTACT_FRICTION:
                    # The row of a normal comes before two of lateral friction.
                    side = 1 if first.kinds[row - 1] == CONTACT_ROW else 2
                    impulses[row] = known[int(first.numbers[row]) // SHAPE_KINDS**2, side]
                elif np.isnan(impulse):
                    left.append(row)
                else:
                    impulses[row] = impulse
        rest = push - first.jacobian.T @ (impulses - first.impulses)
        unknown = np.zeros((len(impulses), 0))
        if left:
            arms = first.jacobian[left].T
            across, values, own = np.linalg.svd(arms)
            rank = int((values > _REDUNDANT * values[0]).sum()) if values[0] > 0.0 else 0
            changes = own[:rank].T @ ((across[:, :rank].T @ rest) / values[:rank])
            impulses[left] += changes
            rest = rest - arms @ changes
            unknown = np.zeros((len(impulses), len(left) - rank))
            unknown[left] = own[rank:].T
        size = (np.abs(first.jacobian).T @ np.abs(impulses)).max(initial=1e-300)
        if np.abs(rest).max(initial=0.0) > _SOLVED * size:
            raise NotSettledError(passes, "impulses do not tell what has changed velocities")
        return impulses, unknown

    def _laws(self, first: FirstProblem, old: _Answer, now: _Answer) -> list[Law]:
        """The laws of all friction that passes go through."""
        laws: list[Law] = []
        kinds, count = first.kinds.tolist(), len(first.kinds)
        normals = [row for row in range(count) if kinds[row] == CONTACT_ROW]
        for normal in normals:
            last = normal + 1
            while last < count and kinds[last] in _FRICTION:
                last += 1
            rows = np.arange(normal + 1, last)
            if not len(rows):
                continue
            if np.isnan(now.residuals[normal]):
                raise NotImplementedError(
                    "contacts that do not yield have no exact derivatives beside noslip_iterations: "
                    'use method="differences"'
                )
            coefficients = now.coefficients[rows]
            push, pushes = first.impulses[normal], first.impulse_changes[normal]
            if now.coefficients[normal]:
                laws.append(Cone(rows, coefficients, push, pushes))
                continue
            own = np.arange(normal, last)
            residual_changes = first.jacobian[own] @ first.change - old.side[own]
            softens = np.zeros(first.change.shape[1])
            softens[: len(self._space)] = old.softens[normal]
            laws += Pyramid.rows_of(
                rows, coefficients, old.residuals[own], residual_changes, first.impulses[own],
                first.impulse_changes[own], softens,
            )  # fmt: skip
        laws += [DryFriction(np.array([row])) for row in range(count) if kinds[row] == FRICTION_ROW]
        return laws

    def _kept(self, dof: int, time_step: float) -> float:
        """Which share of its velocity before the step dry friction keeps, see `dynamics.yielding`."""
        model = self._copies.engine.arrays.model.numpy
        used = self._copies.engine.arrays.used["constraint"]
        links = model["constraint_link"][:used]
        row = int(self._space.dofs[dof])
        firsts = model["link_first_dof"][links]
        own = (model["constraint_kind"][:used] == ConstraintKind.FRICTION) & (firsts <= row)
        constraint = int(np.flatnonzero(own & (row < firsts + model["link_dof_count"][links]))[0])
        impedance = model["constraint_impedance"][0, constraint]
        if impedance[1] <= 0.0:
            return 0.0
        reference = model["constraint_reference"][0, constraint]
        last = min(max(float(impedance[1]), _LEAST), _GREATEST)
        if reference[0] > 0.0:
            return 1.0 - 2.0 * time_step / (last * max(float(reference[0]), 2.0 * time_step))
        return 1.0 + time_step * float(reference[1]) / last


def motion_force(kernels: StepKernels, memory: StepMemory) -> np.ndarray:
    """Derivatives of forces of the motion at velocities after a step, (n, columns)."""
    memory.problem.fill(FOUND)
    memory.row_count.fill(0)
    memory.force.fill(0.0)
    kernels.find_motion(1)
    return memory.force[0, 1].copy()


def _asked(
    kernels: StepKernels, memory: StepMemory, first: FirstProblem, contacts: np.ndarray, impulses: np.ndarray
) -> _Answer:
    """Rows of contacts with given impulses (r,); other rows mean nothing."""
    count = len(impulses)
    memory.row_count.fill(0)
    memory.row_asked[0, :count] = impulses
    memory.row_mass[0, :count] = np.nan
    before = memory.force[0, 1].copy()
    kernels.add_given_rows(1)
    same = memory.row_kind[0, contacts] == first.kinds[contacts]
    if not (same & (memory.row_dof[0, contacts] == first.numbers[contacts])).all():
        raise NotImplementedError(
            "contacts of a step change by noslip_iterations, so that it has no exact derivatives: "
            'use method="differences"'
        )
    return _Answer(
        residuals=memory.row_mass[0, :count].copy(),
        side=memory.side[0, :count].copy(),
        coefficients=memory.row_yield[0, :count].copy(),
        softens=memory.through[0, :count].copy(),
        force=memory.force[0, 1] - before,
    )
