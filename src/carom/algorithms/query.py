"""Coordinates to ask questions about, beside those the world is in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.model.arrays import ArrayTable
from carom.model.builder import WorldArrays
from carom.model.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.model.launch import Launch
from carom.model.structs import Query, State

if TYPE_CHECKING:
    from carom.body import Body

IDENTITY_BASE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class QuerySpace:
    """Spare coordinates for all bodies of a world, and the kernels that work on them.

    Args:
        settings: Engine settings, for gravity.
        structs: Model, state and scratch of the world.
        arrays: The memory behind them.
        device: Warp device name.
    """

    def __init__(
        self, settings: Any, structs: tuple[Any, Any, Any], arrays: WorldArrays, device: str
    ) -> None:
        model, _, scratch = structs
        state, query = ArrayTable(State, 1), ArrayTable(Query, 1)
        for table in (state, query):
            table.reserve(arrays.state.capacity)
        self.model = arrays.model.numpy
        self.scratch = arrays.scratch.numpy
        self.state = state.numpy
        self.answer = query.numpy
        self._structs = {
            "settings": settings,
            "model": model,
            "state": state.struct(device),
            "scratch": scratch,
            "query": query.struct(device),
        }
        self._device = device
        self._launches: dict[Any, tuple[Launch, dict[str, int]]] = {}
        self._coordinates: dict[int, BodyCoordinates] = {}

    def coordinates(self, body: Body) -> BodyCoordinates:
        """Spare coordinates of a body, at the origin and at rest."""
        coordinates = self._coordinates.get(body.id)
        if coordinates is None:
            coordinates = self._coordinates[body.id] = BodyCoordinates(self, body)
        coordinates.clear()
        return coordinates

    def forget_bodies(self) -> None:
        """Bodies have moved in the arrays."""
        self._coordinates.clear()

    def run(self, kernel: Any, **integers: int) -> None:
        """Run a kernel on the spare coordinates with the given integer arguments."""
        if kernel not in self._launches:
            names = [argument.label for argument in kernel.adj.args]
            arguments = [self._structs.get(name, 0) for name in names]
            self._launches[kernel] = (
                Launch(kernel, 1, arguments, self._device),
                {name: index for index, name in enumerate(names) if name not in self._structs},
            )
        launch, index = self._launches[kernel]
        for name, value in integers.items():
            launch.replace(index[name], value)
        launch()


class BodyCoordinates:
    """Views of one body's spare coordinates and of what kernels find for it.

    Attributes:
        base_position: Position (3) and quaternion (4) of the base's inertial frame.
        joint_position: Coordinates of all joints, in order.
        velocity: Angular (3) and linear (3) velocity of the base, then the joint rates.
        acceleration: Their derivatives.
        force: Minus the generalized forces of `inverse_dynamics_kernel`, in that order.
    """

    def __init__(self, space: QuerySpace, body: Body) -> None:
        first = body.first_position
        positions = space.state["position"][0]
        joints = first + BASE_POSITIONS
        self.base_position = positions[first:joints]
        self.joint_position = positions[joints : joints + sum(body.position_count)]
        dofs = slice(body.first_velocity, body.first_velocity + BASE_VELOCITIES + sum(body.velocity_count))
        self.velocity = space.state["dof_velocity"][0, dofs]
        self.acceleration = space.scratch["dof_acceleration"][0, dofs]
        self.force = space.scratch["dof_force"][0, dofs]

    def clear(self) -> None:
        """Put the body to rest at the origin; joint positions are left for the caller to set."""
        self.base_position[:] = IDENTITY_BASE
        self.velocity.fill(0.0)
        self.acceleration.fill(0.0)


def active_dofs(body: Body, model: dict[str, np.ndarray]) -> slice:
    """Rows of the dofs that dynamics may change."""
    tree = body.rows.tree
    first = int(model["tree_first_dof"][tree])
    return slice(first, first + int(model["tree_dof_count"][tree]))
