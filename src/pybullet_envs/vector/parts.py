"""Links and joints of single environments, in many worlds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from carom.checks import Array
from carom.worlds.body import BodyBatch
from carom.worlds.worlds import Worlds
from pybullet_envs.robot_parts import BodyPart, Joint


class Joints:
    """Some joints, of one or several bodies, in the order of a robot of a single environment.

    Attributes:
        count: How many there are.
        lower: Their lower limits [rad or m], (count,).
        upper: Their upper limits.

    Args:
        worlds: The worlds.
        joints: The joints of the single environment.
    """

    def __init__(self, worlds: Worlds, joints: Sequence[Joint]) -> None:
        self.count = len(joints)
        self.lower = np.array([joint.lowerLimit for joint in joints])
        self.upper = np.array([joint.upperLimit for joint in joints])
        # Of each body: where its joints are among these, and among its own.
        self._groups: list[tuple[BodyBatch, slice | np.ndarray, slice | np.ndarray]] = []
        for body in dict.fromkeys(joint.body for joint in joints):
            places = [place for place, joint in enumerate(joints) if joint.body == body]
            own: list[int | str] = [joints[place].jointIndex for place in places]
            self._groups.append((worlds[body], _run(places), worlds[body].columns(own)))
        self._positions = np.empty((worlds.count, self.count))
        self._velocities = np.empty((worlds.count, self.count))

    def positions(self) -> Array:
        """[rad or m], (worlds, count); the same array is filled again by the next call."""
        for body, places, columns in self._groups:
            self._positions[:, places] = body.joint_positions[:, columns]
        return self._positions

    def velocities(self) -> Array:
        """[rad/s or m/s], (worlds, count); the same array is filled again by the next call."""
        for body, places, columns in self._groups:
            self._velocities[:, places] = body.joint_velocities[:, columns]
        return self._velocities

    def relative(self) -> Array:
        """Positions from -1 at the lower limits to 1 at the upper ones, (worlds, count).

        To the last digit as `relative_joint_states` of a robot has them.
        """
        return (2.0 * self.positions() - self.lower - self.upper) / (self.upper - self.lower)

    def between_limits(self) -> Array:
        """The same, to the last digit as `current_relative_position` of a joint has it."""
        middle = 0.5 * (self.lower + self.upper)
        return 2.0 * (self.positions() - middle) / (self.upper - self.lower)

    def push(self, torques: Array) -> None:
        """Apply torques [N m] or forces [N], (worlds, count), in the next step."""
        for body, places, columns in self._groups:
            body.joint_torques[:, columns] = torques[:, places]

    def put(self, worlds: np.ndarray, positions: Array) -> None:
        """Put the joints of some worlds somewhere, (n, count), at rest."""
        for body, places, columns in self._groups:
            own = body.joint_positions[worlds]
            own[:, columns] = positions[:, places]
            body.joint_positions[worlds] = own
            own = body.joint_velocities[worlds]
            own[:, columns] = 0.0
            body.joint_velocities[worlds] = own
            body.update_link_poses(worlds)


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
        return self._body.base_poses if self._link < 0 else self._body.stepped_link_poses[:, self._link]

    def velocities(self) -> Array:
        """Velocity [m/s] of the centre of mass, (worlds, 3)."""
        if self._link < 0:
            return self._body.base_velocities[:, :3]
        return self._body.stepped_link_velocities[:, self._link, :3]


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
        # Of each body its base, then its links: sums are to come out the same to the last digit.
        self._links = [(worlds[body], link) for body, own in links.items() for link in _base_first(own)]
        self._total = np.empty((worlds.count, 2))

    def positions(self) -> Array:
        """Along x and y [m], (worlds, 2)."""
        total = self._total
        total[:] = 0.0
        for body, link in self._links:
            poses = body.base_poses if link < 0 else body.stepped_link_poses[:, link]
            total += poses[:, :2]
        return total / len(self._links)


def _base_first(links: list[int]) -> list[int]:
    return sorted(links, key=lambda link: link >= 0)


def _run(places: Sequence[int]) -> slice | np.ndarray:
    """A slice if the places follow each other."""
    if list(places) == list(range(places[0], places[0] + len(places))):
        return slice(places[0], places[-1] + 1)
    return np.array(places)
