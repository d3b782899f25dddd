"""The derivatives of one step, by the implicit function theorem over the rows that hold at its end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import FILTER, FILTER_EXACT, INTEGRATOR, MUSCLE
from carom.linearization.free_motion import FreeMotion
from carom.linearization.rows import JointRows, Rows, bounded_control
from carom.linearization.stepping import Copies
from carom.linearization.taken_step import TakenStep

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace
    from carom.world.world import World

# Singular values of the rows' equations below this share of the greatest one are those of redundant rows.
_REDUNDANT = 1e-10


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
    total = motion.effective @ (taken.after - taken.free_velocity)
    JointRows(space, taken, rows, total).add_all(world.arrays.used["constraint"])
    after_q, after_v, after_u = free_q, free_v, free_u
    dofs, active = len(space), len(space.activations)
    after_a = np.zeros((dofs, active))
    if len(rows):
        after_q, after_v = motion.derivatives(taken.after)
        after_u = motion.input_derivatives(taken.after, inputs)
        jacobian = np.stack(rows.jacobian)
        response = motion.inverse @ jacobian.T
        alpha = np.array(rows.alpha)[:, None]
        beta = np.diag(np.concatenate(rows.beta))
        through = np.stack(rows.by_free_velocity)
        delassus = jacobian @ response
        system = alpha * delassus + beta
        if smoothing:
            # Of a row at a bound λ = bound + s α (…): it keeps a share of what it did when it held.
            system += smoothing * np.diag(np.diag(delassus) * alpha[:, 0])
        sides = np.concatenate(
            [
                np.stack(rows.by_position) + through @ free_q - alpha * (jacobian @ after_q),
                through @ free_v - alpha * (jacobian @ after_v),
                np.stack(rows.by_activation),
                np.stack(rows.by_input) + through @ free_u - alpha * (jacobian @ after_u),
            ],
            axis=1,
        )
        scale = np.maximum(np.abs(system).max(axis=1, keepdims=True), 1e-300)
        change = response @ np.linalg.lstsq(system / scale, sides / scale, rcond=_REDUNDANT)[0]
        after_q, after_v = after_q + change[:, :dofs], after_v + change[:, dofs : 2 * dofs]
        after_a = change[:, 2 * dofs : 2 * dofs + active]
        after_u = after_u + change[:, 2 * dofs + active :]
    bound = np.concatenate(
        [
            np.full(size, taken.model["tree_max_velocity"][body.rows.tree])
            for body, (_, size) in zip(space.bodies, space.places, strict=True)
        ]
    )
    moving = np.where(np.abs(taken.after) < bound, 1.0, 0.0)[:, None]
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


def _activations(
    space: TangentSpace, taken: TakenStep, inputs: Sequence[Input]
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of activations after the step by themselves (a,), and by inputs (a, inputs)."""
    model, h = taken.model, taken.time_step
    kept, driven = np.zeros(len(space.activations)), np.zeros((len(space.activations), len(inputs)))
    for column, actuator in enumerate(space.activations.tolist()):
        dynamics, constant = model["actuator_dynamics"][actuator], model["actuator_time_constant"][actuator]
        if dynamics == MUSCLE:
            raise NotImplementedError(f"{space.actuators[column]} is a muscle, which has no exact derivatives")
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
