"""A convex hull of few points, cut into the triangles that PyBullet's images show.

Points that lie nearly in a plane can be cut into triangles in many ways, and textures show which. So points
are added in PyBullet's order: always the one farthest from a triangle, and only while it is worth it.
"""

from __future__ import annotations

from itertools import pairwise
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Vector3

Points = NDArray[np.float64]
Corners = tuple[int, int, int]

_SAME = 1e-3
"""Points that differ by less, as a fraction of the extent along each axis, are one."""

_WORTH = 1e-3
"""A point is worth adding if it is farther out than this, as a fraction of the diagonal of the bounds."""

_ABOVE, _SLIM = 0.01, 0.1
_WIGGLE = 0.025
"""A point counts as a corner if it stays the farthest while the direction turns by about this angle."""


def _circle(angles: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    radians = angles * (2.0 * np.pi / 360.0)
    return np.sin(radians) * _WIGGLE, np.cos(radians) * _WIGGLE


_TURNS = _circle(np.arange(0.0, 361.0, 45.0))
_FINE_TURNS = _circle(np.arange(0.0, 361.0, 5.0))
_FINE_PER_TURN = 9


def sampled_hull(points: Points) -> tuple[Points, list[Corners]]:
    """Corners of the hull of points (n, 3) that do not lie in a plane, and its triangles.

    Triangles are counter-clockwise seen from outside. Points may be left out that are hardly outside.
    """
    corners = _merged(points)
    return corners, _Hull(corners).triangles()


def _merged(points: Points) -> Points:
    """The points, where near ones are one: that which is farther from the middle."""
    low, high = points.min(axis=0), points.max(axis=0)
    extent = high - low
    factors = 1.0 / extent
    middle = (extent * 0.5 + low) * factors
    kept: list[Points] = []
    scaled = points * factors
    if (np.abs(scaled[:, None] - scaled) < _SAME).all(axis=2).sum() == len(points):
        return scaled * extent
    for point in scaled:
        for at, other in enumerate(kept):
            if (np.abs(other - point) < _SAME).all():
                if ((point - middle) ** 2).sum() > ((other - middle) ** 2).sum():
                    kept[at] = point
                break
        else:
            kept.append(point)
    return np.array(kept) * extent


class _Face:
    """A triangle of the hull; `far` is the point farthest outside, so far as `rise` says [m]; -1 if none.

    `across[i]` is the number of the face beyond the side opposite to corner i. `normal` is of unit length,
    and x where the face has no area.
    """

    __slots__ = ("across", "area", "corners", "far", "normal", "number", "place", "rise")

    def __init__(self, number: int, corners: Corners, across: list[int], rows: list[Vector3]) -> None:
        self.number = number
        self.corners = corners
        self.across = across
        self.place, second, third = (rows[corner] for corner in corners)
        normal = _cross(_minus(second, self.place), _minus(third, second))
        # Twice the area.
        self.area = _length(normal)
        self.normal = (1.0, 0.0, 0.0)
        if self.area > 0.0:
            factor = 1.0 / self.area
            self.normal = normal[0] * factor, normal[1] * factor, normal[2] * factor
        self.far = -1
        self.rise = 0.0

    def height(self, point: Vector3) -> float:
        """How far a point is above the plane of the face [m]."""
        return _dot(self.normal, _minus(point, self.place))

    def side(self, a: int, b: int) -> int:
        """The place in `across` of the side from a to b, in either direction."""
        return next(i for i, corner in enumerate(self.corners) if corner not in (a, b))


class _Hull:
    """A hull that grows by one point after the other."""

    def __init__(self, points: Points) -> None:
        self._points = points
        self._rows: list[Vector3] = [(x, y, z) for x, y, z in points.tolist()]
        self._columns = np.ascontiguousarray(points.T)
        # Which points may become corners (0: none of them any more; 2: certainly one).
        self._open = np.ones(len(points), dtype=bool)
        self._certain = [False] * len(points)
        self._faces: list[_Face | None] = []
        self._reach = float(np.sqrt(((points.max(axis=0) - points.min(axis=0)) ** 2).sum())) * _WORTH

    def triangles(self) -> list[Corners]:
        """Grow to the end, and return what there is."""
        first = self._first_corners()
        if first is None:
            return []
        a, b, c, d = first
        for corners, across in (
            ((c, d, b), [2, 3, 1]),
            ((d, c, a), [3, 2, 0]),
            ((a, b, d), [0, 1, 3]),
            ((b, a, c), [1, 0, 2]),
        ):
            self._faces.append(_Face(len(self._faces), corners, across, self._rows))
        used = set(first)
        inside = self._points[list(first)].sum(axis=0) / 4.0
        for face in self._present():
            self._look_out(face)
        while True:
            best = max(self._present(), key=lambda face: face.rise)
            if best.rise <= self._reach:
                return [face.corners for face in self._present()]
            point = best.far
            used.add(point)
            self._add(point, _row(inside))
            for face in reversed(self._present()):
                if face.far >= 0:
                    break
                self._look_out(face)
                if face.far in used:
                    face.far, face.rise = -1, 0.0

    def _present(self) -> list[_Face]:
        return [face for face in self._faces if face is not None]

    def _look_out(self, face: _Face) -> None:
        face.far = self._farthest(face.normal)
        face.rise = face.height(self._rows[face.far])

    def _add(self, point: int, inside: Vector3) -> None:
        for number in reversed(range(len(self._faces))):
            face = self._faces[number]
            if face is not None and face.height(self._rows[point]) > _ABOVE * self._reach:
                self._extrude(face, point)
        # Faces that are turned inside out, or without area, take the next one along with them.
        at = len(self._faces)
        while at:
            at -= 1
            face = self._faces[at]
            if face is None:
                continue
            if point not in face.corners:
                break
            inverted = face.height(inside) > _ABOVE * self._reach
            if inverted or face.area < self._reach * self._reach * _SLIM:
                beyond = self._faces[face.across[0]]
                assert beyond is not None
                self._extrude(beyond, point)
                at = len(self._faces)

    def _extrude(self, face: _Face, point: int) -> None:
        """Put three faces from a point to the sides of a face in its place; two back to back vanish."""
        first = len(self._faces)
        new = []
        for i in range(3):
            b, c = face.corners[(i + 1) % 3], face.corners[(i + 2) % 3]
            across = [face.across[i], first + (i + 1) % 3, first + (i + 2) % 3]
            new.append(_Face(first + i, (point, b, c), across, self._rows))
            self._faces.append(new[-1])
            beyond = self._at(face.across[i])
            beyond.across[beyond.side(b, c)] = first + i
        for one in new:
            beyond = self._at(one.across[0])
            if point in beyond.corners:
                self._remove_pair(one, beyond)
        self._faces[face.number] = None

    def _remove_pair(self, one: _Face, other: _Face) -> None:
        for i in range(3):
            a, b = one.corners[(i + 1) % 3], one.corners[(i + 2) % 3]
            behind_one, behind_other = (
                self._at(one.across[one.side(a, b)]),
                self._at(other.across[other.side(a, b)]),
            )
            behind_one.across[behind_one.side(a, b)] = behind_other.number
            behind_other.across[behind_other.side(a, b)] = behind_one.number
        self._faces[one.number] = self._faces[other.number] = None

    def _at(self, number: int) -> _Face:
        face = self._faces[number]
        assert face is not None
        return face

    def _first_corners(self) -> tuple[int, int, int, int] | None:
        """Corners of a tetrahedron to begin with, the right way round; None if there is none."""
        along = np.array((0.01, 0.02, 1.0))
        a, b = self._farthest(_row(along)), self._farthest(_row(-along))
        if a == b:
            return None
        line = self._points[a] - self._points[b]
        choices = np.cross((1.0, 0.02, 0.0), line), np.cross((-0.02, 1.0, 0.0), line)
        lengths = [_length(_row(v)) for v in choices]
        longer = 0 if lengths[0] > lengths[1] else 1
        c = self._farthest_either_way(choices[longer] / lengths[longer], (a, b))
        if c is None:
            return None
        across = np.cross(self._points[c] - self._points[a], line)
        d = self._farthest_either_way(across / _length(_row(across)), (a, b, c))
        if d is None:
            return None
        p = self._points
        turned = np.dot(p[d] - p[a], np.cross(p[b] - p[a], p[c] - p[a])) < 0.0
        return (a, b, d, c) if turned else (a, b, c, d)

    def _farthest_either_way(self, direction: Points, others: tuple[int, ...]) -> int | None:
        for way in (direction, -direction):
            point = self._farthest(_row(way))
            if point not in others:
                return point
        return None

    def _farthest(self, direction: Vector3) -> int:
        """The corner farthest along a direction. Points that are so for no direction nearby are left out."""
        u = _unit(_sideways(direction))
        v = _cross(u, direction)
        while True:
            point = int(self._farthest_of(np.array([direction]))[0])
            if self._certain[point]:
                return point
            sines, cosines = _TURNS
            around = self._farthest_of(_turned(direction, u, v, sines, cosines)).tolist()
            fine: list[int] = []
            for i in range(1, len(around)):
                before, after = around[i - 1], around[i]
                if before == after == point:
                    self._certain[point] = True
                    return point
                if before != after:
                    if not fine:
                        fine = self._farthest_of(_turned(direction, u, v, *_FINE_TURNS)).tolist()
                    steps = [before, *fine[(i - 1) * _FINE_PER_TURN + 1 : i * _FINE_PER_TURN + 1]]
                    if any(one == other == point for one, other in pairwise(steps)):
                        self._certain[point] = True
                        return point
            self._open[point] = False

    def _farthest_of(self, directions: Points) -> NDArray[np.intp]:
        """The open point farthest along each of many directions (n, 3)."""
        x, y, z = self._columns
        reach = directions[:, :1] * x + directions[:, 1:2] * y + directions[:, 2:] * z
        reach[:, ~self._open] = -np.inf
        return reach.argmax(axis=1)


def _turned(
    direction: Vector3,
    u: Vector3,
    v: Vector3,
    sines: NDArray[np.float64],
    cosines: NDArray[np.float64],
) -> Points:
    return np.array(direction) + np.outer(sines, u) + np.outer(cosines, v)


def _sideways(direction: Vector3) -> Vector3:
    x, y, z = direction
    return (y, -x, 0.0) if sqrt(y * y + x * x) > sqrt(z * z + x * x) else (-z, 0.0, x)


def _dot(a: Vector3, b: Vector3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _length(a: Vector3) -> float:
    return sqrt(_dot(a, a))


def _row(a: Points) -> Vector3:
    x, y, z = a.tolist()
    return x, y, z


def _minus(a: Vector3, b: Vector3) -> Vector3:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _cross(a: Vector3, b: Vector3) -> Vector3:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _unit(a: Vector3) -> Vector3:
    length = _length(a)
    return a[0] / length, a[1] / length, a[2] / length
