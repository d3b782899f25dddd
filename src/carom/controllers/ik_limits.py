"""Limits of inverse kinematics: bounds of small changes of positions, and inequality rows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, not_negative, positive
from carom.controllers.configuration import Configuration
from carom.engine.queries.pair_search import NearestPoints


class Bounds(NamedTuple):
    """Bounds of small changes dq: lower ≤ dq ≤ upper, each (n,)."""

    lower: Array
    upper: Array


class Inequalities(NamedTuple):
    """Rows G dq ≤ h.

    Attributes:
        g: G, (k, n).
        h: (k,).
    """

    g: Array
    h: Array


class Limit:
    """A limit, with bounds or with rows."""

    def bounds(self, configuration: Configuration, time_step: float) -> Bounds | None:
        """Bounds of the changes in a tick of `time_step` [s]; None if there are none."""
        return None

    def inequalities(self, configuration: Configuration, time_step: float) -> Inequalities | None:
        """Rows for the changes in a tick of `time_step` [s]; None if there are none."""
        return None


class ConfigurationLimit(Limit):
    """Revolute and prismatic joints stay between their limits."""

    def __init__(
        self,
        configuration: Configuration,
        limits: Mapping[str, tuple[float, float]] | None = None,
        *,
        gain: float = 1.0,
        margin: float = 0.0,
    ) -> None:
        """Read the limits of the joints.

        Args:
            configuration: A configuration of the body.
            limits: Least and greatest position of joints by their names, in place of those of the file
                [rad or m]; infinity for none.
            gain: Share of the way to a limit that may be gone in a tick, above 0 and at most 1.
            margin: Distance to keep from limits [rad or m].

        Raises:
            KeyError: There is no joint of a name.
            ValueError: It is neither revolute nor prismatic, or its limits are not in order.
        """
        self._gain = float(positive(gain, "gain"))
        self._dofs, self._places, joints = configuration.scalar_joints()
        ranges = {joint: configuration.body.joints[joint].limits for joint in joints}
        for name, (low, high) in (limits or {}).items():
            joint = configuration.body.joints[name].index
            if joint not in ranges:
                raise ValueError(f"joint {name!r} has no limits: it is neither revolute nor prismatic")
            if not low <= high:
                raise ValueError(f"limits of joint {name!r} must be in order, not {low} and {high}")
            ranges[joint] = low, high
        self._lower = np.array([low for low, _ in ranges.values()]) + margin
        self._upper = np.array([high for _, high in ranges.values()]) - margin
        self._endless = np.full((2, configuration.dofs), np.inf) * np.array([[-1.0], [1.0]])

    def bounds(self, configuration: Configuration, time_step: float) -> Bounds:
        """The way to the limits."""
        at = configuration.positions[self._places]
        lower, upper = self._endless[0].copy(), self._endless[1].copy()
        lower[self._dofs] = self._gain * (self._lower - at)
        upper[self._dofs] = self._gain * (self._upper - at)
        return Bounds(lower, upper)


class VelocityLimit(Limit):
    """Speeds stay below limits."""

    def __init__(self, velocities: ArrayLike | Mapping[str, float]) -> None:
        """Set the limits [rad/s or m/s].

        Args:
            velocities: A number, or one for each velocity, or those of joints by their names, where others
                have none; infinity for none.
        """
        self._by_name: dict[str, float] | None = None
        if isinstance(velocities, Mapping):
            self._by_name = {
                name: float(not_negative(float(value), f"velocity of {name!r}"))
                for name, value in velocities.items()
            }
        else:
            self._velocities = not_negative(velocities, "velocities")

    def bounds(self, configuration: Configuration, time_step: float) -> Bounds:
        """The limits times the time."""
        if self._by_name is not None:
            upper = np.full(configuration.dofs, np.inf)
            for name, value in self._by_name.items():
                upper[configuration.joint_dofs(name)] = value * time_step
            return Bounds(-upper, upper)
        upper = np.broadcast_to(self._velocities * time_step, (configuration.dofs,))
        return Bounds(-upper, upper)


class CollisionAvoidanceLimit(Limit):
    """Links keep a distance from other links and from other bodies.

    Where shapes are nearer than `detection_distance`, they may approach in a tick by no more than a share of
    what is left above the minimum distance. Distances are those of the nearest points of collision shapes.
    """

    def __init__(
        self,
        configuration: Configuration,
        pairs: Iterable[tuple[Sequence[tuple[int, int]], Sequence[tuple[int, int]]]],
        *,
        minimum_distance: float = 0.01,
        detection_distance: float = 0.1,
        gain: float = 0.85,
    ) -> None:
        """Choose links.

        Args:
            configuration: A configuration of the body.
            pairs: Pairs of groups of links, each link as number of the body and index (-1 is the base): each
                link of the first group avoids each of the second.
            minimum_distance: [m].
            detection_distance: Distance from which approaching is limited [m].
            gain: Share of the distance left that may be gone in a tick, above 0 and at most 1.

        Raises:
            KeyError: There is no such body.
        """
        self._gain = float(positive(gain, "gain"))
        self._minimum, self._detection = minimum_distance, float(positive(detection_distance, "distance"))
        if self._minimum >= self._detection:
            raise ValueError("minimum_distance must be below detection_distance")
        bodies = configuration.world.bodies

        def rows(group: Sequence[tuple[int, int]]) -> tuple[int, ...]:
            return tuple(bodies[body].first_link + 1 + link for body, link in group)

        self._pairs = [(rows(first), rows(second)) for first, second in pairs]

    def distances(self, configuration: Configuration) -> list[float]:
        """Distances of pairs of shapes that are nearer than the detection distance [m]."""
        return [found[5] for found in self._nearest(configuration)]

    def inequalities(self, configuration: Configuration, time_step: float) -> Inequalities | None:
        """One row for each pair of shapes that are near."""
        near = self._nearest(configuration)
        if not near:
            return None
        first, count = configuration.body.first_link + 1, configuration.body.joint_count
        g = np.zeros((len(near), configuration.dofs))
        # A point on the first link gains distance along the normal, one on the second against it.
        sides = (
            (-1.0, [(found[0] - first, found[2], found[4]) for found in near]),
            (1.0, [(found[1] - first, found[3], found[4]) for found in near]),
        )
        for sign, side in sides:
            rows = [row for row, (link, _, _) in enumerate(side) if -1 <= link < count]
            if rows:
                links, points, normals = zip(*(side[row] for row in rows), strict=True)
                g[rows] += sign * configuration.approaches(links, points, normals)
        h = self._gain * (np.array([found[5] for found in near]) - self._minimum)
        return Inequalities(g, h)

    def _nearest(self, configuration: Configuration) -> list[NearestPoints]:
        queries = configuration.world.queries()
        return [found for pair in self._pairs for found in queries.nearest(pair[0], pair[1], self._detection)]
