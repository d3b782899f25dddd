"""Tendons with armature along paths between sites: what their inertia feels of the motion of steady joints.

It resists what is faster than steady joints move it, which is a second derivative of the length by time; so
derivatives of a step have a third one. They are those of the formula, by imaginary parts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import PATH_PULLEY, PATH_SITE, UserConstraintKind
from carom.layouts.linearization import TENDON_SPRING

if TYPE_CHECKING:
    from carom.linearization.free_motion import FreeMotion
    from carom.linearization.integrators.frame_motions import Carried, FrameMotions
    from carom.linearization.spatial import Spatial
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.stepping import Copies
    from carom.linearization.tangent import TangentSpace

# So small that its square vanishes, see `sensor_motion`.
_SMALL = 1e-40
_TINY = 1e-15


class PathInertia:
    """The tendons of `copies` that have armature and a path between sites.

    Args:
        space: The tangent space.
        copies: The worlds.
        frames: Bases that move by their frames.
    """

    def __init__(self, space: TangentSpace, copies: Copies, frames: FrameMotions) -> None:
        self._space, self._copies, self._frames = space, copies, frames
        self._users: dict[str, np.ndarray] = {}
        self._tendons: set[int] = set()

    def follow(self) -> None:
        """Find the present ones."""
        arrays = self._copies.engine.contact_arrays
        users, count = arrays.users.numpy, arrays.user_count
        self._users = users
        self._tendons = set()
        armature = users["user_armature"][:count]
        # Of small arrays this takes less time than a comparison, and most have none.
        if not np.count_nonzero(armature):
            return
        for user in np.flatnonzero(armature > 0.0).tolist():
            path = slice(users["user_first_path"][user], users["user_second_path"][user])
            is_tendon = users["user_kind"][user] == UserConstraintKind.TENDON
            if is_tendon and (users["path_kind"][path] == PATH_SITE).any():
                self._tendons.add(user)

    def __bool__(self) -> bool:
        return bool(self._tendons)

    def add(self, memory: StepMemory, place: int, motion: FreeMotion) -> None:
        """Add to the rows of springs how the motion of steady joints changes; all rows are there."""
        own = slice(int(memory.row_count[place]))
        dofs, by_frame = len(self._space), self._frames.follow(motion.parameters)
        for row in np.flatnonzero(memory.row_kind[place, own] == TENDON_SPRING).tolist():
            user = int(memory.row_dof[place, row])
            if user not in self._tendons:
                continue
            tree = int(self._users["user_tree_a"][user])
            body = next(it for it, own in enumerate(self._space.bodies) if own.rows.tree == tree)
            first, size = self._space.places[body]
            rates = memory.velocity[place, 0, first : first + size]
            steady = _SteadyMotion(motion.spatial[body], rates)
            if by_frame:
                for it in self._frames.at(motion.position, memory.velocity[place, 0]):
                    if it.dof == first:
                        steady.carry(it)
            found = self._derivatives(user, steady, self._space.bodies[body].first_link)
            found *= -self._users["user_armature"][user] * motion.time_step
            side = memory.side[place, row]
            side[first : first + size] += found[:size]
            side[dofs + first : dofs + first + size] += found[size:]

    def _derivatives(self, user: int, motion: _SteadyMotion, first_link: int) -> np.ndarray:
        """Derivatives of `tendons.path_rates.path_acceleration` by positions, then by velocities, (2 n,)."""
        users, n = self._users, motion.size
        total = np.zeros(2 * n, dtype=complex)
        divisor = 1.0
        last: tuple[int, tuple[np.ndarray, np.ndarray, np.ndarray]] | None = None
        for part in range(users["user_first_path"][user], users["user_second_path"][user]):
            kind = users["path_kind"][part]
            if kind != PATH_SITE:
                divisor = users["path_size"][part] if kind == PATH_PULLEY else divisor
                last = None
                continue
            link = int(users["path_link"][part])
            now = motion.of(link - first_link if link >= 0 else -1, users["path_point"][part])
            if last is not None and last[0] != link:
                total += _segment(*(its - own for its, own in zip(now, last[1], strict=True))) / divisor
            last = link, now
        return np.imag(total) / _SMALL


def _segment(apart: np.ndarray, parting: np.ndarray, pulled: np.ndarray) -> np.ndarray:
    """The second derivative by time of a distance, of the vector between two points and two of its own."""
    distance = np.sqrt(np.sum(apart * apart, axis=1))
    if np.real(distance[0]) <= _TINY:
        return np.zeros(len(apart))
    along = apart / distance[:, None]
    rate = np.sum(along * parting, axis=1)
    across = np.sum(parting * parting, axis=1) - rate * rate
    return np.sum(along * pulled, axis=1) + across / distance


class _SteadyMotion:
    """Points of links at constant rates, with changes of positions, then of rates, as imaginary parts.

    Args:
        spatial: Motion subspaces of the body.
        rates: Velocities of its dofs, (n,).
    """

    def __init__(self, spatial: Spatial, rates: np.ndarray) -> None:
        n = len(rates)
        self._spatial = spatial
        none = np.zeros((n, n, 3))
        self._angular = spatial.angular + 1j * _SMALL * np.concatenate([spatial.turns.swapaxes(0, 1), none])
        self._linear = spatial.linear + 1j * _SMALL * np.concatenate([spatial.shifts.swapaxes(0, 1), none])
        self._rates = rates + 1j * _SMALL * np.concatenate([np.zeros((n, n)), np.eye(n)])
        omega = self._summed(spatial.follows, self._angular)
        speed = self._summed(spatial.follows, self._linear)
        self._carried = np.zeros((2 * n, 3), dtype=complex)
        self._turning = np.cross(omega, self._angular)
        self._shifting = np.cross(omega, self._linear) + np.cross(speed, self._angular)

    @property
    def size(self) -> int:
        """Number of dofs."""
        return len(self._rates) // 2

    def carry(self, base: Carried) -> None:
        """Add the acceleration of all links with a base whose frame has none, see `frame_motions`."""
        n = self.size
        self._carried += base.acceleration
        self._carried[:3] += 1j * _SMALL * base.by_turn.T
        self._carried[n : n + 3] += 1j * _SMALL * base.by_omega.T

    def _summed(self, weights: np.ndarray, of_dofs: np.ndarray) -> np.ndarray:
        """Sums (2 n, k, 3) of what belongs to dofs (2 n, n, 3) times their rates and weights (k, n)."""
        return np.einsum("kd,cd,cdx->ckx", weights, self._rates, of_dofs)

    def of(self, link: int, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position, velocity and acceleration (2 n, 3) of a point of a link, -1 for the world."""
        spatial, n = self._spatial, len(self._rates) // 2
        if link < 0:
            still = np.zeros((2 * n, 3), dtype=complex)
            return still + point, still, still
        moves = spatial.moves[link]
        there = spatial.centres[link] + spatial.rotations[link] @ point
        moved = moves[:, None] * (spatial.linear + np.cross(spatial.angular, there))
        at = there + 1j * _SMALL * np.concatenate([moved, np.zeros((n, 3))])
        parts = (self._angular, self._linear, self._turning, self._shifting)
        omega, speed, turning, shifting = (self._summed(moves[None], it)[:, 0] for it in parts)
        velocity = speed + np.cross(omega, at)
        bent = shifting + np.cross(turning, at) + np.cross(omega, velocity)
        return at, velocity, bent + self._carried
