"""Convex hulls of points, by quickhull.

The point farthest from the present faces is always added next, so that stopping early gives a good hull with
few vertices. Sets of points that span no volume are given a small thickness.
"""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from carom.geometry.merge_faces import merged_loops
from carom.geometry.polyhedron import Polyhedron, polyhedron_of_loops
from carom.native.products import dots, length, product
from carom.record import record

Points = NDArray[np.float64]
Triangle = tuple[int, int, int]

ROUNDING = 1e-9
"""Height above a face below which a point counts as lying on it, relative to the size of the hull."""

EXACT = 1e-7
"""Relative error that single precision leaves in the points of mesh files."""

SMALLEST, LARGEST = 1e-60, 1e70
"""Sizes below which points coincide and above which they are refused: squares of areas stay in range [m]."""

FLAT = 1e-6
"""Relative thickness below which points count as lying in a plane, on a line or in one point."""

THICKEST_SLAB = 1e-4
"""Half thickness given to points that span no volume [m]; more only if they are more than 100 m apart."""

_SLAB = 1e-3
"""Half thickness given to points that span no volume, relative to their size."""


def convex_hull(points: Points, *, tolerance: float = EXACT, most_vertices: int | None = None) -> Polyhedron:
    """The convex hull of (n, 3) points; its vertices are some of them. Coplanar triangles are joined.

    Points may coincide, lie on a line or in a plane: then the hull is a slab around them, 0.2 mm thick or
    less; of points far apart, a millionth of their size. Those outside the hull by less than `tolerance`
    times its size are left out. It has at most `most_vertices`, at least 4; None for no limit.

    Raises:
        ValueError: There are no points, one is not finite, or they are too far apart.
    """
    middle, centred, loops = _hull_loops(points, tolerance, most_vertices)
    return polyhedron_of_loops(centred, loops).moved(middle)


def extreme_points(points: Points) -> Points:
    """Those of (n, 3) points that are corners of their convex hull, without added thickness, (k, 3).

    Raises:
        ValueError: There are no points, or one is not finite.
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    _, _, loops = _hull_loops(points, EXACT, None)
    # Thickening appends moved copies of all points.
    return points[sorted({corner % len(points) for loop in loops for corner in loop})]


def _hull_loops(
    points: Points, tolerance: float, most_vertices: int | None
) -> tuple[Points, Points, list[list[int]]]:
    """Centre of the bounds, points relative to it, and their indices around each face of the hull."""
    points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    if not len(points):
        raise ValueError("a convex hull needs points")
    if not np.isfinite(points).all():
        raise ValueError("a point is not finite")
    # Far from the origin, coordinates would lose digits.
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    centred = points - middle
    size = float(np.abs(centred).max())
    if not size < LARGEST:
        raise ValueError(f"points {size:g} m apart are too far apart for a hull")
    if size < SMALLEST:
        centred, size = np.zeros_like(centred), 0.0
    corners = _first_corners(centred, FLAT * size)
    if len(corners) < 4:
        centred = _thickened(centred, corners, size)
        size = float(np.abs(centred).max())
        corners = _first_corners(centred, 0.0)
    hull = _Quickhull(centred, corners, size)
    hull.grow(tolerance * size, most_vertices)
    triangles = [face.corners for face in hull.faces.values()]
    return middle, centred, merged_loops(centred, triangles, size)


def _first_corners(points: Points, thin: float) -> list[int]:
    """Four points that span a volume, or fewer if all lie in a plane, on a line or in one point."""
    axis = int(np.ptp(points, axis=0).argmax())
    first = int(points[:, axis].argmin())
    away = points - points[first]
    distances = np.linalg.norm(away, axis=1)
    second = int(distances.argmax())
    if distances[second] <= thin or distances[second] == 0.0:
        return [first]
    along = away[second] / distances[second]
    aside = away - np.outer(dots(away, along), along)
    distances = np.linalg.norm(aside, axis=1)
    third = int(distances.argmax())
    if distances[third] <= thin:
        return [first, second]
    normal = np.cross(along, aside[third])
    normal /= length(normal)
    heights = dots(away, normal)
    fourth = int(np.abs(heights).argmax())
    if abs(heights[fourth]) <= thin:
        return [first, second, third]
    return [first, second, third, fourth]


def _thickened(points: Points, corners: list[int], size: float) -> Points:
    """The points moved both ways along every direction in which they have no extent."""
    half = max(min(THICKEST_SLAB, _SLAB * size), FLAT * size) if size > 0.0 else THICKEST_SLAB
    spanned = points[corners[1:]] - points[corners[0]]
    for direction in _directions_beside(spanned):
        points = np.concatenate([points - half * direction, points + half * direction])
    return points


def _directions_beside(spanned: Points) -> list[Points]:
    """Unit vectors at right angles to each other and to up to two vectors, which are not parallel."""
    if len(spanned) == 0:
        return list(np.eye(3))
    if len(spanned) == 2:
        normal = np.cross(*spanned)
        return [normal / length(normal)]
    (along,) = spanned / length(spanned[0])
    aside = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    aside /= length(aside)
    return [aside, np.cross(along, aside)]


@record(frozen=False, eq=False)
class _Face:
    """A triangle of the growing hull.

    Attributes:
        corners: Counter-clockwise from outside.
        plane: Outward unit normal and offset.
        neighbours: Face across the edge from each corner to the next.
        outside: Points above this face, each kept by one face only.
        farthest: The one of these with the greatest height above the face.
        height: Its height.
    """

    corners: Triangle
    plane: tuple[float, float, float, float]
    neighbours: list[int]
    outside: NDArray[np.int64]
    farthest: int = -1
    height: float = 0.0


class _Quickhull:
    """A hull that grows point by point from a tetrahedron."""

    def __init__(self, points: Points, corners: list[int], size: float) -> None:
        self.points = points
        self.rounding = ROUNDING * size
        self.faces: dict[int, _Face] = {}
        self._count = 0
        self._pending: list[tuple[float, int]] = []
        a, b, c, d = corners
        p = points[corners]
        if dots(np.cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) > 0.0:
            b, c = c, b
        triangles = [(a, b, c), (a, c, d), (c, b, d), (b, a, d)]
        numbers = self._add(triangles, np.arange(len(points)))
        edges = {edge: n for n in numbers for edge in _edges(self.faces[n].corners)}
        for number in numbers:
            face = self.faces[number]
            face.neighbours = [edges[end, start] for start, end in _edges(face.corners)]

    def grow(self, tolerance: float, most_vertices: int | None) -> None:
        """Add the farthest point again and again, until all are within `tolerance` or enough are added."""
        left = len(self.points) if most_vertices is None else most_vertices - 4
        while left > 0 and self._pending:
            height, number = heapq.heappop(self._pending)
            if -height <= max(tolerance, self.rounding):
                return
            face = self.faces.get(number)
            if face is None:
                continue
            if self._take_in(number, face):
                left -= 1
            else:
                self._leave_out(number, face)

    def _take_in(self, number: int, face: _Face) -> bool:
        """Add a face's farthest point: replace the faces visible from it by a fan of faces to it.

        Returns:
            Whether this was possible despite rounding errors.
        """
        eye = face.farthest
        x, y, z = self.points[eye].tolist()
        for grazing in (self.rounding, -self.rounding):
            seen, rim = self._seen(number, (x, y, z), grazing)
            loop = _loop(rim)
            if loop is not None:
                break
        else:
            return False
        orphans = np.concatenate([self.faces[n].outside for n in seen])
        for n in seen:
            del self.faces[n]
        triangles = [(start, end, eye) for start, end, _ in loop]
        new = self._add(triangles, orphans[orphans != eye])
        for i, (number, (start, end, beyond)) in enumerate(zip(new, loop, strict=True)):
            self.faces[number].neighbours = [beyond, new[(i + 1) % len(new)], new[i - 1]]
            outer = self.faces[beyond]
            outer.neighbours[_edges(outer.corners).index((end, start))] = number
        return True

    def _seen(
        self, first: int, eye: tuple[float, float, float], grazing: float
    ) -> tuple[list[int], dict[int, tuple[int, int]]]:
        """Faces visible from a point, and the edges of their horizon with the face beyond each."""
        x, y, z = eye
        seen, rim = [first], {}
        known = {first: True}
        for number in seen:
            face = self.faces[number]
            for (start, end), beyond in zip(_edges(face.corners), face.neighbours, strict=True):
                below = known.get(beyond)
                if below is None:
                    a, b, c, d = self.faces[beyond].plane
                    below = known[beyond] = a * x + b * y + c * z - d > grazing
                    if below:
                        seen.append(beyond)
                if not below:
                    if start in rim:
                        return seen, {}
                    rim[start] = (end, beyond)
        return seen, rim

    def _leave_out(self, number: int, face: _Face) -> None:
        """Drop a face's farthest point, which cannot be added because of rounding errors."""
        face.outside = face.outside[face.outside != face.farthest]
        self._rank(number, face)

    def _add(self, triangles: list[Triangle], candidates: NDArray[np.int64]) -> list[int]:
        """Add faces and return their numbers; the candidates above a face become its outside points."""
        corners = self.points[np.array(triangles)]
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        normals = _crossed(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0.0)
        offsets = dots(normals, corners.mean(axis=1))
        heights = product(self.points[candidates], normals.T) - offsets
        owners = heights.argmax(axis=1)
        highest = heights[np.arange(len(candidates)), owners]
        is_outside = highest > self.rounding
        candidates, owners = candidates[is_outside], owners[is_outside]
        numbers = []
        planes = np.column_stack([normals, offsets]).tolist()
        for i, (triangle, (nx, ny, nz, offset)) in enumerate(zip(triangles, planes, strict=True)):
            face = _Face(triangle, (nx, ny, nz, offset), [], candidates[owners == i])
            self.faces[self._count] = face
            self._rank(self._count, face)
            numbers.append(self._count)
            self._count += 1
        return numbers

    def _rank(self, number: int, face: _Face) -> None:
        """Find the farthest point of a face and put the face in the queue."""
        if not len(face.outside):
            return
        *normal, offset = face.plane
        heights = dots(self.points[face.outside], np.array(normal)) - offset
        best = int(heights.argmax())
        face.farthest, face.height = int(face.outside[best]), float(heights[best])
        heapq.heappush(self._pending, (-face.height, number))


def _crossed(a: Points, b: Points) -> Points:
    """Cross products row by row; NumPy's function takes three times as long for a few rows."""
    result = np.empty_like(a)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return result


def _edges(corners: Triangle) -> list[tuple[int, int]]:
    a, b, c = corners
    return [(a, b), (b, c), (c, a)]


def _loop(rim: dict[int, tuple[int, int]]) -> list[tuple[int, int, int]] | None:
    """The edges of a horizon in order as (start, end, face beyond); None if they are not a single loop."""
    if len(rim) < 3:
        return None
    loop = []
    start = first = next(iter(rim))
    for _ in rim:
        if start not in rim:
            return None
        end, beyond = rim[start]
        loop.append((start, end, beyond))
        start = end
        if end == first:
            break
    return loop if len(loop) == len(rim) and start == first else None
