"""States of a world as points of a manifold, and its controls as a vector."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite
from carom.linearization.inputs import CONTROLS, chosen_inputs
from carom.linearization.tangent import TangentSpace

if TYPE_CHECKING:
    from carom.world.world import World

_SIZE = 1e-6


class WorldState(NamedTuple):
    """Positions, velocities and activations of a world, or those of m worlds with an axis before the others.

    Attributes:
        positions: As `World.position`.
        velocities: As `World.velocity`.
        activations: Of all actuators.
    """

    positions: Array
    velocities: Array
    activations: Array


class StateSpace:
    """The states of a world, with differences in the tangent space that `World.linearize` uses.

    Attributes:
        size: Number of entries nx of a difference of states.
    """

    def __init__(self, world: World) -> None:
        world.prepare()
        self._tangent = TangentSpace(world)
        used = world.arrays.used
        self._counts: dict[str, int] = {
            "position": used["position"],
            "dof_velocity": used["dof"],
            "actuator_activation": used.get("actuator", 0),
        }
        self.size: int = 2 * len(self._tangent) + len(self._tangent.activations)

    def state_of(self, world: World) -> WorldState:
        """The present state of the world, or of a copy of it."""
        state = self.states_in(world.arrays.state.numpy)
        return WorldState(*(array[0] for array in state))

    def states_in(self, fields: Mapping[str, np.ndarray]) -> WorldState:
        """A copy of the states (m, ...) in tables of m worlds."""
        # Arrays may have spare rows.
        return WorldState(*(fields[name][:, :count].copy() for name, count in self._counts.items()))

    def difference(self, state: WorldState, other: WorldState) -> Array:
        """The small changes (nx,) or (m, nx) that lead from the other state to the state.

        Args:
            state: A state, or states of m worlds.
            other: Likewise; a single one is that of all worlds.
        """
        space = self._tangent
        positions = np.atleast_2d(state.positions)
        others = np.broadcast_to(other.positions, positions.shape)
        change = np.concatenate(
            [
                space.difference(positions, others),
                np.atleast_2d((state.velocities - other.velocities)[..., space.dofs]),
                np.atleast_2d((state.activations - other.activations)[..., space.activations]),
            ],
            axis=1,
        )
        return change if state.positions.ndim == 2 else change[0]

    def difference_derivative(self, state: WorldState, other: WorldState) -> Array:
        """The derivative (nx, nx) of `difference` by small changes of the state, by central differences."""
        dofs = len(self._tangent)
        by_state = np.eye(self.size)
        changes = _SIZE * np.concatenate([np.eye(dofs), -np.eye(dofs)])
        moved = self._tangent.moved(np.repeat(state.positions[None], 2 * dofs, axis=0), changes)
        found = self._tangent.difference(moved, np.broadcast_to(other.positions, moved.shape))
        by_state[:dofs, :dofs] = ((found[:dofs] - found[dofs:]) / (2.0 * _SIZE)).T
        return by_state


class Controls:
    """Controls of a world by name, as `World.linearize` names them, read and written as one vector.

    Attributes:
        names: Full names of the nu controls.
    """

    def __init__(self, world: World, chosen: Sequence[str]) -> None:
        world.prepare()
        self._inputs = chosen_inputs(world, TangentSpace(world), CONTROLS, chosen, "control")
        self.names: tuple[str, ...] = tuple(it.name for it in self._inputs)
        if not self.names:
            raise ValueError("there are no such controls in this world")

    def read(self, world: World) -> Array:
        """The present controls (nu,)."""
        fields = world.arrays.state.numpy
        return np.array([float(fields[it.field][(0, *it.place)]) / it.scale for it in self._inputs])

    def write(self, fields: Mapping[str, np.ndarray], values: np.ndarray) -> None:
        """Write controls (nu,), or (m, nu) of m worlds, to tables of worlds."""
        for number, it in enumerate(self._inputs):
            fields[it.field][(slice(None), *it.place)] = it.scale * values[..., number]

    def apply(self, world: World, values: np.ndarray) -> None:
        """Write controls (nu,) to the world; torques act in its next step."""
        self.write(world.arrays.state.numpy, values)


def state_of(world: World) -> WorldState:
    """The present state of a world, as a goal for `ILQR`."""
    return StateSpace(world).state_of(world)


def cost_matrix(value: ArrayLike, size: int, name: str) -> Array:
    """A cost as a symmetric matrix (size, size); a number or a vector is its diagonal.

    Raises:
        ValueError: The shape does not fit, it is not symmetric, or it has a negative eigenvalue.
    """
    given = finite(value, name)
    matrix = given if given.ndim == 2 else np.diag(np.broadcast_to(given, (size,)))
    if matrix.shape != (size, size) or not np.allclose(matrix, matrix.T):
        raise ValueError(f"{name} must be a number, {size} numbers, or a symmetric matrix of {size} rows")
    if size and np.linalg.eigvalsh(matrix)[0] < -1e-9 * max(1.0, float(np.abs(matrix).max())):
        raise ValueError(f"{name} must not have negative eigenvalues")
    return matrix
