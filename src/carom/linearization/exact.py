"""The derivatives of one step, by the implicit function theorem over the rows that hold at its end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import FILTER, FILTER_EXACT, INTEGRATOR, MUSCLE
from carom.linearization.contact_rows import ContactRows
from carom.linearization.free_motion import FreeMotion
from carom.linearization.pair_rows import Places
from carom.linearization.rows import JointRows, Rows, bounded_control
from carom.linearization.stepping import Copies
from carom.linearization.taken_step import TakenStep
from carom.linearization.user_rows import UserRows

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace
    from carom.world.world import World

# Singular values of the rows' equations below this share of the greatest one are those of redundant rows: no
# number of sweeps resolves them.
_REDUNDANT = 1e-7


def step_derivatives(
    world: World, space: TangentSpace, inputs: Sequence[Input], copies: Copies, smoothing: float
) -> tuple[np.ndarray, np.ndarray, tuple[tuple[str, str], ...]]:
    """Perform a step of a copy of a world, and differentiate it.

    Args:
        world: The world.
        space: Its tangent space.
        inputs: Controls and parameters.
        copies: One copy of the world; it is at the end of the step afterwards.
        smoothing: Softness of all rows, relative to their own.

    Returns:
        Derivatives by the state (nx, nx) and by the inputs (nx, inputs); names and status of all rows.

    Raises:
        NotImplementedError: Something in the step has no exact derivatives.
    """
    taken = TakenStep(world, space, copies)
    motion = FreeMotion(space, taken)
    free_q, free_v = motion.derivatives(taken.free_velocity)
    free_u = motion.input_derivatives(taken.free_velocity, inputs)
    rows = Rows(space, inputs)
    places = Places(space, motion)
    UserRows(space, taken, places, rows).add_all(taken.user_count)
    ContactRows(space, taken, places, motion, rows).add_all()
    total = motion.effective @ (taken.solved - taken.free_velocity) - rows.generalized_impulses()
    JointRows(space, taken, rows, total).add_all(world.arrays.used["constraint"])
    after_q, after_v, after_u = free_q, free_v, free_u
    dofs, active = len(space), len(space.activations)
    after_a = np.zeros((dofs, active))
    if len(rows):
        after_q, after_v = motion.derivatives(taken.solved)
        after_u = motion.input_derivatives(taken.solved, inputs)
        jacobian = np.stack(rows.jacobian)
        through = np.stack(rows.by_free_velocity)
        of_after = np.zeros((len(rows), dofs))
        pushed = np.zeros((dofs, dofs))
        for row, hessian in rows.hessians.items():
            pushed += rows.impulses[row] * hessian
            of_after[row] = taken.solved @ hessian
        after_q = after_q + motion.inverse @ pushed
        change = _changes_of_rows(
            rows,
            motion.inverse @ jacobian.T,
            [
                (np.stack(rows.by_position) + through @ free_q, jacobian @ after_q + of_after),
                (through @ free_v, jacobian @ after_v),
                (np.stack(rows.by_activation), np.zeros((len(rows), active))),
                (np.stack(rows.by_input) + through @ free_u, jacobian @ after_u),
            ],
            smoothing,
        )
        after_q, after_v = after_q + change[:, :dofs], after_v + change[:, dofs : 2 * dofs]
        after_a = change[:, 2 * dofs : 2 * dofs + active]
        after_u = after_u + change[:, 2 * dofs + active :]
    bound = np.concatenate(
        [
            np.full(size, taken.model["tree_max_velocity"][body.rows.tree])
            for body, (_, size) in zip(space.bodies, space.places, strict=True)
        ]
    )
    moving = np.where(np.abs(taken.solved) < bound, 1.0, 0.0)[:, None]
    after_q, after_v, after_a, after_u = (moving * it for it in (after_q, after_v, after_a, after_u))
    turned, moved = space.integration(taken.after, taken.time_step)
    acted, driven = _activations(space, taken, inputs)
    width = 2 * dofs + active
    by_state, by_input = np.zeros((width, width)), np.zeros((width, len(inputs)))
    velocities = np.concatenate([after_q, after_v, after_a], axis=1)
    by_state[dofs : 2 * dofs] = velocities
    by_state[:dofs] = moved @ velocities
    by_state[:dofs, :dofs] += turned
    by_state[2 * dofs :, 2 * dofs :] = np.diag(acted)
    by_input[dofs : 2 * dofs], by_input[:dofs], by_input[2 * dofs :] = after_u, moved @ after_u, driven
    return by_state, by_input, tuple(rows.names)


def _changes_of_rows(
    rows: Rows, response: np.ndarray, sides: list[tuple[np.ndarray, np.ndarray]], smoothing: float
) -> np.ndarray:
    """Changes of velocities (n, columns) by the changes of all impulses.

    Args:
        rows: The rows.
        response: M⁻¹ Jᵀ, (n, rows).
        sides: Right sides of the rows, and changes of their rates at constant impulses, for some columns.
        smoothing: As in `step_derivatives`.
    """
    alpha, beta = rows.matrix(rows.alpha), rows.matrix(rows.beta)
    delassus = np.stack(rows.jacobian) @ response
    if smoothing:
        beta = beta + smoothing * alpha * np.diag(delassus)
    system = alpha @ delassus + beta
    wanted = np.concatenate([side - alpha @ rate for side, rate in sides], axis=1)
    scale = np.maximum(np.abs(system).max(axis=1, keepdims=True), 1e-300)
    return response @ _solution(system / scale, wanted / scale)


def _solution(system: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """The solution of equations; the least one where some are redundant."""
    try:
        inverse = np.linalg.inv(system)
    except np.linalg.LinAlgError:
        inverse = None
    # Of equations far from that the singular values need not be known.
    if inverse is not None and np.abs(system).sum() * np.abs(inverse).sum() < 1.0 / _REDUNDANT:
        return inverse @ wanted
    return np.linalg.lstsq(system, wanted, rcond=_REDUNDANT)[0]


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
