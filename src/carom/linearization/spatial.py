"""Motion subspaces of dofs in world axes, how they change with the positions, and forces on links."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import BASE_VELOCITIES
from carom.linearization.turns import cross, matrix_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


class Spatial:
    """Motion subspaces of the dofs of a body, about the origin of the world, and the links they move.

    Attributes:
        angular: Angular velocity of the link by a unit rate of each dof, (n, 3).
        linear: Linear velocity of the point of the link at the origin of the world, (n, 3).
        turns: Derivatives of `angular` of dof i by a change of dof j, [i, j], (n, n, 3).
        shifts: Likewise of `linear`.
        moves: 1 where a link, in the rows of the body, is moved by a dof, else 0, (links, n).
        follows: 1 where the axes of dof i follow dof j, [i, j], else 0, (n, n).
        centres: Centres of mass of the links, (links, 3).
        rotations: Rotations of their inertial frames, (links, 3, 3).
    """

    def __init__(self, body: BodyCore, poses: np.ndarray, columns: tuple[np.ndarray, np.ndarray]) -> None:
        """Find them for link poses (links, 7), and `angular` and `linear` (n, 3) about the base's centre."""
        free = 0 if body.fixed_base else BASE_VELOCITIES
        own, about = columns
        if not body.joint_count and free:
            own, about = np.zeros((6, 3)), np.zeros((6, 3))
            own[:3] = about[3:] = np.eye(3)
        reference = poses[0, :3]
        self.angular: np.ndarray = own
        self.linear: np.ndarray = about - cross(own, reference)
        self.centres: np.ndarray = poses[:, :3]
        self.rotations: np.ndarray = matrix_of(poses[:, 3:])
        self.moves, follows = _tree_of(body, free)
        self.follows: np.ndarray = follows
        turned = cross(own[None, :, :], own[:, None, :])
        moved = cross(own[None], self.linear[:, None]) + cross(self.linear[None], own[:, None])
        self.turns: np.ndarray = follows[:, :, None] * turned
        self.shifts: np.ndarray = follows[:, :, None] * moved


def _tree_of(body: BodyCore, free: int) -> tuple[np.ndarray, np.ndarray]:
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


def moving_dofs(body: BodyCore) -> np.ndarray:
    """1 where a link, in the rows of a body, is moved by a dof, else 0, (links, n)."""
    return _tree_of(body, 0 if body.fixed_base else BASE_VELOCITIES)[0]


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
    linear, angular = damping
    wanted = spatial.moves.any(axis=1) & ((linear != 0.0) | (angular != 0.0) | constant.any(axis=1))
    if not wanted.any():
        return np.zeros(size), np.zeros((size, size)), np.zeros((size, size))
    moves, centres = spatial.moves[wanted][:, :, None], spatial.centres[wanted][:, None]
    turning = moves * spatial.angular
    moving = moves * (spatial.linear + cross(spatial.angular, centres))
    force, torque = constant[wanted, :3].copy(), constant[wanted, 3:].copy()
    by_position, by_velocity = np.zeros((size, size)), np.zeros((size, size))
    if linear or angular:
        speed, omega = velocity @ moving, velocity @ turning
        # Derivatives by positions: [link, dof, axis].
        rates = moves[:, :, 0] * velocity
        count = len(rates)
        omega_q = (rates @ spatial.turns.reshape(size, -1)).reshape(count, size, 3)
        speed_q = (rates @ spatial.shifts.reshape(size, -1)).reshape(count, size, 3)
        speed_q += cross(omega_q, centres) + cross(omega[:, None], moving)
        mass, turn = masses[wanted], spatial.rotations[wanted]
        rate, rate_v = decay(linear, speed)
        force -= (mass * rate)[:, None] * speed
        drag = mass[:, None, None] * (rate[:, None, None] * np.eye(3) + speed[:, :, None] * rate_v[:, None])
        inertia = (turn * inertias[wanted][:, None]) @ turn.transpose(0, 2, 1)
        rate, rate_v = decay(angular, omega)
        spin = (inertia @ omega[:, :, None])[:, :, 0]
        torque -= rate[:, None] * spin
        brake = rate[:, None, None] * inertia + spin[:, :, None] * rate_v[:, None]
        # The inertia turns with the link.
        turned = cross(turning, spin[:, None]) - cross(turning, omega[:, None]) @ inertia
        pushed_v, braked_v = moving @ drag, turning @ brake
        braked_q = omega_q @ brake.transpose(0, 2, 1) + rate[:, None, None] * turned
        by_velocity = -_summed(pushed_v, moving) - _summed(braked_v, turning)
        by_position = -_summed(pushed_v, speed_q) - _summed(turning, braked_q)
    moment = torque + cross(centres[:, 0], force)
    forces = (turning @ torque[:, :, None] + moving @ force[:, :, None]).sum(axis=0)[:, 0]
    changed = (moment @ spatial.turns.reshape(-1, 3).T + force @ spatial.shifts.reshape(-1, 3).T).reshape(
        -1, size, size
    )
    by_position += (moves * changed).sum(axis=0) + _summed(turning, cross(moving, force[:, None]))
    return forces, by_position, by_velocity


def _summed(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Sum over links of a bᵀ, (n, n), of arrays (links, n, 3)."""
    size = a.shape[1]
    return a.transpose(1, 0, 2).reshape(size, -1) @ b.transpose(1, 0, 2).reshape(size, -1).T


def decay(coefficient: float, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Decay rates (links,) of damped velocities (links, 3), and their derivatives by the velocities."""
    speed = np.sqrt((velocity * velocity).sum(axis=1))
    return coefficient * (1.0 + speed), coefficient * velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
