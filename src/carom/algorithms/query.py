"""Coordinates to ask questions about, beside those the world is in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.model.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.model.launch import Launch

if TYPE_CHECKING:
    from carom.body import Body

IDENTITY_BASE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class Query:
    """One body's coordinates and motion in the world's spare state.

    Everything starts as zero, the base at the origin. Arrays are views that hold until the next
    body is added or removed.

    Attributes:
        joint_position: Coordinates of all joints, in order.
        joint_velocity: Their rates.
        joint_acceleration: Their second derivatives.
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        self.space = body.world.query_space()
        state, scratch = self.space.state, self.space.scratch
        first, count = body.first_position, sum(body.position_count)
        self._base_position = state["position"][0, first : first + BASE_POSITIONS]
        self.joint_position = state["position"][0, first + BASE_POSITIONS : first + BASE_POSITIONS + count]
        dofs = slice(body.first_velocity, body.first_velocity + BASE_VELOCITIES + sum(body.velocity_count))
        self._velocity = state["dof_velocity"][0, dofs]
        self._acceleration = scratch["dof_acceleration"][0, dofs]
        self._force = scratch["dof_force"][0, dofs]
        self.joint_velocity = self._velocity[BASE_VELOCITIES:]
        self.joint_acceleration = self._acceleration[BASE_VELOCITIES:]
        self._velocity[:] = 0.0
        self._acceleration[:] = 0.0
        self._base_position[:] = IDENTITY_BASE

    def place_base(self, pose: Sequence[float] | np.ndarray) -> None:
        """Place the inertial frame of the base: position and quaternion."""
        self._base_position[:] = pose

    def move_base(
        self,
        angular: np.ndarray,
        linear: np.ndarray,
        angular_acceleration: np.ndarray,
        acceleration: np.ndarray,
    ) -> None:
        """Velocities and accelerations of a free base's centre of mass, world axes."""
        self._velocity[:3] = angular
        self._velocity[3:6] = linear
        self._acceleration[:3] = angular_acceleration
        self._acceleration[3:6] = acceleration

    @property
    def generalized_force(self) -> np.ndarray:
        """What `inverse_dynamics_kernel` found: base moment, base force, joint forces."""
        return -self._force

    def run(self, launch: Launch, tree_argument: int) -> None:
        """Run a kernel on this body."""
        launch.replace(tree_argument, self.body.rows.tree)
        launch()


class QuerySpace:
    """Spare coordinates for all bodies of a world, and the kernels that work on them."""

    def __init__(
        self, settings: Any, structs: tuple[Any, Any, Any], arrays: dict[str, dict], device: str
    ) -> None:
        model, state, scratch = structs
        self.state = arrays["state"]
        self.scratch = arrays["scratch"]
        self.model = arrays["model"]
        self._arguments = (settings, model, state, scratch)
        self._device = device
        self._launches: dict[Any, Launch] = {}

    def launch(self, kernel: Any, *, with_settings: bool = False) -> tuple[Launch, int]:
        """A kernel over these coordinates, and which of its arguments is the tree."""
        arguments = self._arguments if with_settings else self._arguments[1:]
        if kernel not in self._launches:
            self._launches[kernel] = Launch(kernel, 1, [*arguments, 0], self._device)
        return self._launches[kernel], len(arguments)
