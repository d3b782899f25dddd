"""Control of joints by inverse dynamics: gravity compensation and computed torque."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.algorithms import gravity_forces, inverse_dynamics
from carom.checks import Array, not_negative, vector
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.linearization.tangent import TangentSpace

if TYPE_CHECKING:
    from carom.scene.body import Body


class JointState:
    """Positions and velocities of the joints of a body with a fixed base.

    Attributes:
        body: The body.
        dofs: Number n of velocity coordinates.
        coordinates: Number of position coordinates: those of a spherical joint are a quaternion.
        plain: Differences of positions are those of their numbers: no joint has several dofs.
    """

    def __init__(self, body: Body) -> None:
        if not body.fixed_base:
            raise ValueError(f"the base of {body.name!r} is free: this control needs a fixed one")
        self.body: Body = body
        self.dofs: int = sum(body.velocity_count)
        self.coordinates: int = sum(body.position_count)
        self._tangent = TangentSpace(body.world, [body])
        self.plain: bool = not len(self._tangent.several)

    def read(self) -> tuple[Array, Array]:
        """Copies of the present positions (coordinates,) and velocities (n,)."""
        first = self.body.first_position + BASE_POSITIONS
        first_rate = self.body.first_velocity + BASE_VELOCITIES
        positions = self.body.world.position[first : first + self.coordinates]
        return positions.copy(), self.body.world.velocity[first_rate : first_rate + self.dofs].copy()

    def difference(self, positions: np.ndarray, others: np.ndarray) -> Array:
        """The changes (n,) that lead from other positions to positions."""
        if self.plain:
            return positions - others
        own = slice(self.body.first_position + BASE_POSITIONS, None)
        both = np.repeat(self.body.world.position[None], 2, axis=0)
        for row, given in zip(both, (positions, others), strict=True):
            row[own][: self.coordinates] = given
        return self._tangent.difference(both[:1], both[1:])[0]


def gravity_compensation(body: Body) -> Array:
    """The joint torques or forces that hold a body with a fixed base at rest where it is, (n,) [N m or N].

    Raises:
        ValueError: The base is free.
    """
    return gravity_forces(body, JointState(body).read()[0])


class ComputedTorque:
    """Computed torque: inverse dynamics of the wanted acceleration, with feedback to it.

    The error of positions e obeys ë + 2 ζ ω ė + ω² e = 0, each joint by itself. What damping and friction of
    joints take is not compensated. A step of `World` computes new positions from new velocities, so a
    reference by backward differences, v[k] = (q[k] - q[k-1]) / h and a[k] = (v[k+1] - v[k]) / h, is followed
    without error.
    """

    def __init__(self, body: Body, *, frequency: ArrayLike = 20.0, damping_ratio: ArrayLike = 1.0) -> None:
        """Make a controller.

        Args:
            body: A body with a fixed base.
            frequency: Natural frequency ω of the error [rad/s], a number or (n,).
            damping_ratio: ζ, likewise; 1 is critical.

        Raises:
            ValueError: The base is free, or a number is negative.
        """
        self._state = JointState(body)
        self._frequency = not_negative(frequency, "frequency")
        self._damping_ratio = not_negative(damping_ratio, "damping_ratio")

    def compute(
        self, positions: ArrayLike, velocities: ArrayLike = 0.0, accelerations: ArrayLike = 0.0
    ) -> Array:
        """The torques or forces of joints for the next step, for `body.joints.set_torques`, (n,) [N m or N].

        Args:
            positions: Wanted positions, a quaternion (x, y, z, w) for each spherical joint.
            velocities: Wanted velocities, a number or (n,).
            accelerations: Wanted accelerations, likewise.

        Raises:
            ValueError: A shape does not fit, or a number is not finite.
        """
        state = self._state
        wanted = vector(positions, state.coordinates, "positions")
        rates = vector(np.broadcast_to(velocities, (state.dofs,)), state.dofs, "velocities")
        changes = vector(np.broadcast_to(accelerations, (state.dofs,)), state.dofs, "accelerations")
        present, speed = state.read()
        error = state.difference(wanted, present)
        motion = changes + 2.0 * self._damping_ratio * self._frequency * (rates - speed)
        return inverse_dynamics(state.body, present, speed, motion + self._frequency**2 * error)
