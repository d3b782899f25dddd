"""Links and joints of a single environment's robots, in many worlds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import cast

import numpy as np

from carom.checks import Array
from carom.worlds.body import BodyBatch
from carom.worlds.worlds import Worlds
from pybullet_envs.robot_parts import BodyPart, Joint


class Joints:
    """Some joints of one or several bodies, in many worlds, in the order of `joints`.

    Attributes:
        count: Number of joints.
        lower: Lower position limits [rad or m], (count,).
        upper: Upper position limits [rad or m], (count,).

    Args:
        worlds: The worlds.
        joints: The joints of the single environment.
    """

    def __init__(self, worlds: Worlds, joints: Sequence[Joint]) -> None:
        self.count = len(joints)
        self.lower = np.array([joint.lowerLimit for joint in joints])
        self.upper = np.array([joint.upperLimit for joint in joints])
        # For each body: the indices of its joints in `joints`, and among all joints of the body.
        self._groups: list[tuple[BodyBatch, slice | np.ndarray, slice | np.ndarray]] = []
        for body in dict.fromkeys(joint.body for joint in joints):
            places = [place for place, joint in enumerate(joints) if joint.body == body]
            own = [joints[place].jointIndex for place in places]
            self._groups.append((worlds[body], _run(places), _columns(worlds[body], own)))
        self._positions = np.empty((worlds.count, self.count))
        self._velocities = np.empty((worlds.count, self.count))

    def positions(self) -> Array:
        """Positions [rad or m], (worlds, count); the next call overwrites the array."""
        for body, places, columns in self._groups:
            self._positions[:, places] = body.joints.positions[:, columns]
        return self._positions

    def velocities(self) -> Array:
        """Velocities [rad/s or m/s], (worlds, count); the next call overwrites the array."""
        for body, places, columns in self._groups:
            self._velocities[:, places] = body.joints.velocities[:, columns]
        return self._velocities

    def relative(self) -> Array:
        """Positions from -1 at the lower limits to 1 at the upper ones, (worlds, count).

        Equal, to the last digit, to the `relative_joint_states` of a robot.
        """
        return (2.0 * self.positions() - self.lower - self.upper) / (self.upper - self.lower)

    def between_limits(self) -> Array:
        """Like `relative`, but equal to the last digit to a joint's `current_relative_position`."""
        middle = 0.5 * (self.lower + self.upper)
        return 2.0 * (self.positions() - middle) / (self.upper - self.lower)

    def push(self, torques: Array) -> None:
        """Apply torques [N m] or forces [N], (worlds, count), in the next step."""
        for body, places, columns in self._groups:
            body.joints.torques[:, columns] = torques[:, places]

    def put(self, worlds: np.ndarray, positions: Array) -> None:
        """Set the joint positions of some worlds [rad or m], (n, count), at rest."""
        for body, places, columns in self._groups:
            own = body.joints.positions[worlds]
            own[:, columns] = positions[:, places]
            body.joints.positions[worlds] = own
            own = body.joints.velocities[worlds]
            own[:, columns] = 0.0
            body.joints.velocities[worlds] = own
            body.links.update_poses(worlds)


class Part:
    """A link, in many worlds.

    Args:
        worlds: The worlds.
        part: The link of the single environment.
    """

    def __init__(self, worlds: Worlds, part: BodyPart) -> None:
        self._body = worlds[part.body]
        self._link = part.bodyPartIndex

    def poses(self) -> Array:
        """Position [m] and orientation (x, y, z, w) of the centre of mass, (worlds, 7); a view."""
        return (
            self._body.base_inertial_poses
            if self._link < 0
            else self._body.links.stepped_poses[:, self._link]
        )

    def velocities(self) -> Array:
        """Velocity [m/s] of the centre of mass, (worlds, 3)."""
        if self._link < 0:
            return self._body.base_velocities[:, :3]
        return self._body.links.stepped_velocities[:, self._link, :3]


class Middle:
    """The mean position of some links.

    Args:
        worlds: The worlds.
        parts: The links of the single environment, in its order.
    """

    def __init__(self, worlds: Worlds, parts: Iterable[BodyPart]) -> None:
        links: dict[int, list[int]] = {}
        for part in parts:
            links.setdefault(part.body, []).append(part.bodyPartIndex)
        # For each body its base, then its links: in this order sums are equal to the last digit.
        self._links = [(worlds[body], link) for body, own in links.items() for link in _base_first(own)]
        self._total = np.empty((worlds.count, 2))

    def positions(self) -> Array:
        """Mean positions along x and y [m], (worlds, 2)."""
        total = self._total
        total[:] = 0.0
        for body, link in self._links:
            poses = body.base_inertial_poses if link < 0 else body.links.stepped_poses[:, link]
            total += poses[:, :2]
        return total / len(self._links)


def _base_first(links: list[int]) -> list[int]:
    return sorted(links, key=lambda link: link >= 0)


def _run(places: Sequence[int]) -> slice | np.ndarray:
    """The indices, as a slice if they are consecutive."""
    if list(places) == list(range(places[0], places[0] + len(places))):
        return slice(places[0], places[-1] + 1)
    return np.array(places)


def _columns(body: BodyBatch, joints: Sequence[int]) -> slice | np.ndarray:
    """Columns of joints in the arrays of a body; environments may name one twice."""
    return _run([cast("slice", body.joints[[joint]].columns).start for joint in joints])
