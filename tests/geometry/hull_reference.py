"""Quickhull as plain Python: what the native one must give, corner by corner."""

from __future__ import annotations

import heapq
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.geometry.hull import ROUNDING
from carom.geometry.native_hull import COPLANAR, MIN_FACES
from carom.native.products import dots, product

Points = NDArray[np.float64]
Triangle = tuple[int, int, int]

_PARALLEL = 0.999


def reference_loops(
    points: Points, corners: list[int], size: float, tolerance: float, most_vertices: int | None
) -> list[list[int]]:
    """The faces of the hull of points around the origin, grown from four of them."""
    hull = _Quickhull(points, corners, size)
    hull.grow(tolerance * size, most_vertices)
    return merged_loops(points, [face.corners for face in hull.faces.values()], size)


@dataclass(eq=False, slots=True)
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


def merged_loops(
    vertices: NDArray[np.float64], triangles: list[tuple[int, int, int]], size: float
) -> list[list[int]]:
    """Joins the triangles of a closed convex surface of this size that lie in one plane.

    Triangles, and the polygons that are returned, are vertex indices, counter-clockwise from outside.
    Vertices in the middle of an edge are left out.
    """
    corners = np.array(triangles)
    a, b, c = (vertices[corners[:, side]] for side in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(areas, np.finfo(float).tiny)[:, None]
    owner = {
        (triangle[i], triangle[(i + 1) % 3]): number
        for number, triangle in enumerate(triangles)
        for i in range(3)
    }
    loops: list[list[int]] = []
    free = [True] * len(triangles)
    thin = COPLANAR * size

    def patch(seed: int) -> list[int]:
        """Take the free triangles that are connected to a seed and lie in its plane."""
        normal, origin = normals[seed], vertices[triangles[seed][0]]
        group = [seed]
        free[seed] = False
        for number in group:
            x, y, z = triangles[number]
            for edge in ((y, x), (z, y), (x, z)):
                other = owner[edge]
                if not free[other]:
                    continue
                # The two corners on the edge are in the plane already.
                (apex,) = set(triangles[other]).difference(edge)
                is_parallel = areas[other] <= thin * thin or dots(normals[other], normal) > _PARALLEL
                if is_parallel and abs(dots(vertices[apex] - origin, normal)) <= thin:
                    free[other] = False
                    group.append(other)
        return group

    # Largest triangles first: their normals are the most accurate, and slivers join them.
    for seed in np.argsort(-areas, kind="stable").tolist():
        if not free[seed]:
            continue
        group = patch(seed)
        loop = _outline([triangles[number] for number in group])
        if loop is None:
            loops.extend(list(triangles[number]) for number in group)
        else:
            loops.append(loop)
    merged = _without_middles(loops)
    # A shape thinner than the tolerance would lose its faces.
    return merged if len(merged) >= MIN_FACES else [list(triangle) for triangle in triangles]


def _outline(group: list[tuple[int, int, int]]) -> list[int] | None:
    """The boundary loop of triangles that share edges; None if there are holes or they touch in a point."""
    edges = {(t[i], t[(i + 1) % 3]) for t in group for i in range(3)}
    rim = [(start, end) for start, end in edges if (end, start) not in edges]
    following = dict(rim)
    if not rim or len(following) != len(rim):
        return None
    # Begin with the smallest index, so that the same triangles always give the same loop.
    loop = [min(following)]
    while following[loop[-1]] != loop[0]:
        loop.append(following[loop[-1]])
        if len(loop) > len(following):
            return None
    return loop if len(loop) == len(following) else None


def _without_middles(loops: list[list[int]]) -> list[list[int]]:
    """Leave out vertices that belong to only two faces: they lie on the edge between these."""
    uses = Counter(vertex for loop in loops for vertex in loop)
    kept = [[vertex for vertex in loop if uses[vertex] > 2] for loop in loops]
    return [loop for loop in kept if len(loop) >= 3]
