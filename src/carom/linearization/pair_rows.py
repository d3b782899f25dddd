"""Jacobians of rows over two links, and how they change with the positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.linearization.turns import cross

if TYPE_CHECKING:
    from carom.linearization.free_motion import FreeMotion
    from carom.linearization.tangent import TangentSpace


class Point(NamedTuple):
    """A point of a link, and how it moves.

    Attributes:
        place: Body and link in it; None if the link cannot move.
        position: The point in world axes.
        moving: Its change by a change of each dof, (3, n).
        turning: The rotation vector of the link by a change of each dof, (3, n).
    """

    place: tuple[int, int] | None
    position: np.ndarray
    moving: np.ndarray
    turning: np.ndarray


class Places:
    """The links of a world in a step by their rows."""

    def __init__(self, space: TangentSpace, motion: FreeMotion) -> None:
        self._space = space
        self._motion = motion
        self._bodies = [(body.first_link, body.joint_count) for body in space.bodies]

    def find(self, link: int) -> tuple[int, int] | None:
        """The body of a link, by its place in the tangent space, and its row in that; None without one."""
        for place, (first, joints) in enumerate(self._bodies):
            if link >= 0 and 0 <= link - first <= joints:
                return place, link - first
        return None

    def own(self, place: int) -> slice:
        """The dofs of a body."""
        first, size = self._space.places[place]
        return slice(first, first + size)

    def point(self, link: int, position: np.ndarray) -> Point:
        """A point that moves with a link, given by its row, or -1 for the world."""
        moving, turning = np.zeros((3, len(self._space))), np.zeros((3, len(self._space)))
        place = self.find(link)
        if place is not None:
            spatial, own = self._motion.spatial[place[0]], self.own(place[0])
            moving[:, own] = spatial.point_columns(place[1], position).T
            turning[:, own] = (spatial.moves[place[1]][:, None] * spatial.angular).T
        return Point(place, position, moving, turning)

    def row(
        self, a: Point, b: Point, linear: np.ndarray, angular: np.ndarray, turned: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The Jacobian (n,) of a row: the motion of a relative to b along `linear` and about `angular`.

        Args:
            a: The point of a, with its change as the row's point of contact, not as a point of the link.
            b: That of b.
            linear: Direction, (3,).
            angular: Axis, (3,).
            turned: Changes of both by a change of each dof, (2, 3, n).

        Returns:
            The Jacobian, and its derivatives by positions: of entry i by dof j, (n, n).
        """
        count = len(self._space)
        jacobian, hessian = np.zeros(count), np.zeros((count, count))
        for sign, end in ((1.0, a), (-1.0, b)):
            if end.place is None:
                continue
            place, link = end.place
            spatial, own = self._motion.spatial[place], self.own(place)
            jacobian[own] += sign * spatial.wrench(link, end.position, linear, angular)
            hessian[own, own] += sign * spatial.wrench_derivatives(
                link, end.position, linear, angular, end.moving[:, own].T
            )
            # What the other body moves: the point of contact, the direction.
            moves = spatial.moves[link][:, None]
            hessian[own] += sign * moves * (spatial.linear @ turned[0])
            moment = turned[1] + cross(end.position, turned[0].T).T
            hessian[own] += sign * moves * (spatial.angular @ moment)
            others = np.ones(count)
            others[own] = 0.0
            moment = cross((end.moving * others).T, linear).T
            hessian[own] += sign * moves * (spatial.angular @ moment)
        return jacobian, hessian
