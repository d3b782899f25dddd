"""The derivatives of one step, by the implicit function theorem over the rows that hold at its end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import FILTER, FILTER_EXACT, INTEGRATOR, MUSCLE
from carom.layouts.contacts import THERE
from carom.linearization.contact_rows import ContactRows
from carom.linearization.free_motion import FreeMotion
from carom.linearization.joint_rows import JointRows, bounded_control
from carom.linearization.motion_questions import ask_lone, questions_of_step
from carom.linearization.pair_rows import Places
from carom.linearization.row_solver import RowSolver, row_solver
from carom.linearization.rows import Rows
from carom.linearization.stepping import Copies
from carom.linearization.taken_step import StateBefore, TakenStep
from carom.linearization.user_rows import UserRows

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace
    from carom.world.world import World

# At most so many rows has a contact or a user constraint, and a constraint of a joint.
_MOST_ROWS, _BALL_ROWS = 6, 3


@dataclass(frozen=True, eq=False, slots=True)
class StepFactors:
    """A step that has been performed, and the factors of its derivatives.

    Columns are changes of positions, of velocities, of activations (nx in all), then of inputs. The
    velocities after the step are v + h M⁻¹ forces + M⁻¹ Jᵀ λ.

    Attributes:
        rows: Names and status of all rows.
        states: Number of states, nx.
        response: h M⁻¹, (n, n).
        forces: Derivatives of forces at constant impulses, (n, columns).
        free_forces: The same without impulses; the same array if there are no rows.
        solver: What finds the impulses of the rows; None without rows.
        moving: 1 where a velocity is below the greatest one, else 0, (n,).
        turned, moved: Derivatives of positions after the step by those before it and by the velocities
            after it, (n, n).
        acted, driven: Those of activations by themselves, (a,), and by inputs, (a, inputs).
    """

    rows: tuple[tuple[str, str], ...]
    states: int
    response: np.ndarray
    forces: np.ndarray
    free_forces: np.ndarray
    solver: RowSolver | None
    moving: np.ndarray
    turned: np.ndarray
    moved: np.ndarray
    acted: np.ndarray
    driven: np.ndarray

    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the state after the step by that before it (nx, nx), and by inputs (nx, inputs)."""
        dofs, width = len(self.moving), self.states
        velocities = self.response @ self.forces
        _add_identity(velocities, dofs)
        if self.solver is not None:
            free = velocities
            if self.free_forces is not self.forces:
                free = self.response @ self.free_forces
                _add_identity(free, dofs)
            velocities = velocities + self.solver.changes(free, velocities)
        velocities *= self.moving[:, None]
        found = np.zeros((width, velocities.shape[1]))
        found[:dofs] = self.moved @ velocities
        found[:dofs, :dofs] += self.turned
        found[dofs : 2 * dofs] = velocities
        if len(self.acted):
            found[2 * dofs :, 2 * dofs : width] = np.diag(self.acted)
            found[2 * dofs :, width:] = self.driven
        return found[:, :width], found[:, width:]

    def pulled_back(self, cotangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A cotangent (nx,) times `matrices`, (nx,) and (inputs,), without making these."""
        dofs, width = len(self.moving), self.states
        given = self.moving * (cotangent[dofs : 2 * dofs] + cotangent[:dofs] @ self.moved)
        found = np.zeros(self.forces.shape[1])
        if self.solver is not None:
            of_free, given, found = self.solver.pulled_back(given)
            found = found + (of_free @ self.response) @ self.free_forces
            found[dofs : 2 * dofs] += of_free
        found = found + (given @ self.response) @ self.forces
        found[dofs : 2 * dofs] += given
        found[:dofs] += cotangent[:dofs] @ self.turned
        if len(self.acted):
            found[2 * dofs : width] += cotangent[2 * dofs :] * self.acted
            found[width:] += cotangent[2 * dofs :] @ self.driven
        return found[:width], found[width:]


def _add_identity(velocities: np.ndarray, dofs: int) -> None:
    """Add 1 to the derivatives of velocities by themselves."""
    velocities[np.arange(dofs), np.arange(dofs, 2 * dofs)] += 1.0


def step_factors(
    space: TangentSpace, inputs: Sequence[Input], taken: TakenStep, motion: FreeMotion, smoothing: float
) -> StepFactors:
    """Differentiate a step that has been performed.

    Args:
        space: The tangent space of the world.
        inputs: Controls and parameters.
        taken: The step.
        motion: Its free motion.
        smoothing: Softness of all rows, relative to their own.

    Raises:
        NotImplementedError: Something in the step has no exact derivatives.
    """
    contacts, users = int(taken.contacts["count_contacts"][THERE]), taken.user_count
    constraints = taken.constraint_count
    rows = Rows(space, inputs, _MOST_ROWS * (contacts + users) + _BALL_ROWS * constraints)
    if contacts or users:
        places = Places(space, motion)
        UserRows(space, taken, places, rows).add_all(users)
        ContactRows(space, taken, places, motion, rows).add_all()
    total = motion.effective @ (taken.solved - taken.free_velocity) - rows.generalized_impulses()
    JointRows(space, taken, rows, total).add_all(constraints)
    dofs, active = len(space), len(space.activations)
    free_forces = forces = motion.force_derivatives(0, active, inputs)
    solver = None
    if len(rows):
        forces = motion.force_derivatives(1, active, inputs)
        of_after = np.zeros((len(rows), dofs))
        for row, hessian in rows.hessians.items():
            forces[:, :dofs] += rows.impulses[row] / taken.time_step * hessian
            of_after[row] = taken.solved @ hessian
        solver = row_solver(rows, motion.inverse, of_after, smoothing)
    bound = taken.model["tree_max_velocity"][space.trees]
    return StepFactors(
        tuple(rows.names),
        2 * dofs + active,
        taken.time_step * motion.inverse,
        forces,
        free_forces,
        solver,
        (np.abs(taken.solved) < bound).astype(float),
        *space.integration(taken.after, taken.time_step),
        *_activations(space, taken, inputs),
    )


def step_derivatives(
    world: World, space: TangentSpace, inputs: Sequence[Input], copies: Copies, smoothing: float
) -> StepFactors:
    """Perform a step of a copy of a world, and differentiate it; the copy is at its end afterwards.

    Arguments and errors are those of `step_factors`.
    """
    copies.apply_forces()
    before = StateBefore(space, copies)
    copies.step()
    taken = TakenStep(world.parameters, space, copies, before)
    answers = [ask_lone(*it) for it in zip(space.bodies, questions_of_step(space, taken), strict=True)]
    return step_factors(space, inputs, taken, FreeMotion(space, taken, answers, ask_lone), smoothing)


def _activations(
    space: TangentSpace, taken: TakenStep, inputs: Sequence[Input]
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of activations after the step by themselves (a,), and by inputs (a, inputs)."""
    model, h = taken.model, taken.time_step
    kept, driven = np.zeros(len(space.activations)), np.zeros((len(space.activations), len(inputs)))
    for column, actuator in enumerate(space.activations.tolist()):
        dynamics, constant = model["actuator_dynamics"][actuator], model["actuator_time_constant"][actuator]
        if dynamics == MUSCLE:
            raise NotImplementedError(
                f"{space.actuators[column]} is a muscle, which has no exact derivatives"
            )
        after = taken.state["actuator_activation"][actuator]
        lower, upper = (model[f"actuator_activation_{side}"][actuator] for side in ("lower", "upper"))
        if not lower < after < upper:
            continue
        share = {INTEGRATOR: 0.0, FILTER: h / constant, FILTER_EXACT: -np.expm1(-h / constant)}[int(dynamics)]
        kept[column] = 1.0 - share
        for number, given in enumerate(inputs):
            of_control = given.kind == "actuators" and given.row == actuator
            if of_control and bounded_control(taken, actuator)[1]:
                driven[column, number] = h if dynamics == INTEGRATOR else share
    return kept, driven
