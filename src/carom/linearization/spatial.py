"""Motion subspaces of dofs in world axes, how they change with the positions, and forces on links."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import BASE_VELOCITIES
from carom.linearization.turns import matrix_of

if TYPE_CHECKING:
    from carom.scene.body import Body


class Spatial:
    """Motion subspaces of the dofs of a body, about the origin of the world, and the links they move.

    Attributes:
        angular: Angular velocity of the link by a unit rate of each dof, (n, 3).
        linear: Linear velocity of the point of the link at the origin of the world, (n, 3).
        turns: Derivatives of `angular` of dof i by a change of dof j, [i, j], (n, n, 3).
        shifts: Likewise of `linear`.
        moves: 1 where a link, in the rows of the body, is moved by a dof, else 0, (links, n).
        centres: Centres of mass of the links, (links, 3).
        rotations: Rotations of their inertial frames, (links, 3, 3).
    """

    def __init__(self, body: Body, poses: np.ndarray, columns: tuple[np.ndarray, np.ndarray]) -> None:
        """Find them for link poses (links, 7), and `angular` and `linear` (n, 3) about the base's centre."""
        free = 0 if body.fixed_base else BASE_VELOCITIES
        own, about = columns
        if not body.joint_count and free:
            own, about = np.zeros((6, 3)), np.zeros((6, 3))
            own[:3] = about[3:] = np.eye(3)
        reference = poses[0, :3]
        self.angular: np.ndarray = own
        self.linear: np.ndarray = about - np.cross(own, reference)
        self.centres: np.ndarray = poses[:, :3]
        self.rotations: np.ndarray = matrix_of(poses[:, 3:])
        self.moves, follows = _tree_of(body, free)
        turned = np.cross(own[None, :, :], own[:, None, :])
        moved = np.cross(own[None], self.linear[:, None]) + np.cross(self.linear[None], own[:, None])
        self.turns: np.ndarray = follows[:, :, None] * turned
        self.shifts: np.ndarray = follows[:, :, None] * moved

    def point_columns(self, link: int, point: np.ndarray) -> np.ndarray:
        """The Jacobian of a point of a link, (n, 3), transposed."""
        return self.moves[link][:, None] * (self.linear + np.cross(self.angular, point))

    def wrench(self, link: int, point: np.ndarray, force: np.ndarray, torque: np.ndarray) -> np.ndarray:
        """Generalized forces (n,) of a force at a point of a link and a torque."""
        own = self.angular @ (torque + np.cross(point, force)) + self.linear @ force
        return self.moves[link] * own

    def wrench_derivatives(
        self, link: int, point: np.ndarray, force: np.ndarray, torque: np.ndarray, moving: np.ndarray
    ) -> np.ndarray:
        """Derivatives of `wrench` by positions, (n, n), for a constant force and torque.

        Args:
            moving: Change of the point by a change of each dof, (n, 3).
        """
        moment = torque + np.cross(point, force)
        by_position = self.turns @ moment + self.shifts @ force
        by_position += self.angular @ np.cross(moving, force).T
        return self.moves[link][:, None] * by_position

    def velocity_derivatives(
        self, link: int, point: np.ndarray, moving: np.ndarray, velocity: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (3, n) of linear and angular velocity of a point of a link by positions.

        Args:
            link: Row of the link.
            point: The point.
            moving: Change of the point by a change of each dof, (n, 3).
            velocity: Velocities of the dofs.
        """
        rates = self.moves[link] * velocity
        turned = np.einsum("i,ijk->kj", rates, self.turns)
        omega = rates @ self.angular
        shifted = np.einsum("i,ijk->kj", rates, self.shifts) + np.cross(turned.T, point).T
        return shifted + np.cross(omega, moving).T, turned


def _tree_of(body: Body, free: int) -> tuple[np.ndarray, np.ndarray]:
    """Which dof moves which link, (links, n), and the axes of which dof i follow dof j, [i, j]."""
    known = body.derived.get(Spatial)
    if known is None:
        count = free + sum(body.velocity_count)
        moves = np.zeros((1 + body.joint_count, count))
        follows = np.zeros((count, count))
        moves[0, :free] = 1.0
        # Angular velocities of the base are along axes of the world, about its centre.
        follows[:3, 3:free] = 1.0 if free else 0.0
        dof = free
        for joint, link in enumerate(body.spec.links):
            own = slice(dof, dof + body.velocity_count[joint])
            moves[1 + joint] = moves[1 + link.parent]
            moves[1 + joint, own] = 1.0
            follows[own] = moves[1 + joint]
            dof = own.stop
        known = body.derived[Spatial] = moves, follows
    return known


def link_forces(
    spatial: Spatial,
    velocity: np.ndarray,
    masses: np.ndarray,
    inertias: np.ndarray,
    damping: tuple[float, float],
    constant: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Generalized forces of damping and of constant forces on links, and their derivatives.

    Args:
        spatial: The motion subspaces.
        velocity: Velocities of the dofs, (n,).
        masses: Masses of the links.
        inertias: Their moments of inertia, (links, 3).
        damping: Linear and angular damping of the body.
        constant: Force and torque on each link at its centre of mass, (links, 6), in world axes.

    Returns:
        The forces (n,), and their derivatives by positions and by velocities, (n, n).
    """
    size = len(velocity)
    forces, by_position, by_velocity = np.zeros(size), np.zeros((size, size)), np.zeros((size, size))
    linear, angular = damping
    for link in range(len(masses)):
        if not spatial.moves[link].any():
            continue
        if not (linear or angular) and not constant[link].any():
            continue
        centre = spatial.centres[link]
        moving = spatial.point_columns(link, centre)
        force, torque = constant[link, :3].copy(), constant[link, 3:].copy()
        if linear or angular:
            turning = spatial.moves[link][:, None] * spatial.angular
            speed, omega = velocity @ moving, velocity @ turning
            speed_q, omega_q = spatial.velocity_derivatives(link, centre, moving, velocity)
            rate, rate_v = _decay(linear, speed)
            force -= masses[link] * rate * speed
            drag = masses[link] * (rate * np.eye(3) + np.outer(speed, rate_v))
            inertia = (spatial.rotations[link] * inertias[link]) @ spatial.rotations[link].T
            rate, rate_v = _decay(angular, omega)
            spin = inertia @ omega
            torque -= rate * spin
            brake = rate * inertia + np.outer(spin, rate_v)
            # The inertia turns with the link.
            turned = np.cross(turning, spin).T - inertia @ np.cross(turning, omega).T
            by_velocity -= moving @ drag @ moving.T + turning @ brake @ turning.T
            by_position -= moving @ drag @ speed_q + turning @ (brake @ omega_q + rate * turned)
        forces += spatial.wrench(link, centre, force, torque)
        by_position += spatial.wrench_derivatives(link, centre, force, torque, moving)
    return forces, by_position, by_velocity


def _decay(coefficient: float, velocity: np.ndarray) -> tuple[float, np.ndarray]:
    """Decay rate of a damped velocity, and its derivatives by the velocity."""
    speed = float(np.sqrt(velocity @ velocity))
    return coefficient * (1.0 + speed), coefficient * velocity / speed if speed else np.zeros(3)


