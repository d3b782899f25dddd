"""Coordinates to ask questions about, beside those the world is in."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.model.arrays import ArrayTable
from carom.model.builder import WorldArrays
from carom.model.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.model.launch import launch
from carom.model.real import NUMPY_REAL
from carom.model.structs import Query, State

if TYPE_CHECKING:
    from carom.body import Body

IDENTITY_BASE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
_TYPE_CODE = np.dtype(NUMPY_REAL).char
_ORIGIN = array(_TYPE_CODE, IDENTITY_BASE)


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
        self._runs: dict[tuple[Any, int, int], Callable[[], None]] = {}
        self._coordinates: dict[int, BodyCoordinates] = {}

    def coordinates(self, body: Body) -> BodyCoordinates:
        """Spare coordinates of a body; whatever the last question left is still in them."""
        coordinates = self._coordinates.get(body.id)
        if coordinates is None:
            coordinates = self._coordinates[body.id] = BodyCoordinates(self, body)
        return coordinates

    def forget_bodies(self) -> None:
        """Bodies have moved in the arrays."""
        self._coordinates.clear()
        self._runs.clear()

    def run(self, kernel: Any, tree: int, link: int = 0) -> None:
        """Run a kernel on the spare coordinates of one tree; `link` is for those that ask for one."""
        run = self._runs.get((kernel, tree, link))
        if run is None:
            prepared = launch(kernel, self._structs, self._device, tree=tree, link=link)
            run = self._runs[kernel, tree, link] = prepared.function
        run()


class BodyCoordinates:
    """Memory of one body's spare coordinates and of what kernels find for it.

    Attributes:
        base_position: Position (3) and quaternion (4) of the base's inertial frame.
        joint_position: Coordinates of all joints, in order.
        velocity: Angular (3) and linear (3) velocity of the base, then the joint rates.
        acceleration: Their derivatives.
        force: Minus the generalized forces of `inverse_dynamics_kernel`, in that order.
        dofs: Rows of the dofs that dynamics may change.
    """

    def __init__(self, space: QuerySpace, body: Body) -> None:
        first = body.first_position
        positions = memoryview(space.state["position"][0])
        joints = first + BASE_POSITIONS
        self.base_position = positions[first:joints]
        self.joint_position = positions[joints : joints + sum(body.position_count)]
        dofs = slice(body.first_velocity, body.first_velocity + BASE_VELOCITIES + sum(body.velocity_count))
        self.velocity = memoryview(space.state["dof_velocity"][0])[dofs]
        self.acceleration = memoryview(space.scratch["dof_acceleration"][0])[dofs]
        self.force = space.scratch["dof_force"][0, dofs]
        model, tree = space.model, body.rows.tree
        first_dof = int(model["tree_first_dof"][tree])
        self.dofs = slice(first_dof, first_dof + int(model["tree_dof_count"][tree]))

    def take_joints_of_resting_base(self, positions: Sequence[float] | np.ndarray) -> None:
        """Set the joint positions, the base at the origin."""
        self.base_position[:] = _ORIGIN
        self.joint_position[:] = reals(positions)


def reals(values: Sequence[float] | np.ndarray) -> array[float]:
    """Numbers as the memory of coordinates takes them."""
    return array(_TYPE_CODE, values)
