"""Central differences of steps, by state and inputs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.linearization.inputs import OFFSETS
from carom.linearization.offsets import shift_offset
from carom.linearization.stepping import Copies

if TYPE_CHECKING:
    from carom.linearization.given_state import GivenState
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace
    from carom.scene.core.world_core import WorldCore


def differences(
    world: WorldCore,
    space: TangentSpace,
    inputs: Sequence[Input],
    steps: int,
    size: float,
    start: GivenState,
) -> tuple[np.ndarray, np.ndarray]:
    """Central differences of the state after steps.

    Args:
        world: The world.
        space: Its tangent space.
        inputs: Controls and parameters.
        steps: Number of steps.
        size: Size of the changes; those of inputs are relative if the input is greater than 1.
        start: What replaces the present state.

    Returns:
        Derivatives by the state (nx, nx), and by the inputs (nx, inputs).
    """
    dofs, active = len(space), len(space.activations)
    width = 2 * dofs + active
    shifts = [column for column, given in enumerate(inputs) if given.kind == OFFSETS]
    if shifts:
        return _with_offsets(world, space, inputs, steps, size, start, shifts)
    total = width + len(inputs)
    if not total:
        return np.zeros((0, 0)), np.zeros((0, 0))
    copies = Copies(world, 2 * total)
    state = copies.state
    start.write(state)
    sizes = np.full(total, size)
    signed = np.concatenate([np.eye(total), -np.eye(total)]) * size
    state["position"][:] = space.moved(state["position"], signed[:, :dofs])
    state["dof_velocity"][:, space.dofs] += signed[:, dofs : 2 * dofs]
    if active:
        state["actuator_activation"][:, space.activations] += signed[:, 2 * dofs : width]
    for number, given in enumerate(inputs, width):
        table = state if given.table == "state" else copies.engine.table_of(given.table).numpy
        sizes[number] *= max(1.0, abs(float(table[given.field][(0, *given.place)]) / given.scale))
        change = sizes[number] * np.array([1.0, -1.0])
        copies.change(given, np.array([number, total + number]), change)
    change = np.zeros((total, width))
    state = _stepped(copies, steps)
    position, velocity = state["position"], state["dof_velocity"][:, space.dofs]
    change[:, :dofs] = space.difference(position[:total], position[total:])
    change[:, dofs : 2 * dofs] = velocity[:total] - velocity[total:]
    if active:
        activation = state["actuator_activation"][:, space.activations]
        change[:, 2 * dofs :] = activation[:total] - activation[total:]
    found = (change / (2.0 * sizes[:, None])).T
    return found[:, :width], found[:, width:]


def _stepped(copies: Copies, steps: int) -> dict[str, np.ndarray]:
    """The fields of the states after steps, in which the present forces act."""
    copies.keep_forces()
    for _ in range(steps):
        copies.step()
    # Arrays are replaced where they were too short.
    return copies.engine.arrays.state.numpy


def _with_offsets(
    world: WorldCore,
    space: TangentSpace,
    inputs: Sequence[Input],
    steps: int,
    size: float,
    start: GivenState,
    shifts: Sequence[int],
) -> tuple[np.ndarray, np.ndarray]:
    """As `differences`, with offsets in some columns, which all copies of an engine share."""
    others = [column for column in range(len(inputs)) if column not in set(shifts)]
    by_state, by_others = differences(world, space, [inputs[it] for it in others], steps, size, start)
    found = np.zeros((len(by_state), len(inputs)))
    found[:, others] = by_others
    dofs = len(space)
    for column in shifts:
        given = inputs[column]
        body = next(it for it in space.bodies if 0 < given.row - it.first_link <= it.joint_count)
        ends: list[tuple[np.ndarray, ...]] = []
        for change in (size, -size):
            copies = Copies(world, 1)
            start.write(copies.state)
            shift_offset(copies.engine.arrays.model, body, given, change)
            state = _stepped(copies, steps)
            activation = state["actuator_activation"][:, space.activations]
            ends.append((state["position"], state["dof_velocity"][:, space.dofs], activation))
        first, second = ends
        found[:dofs, column] = space.difference(first[0], second[0])[0]
        found[dofs : 2 * dofs, column] = (first[1] - second[1])[0]
        found[2 * dofs :, column] = (first[2] - second[2])[0]
        found[:, column] /= 2.0 * size
    return by_state, found
