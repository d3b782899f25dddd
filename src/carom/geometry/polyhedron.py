"""Vertices and faces of a solid or of a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.native.products import crosses, dots

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int32]


class Polyhedron:
    """Flat faces around a solid, or the triangles of a surface. The arrays are read-only.

    Attributes:
        vertices: (n, 3) positions [m].
        planes: (m, 4) planes of the faces: a unit normal that points out, and n · x on the plane.
        first_corner: (m,) index in `corners` of the first corner of each face.
        corner_count: (m,) number of corners of each face.
        corners: Indices into `vertices`, counter-clockwise around each face as seen from outside.
    """

    __slots__ = ("corner_count", "corners", "first_corner", "planes", "vertices")

    def __init__(
        self, vertices: Floats, planes: Floats, first_corner: Ints, corner_count: Ints, corners: Ints
    ) -> None:
        self.vertices = vertices
        self.planes = planes
        self.first_corner = first_corner
        self.corner_count = corner_count
        self.corners = corners
        for array in (vertices, planes, first_corner, corner_count, corners):
            array.setflags(write=False)

    def bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest corner of the box around the vertices, shape (3,) each."""
        return self.vertices.min(axis=0), self.vertices.max(axis=0)

    def moved(self, offset: Floats) -> Polyhedron:
        """The same shape, every vertex moved by `offset`."""
        planes = self.planes.copy()
        planes[:, 3] += dots(planes[:, :3], offset)
        return Polyhedron(self.vertices + offset, planes, self.first_corner, self.corner_count, self.corners)

    def following(self) -> Ints:
        """For each of `corners` the one after it around its face."""
        places = np.arange(1, len(self.corners) + 1)
        places[self.first_corner + self.corner_count - 1] = self.first_corner
        return self.corners[places]

    def with_vertices(self, vertices: Floats) -> Polyhedron:
        """The same faces with slightly moved vertices, (n, 3)."""
        return polyhedron(vertices, self.first_corner, self.corner_count, self.corners)


def polyhedron(
    vertices: Floats,
    first_corner: Ints,
    corner_count: Ints,
    corners: Ints,
) -> Polyhedron:
    """A polyhedron whose planes are computed from its corners; see `Polyhedron`."""
    planes = _planes(vertices, corners, first_corner, corner_count)
    return Polyhedron(vertices, planes, first_corner, corner_count, corners)


def polyhedron_of_loops(
    vertices: Floats, corners: Ints, counts: Ints, ranks: Ints | None = None
) -> Polyhedron:
    """A polyhedron from the corners of its faces; vertices (n, 3) that no face uses are left out.

    `corners` are those of all faces, one after the other, and `counts` the number of corners of each. They go
    around a face counter-clockwise from outside, nearly in one plane. Those that are left are in the
    order of `ranks` (n,), or as they were.
    """
    # A table of places: np.unique takes several times as long for a small hull, of which files have dozens.
    is_used = np.zeros(len(vertices), dtype=bool)
    is_used[corners] = True
    used = is_used.nonzero()[0]
    if ranks is not None:
        used = used[ranks[used].argsort(kind="stable")]
    places = np.empty(len(vertices), dtype=np.int32)
    places[used] = np.arange(len(used), dtype=np.int32)
    kept = np.ascontiguousarray(vertices[used], dtype=np.float64)
    renamed = places[corners]
    firsts = (np.cumsum(counts) - counts).astype(np.int32)
    return polyhedron(kept, firsts, counts, renamed)


def polyhedron_of_triangles(vertices: Floats, triangles: NDArray[np.integer]) -> Polyhedron:
    """Triangles (m, 3) of a surface, counter-clockwise from outside.

    Equal vertices become one, triangles without area vanish.
    """
    positions, merged = _distinct(vertices)
    corners = merged[triangles]
    a, b, c = (positions[corners[:, side]] for side in range(3))
    spread = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.maximum.reduce([np.linalg.norm(b - a, axis=1), np.linalg.norm(c - a, axis=1)])
    solid = spread > _THIN * longest * longest
    corners = corners[solid]
    used, renamed = np.unique(corners, return_inverse=True)
    count = len(corners)
    positions = positions[used]
    flat = renamed.reshape(-1).astype(np.int32)
    firsts = np.arange(0, 3 * count, 3, dtype=np.int32)
    counts = np.full(count, 3, dtype=np.int32)
    return polyhedron(positions, firsts, counts, flat)


def _distinct(rows: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """The distinct rows, sorted, and the index of each row in them; many times faster than np.unique."""
    order = np.lexsort(rows.T)
    arranged = rows[order]
    is_first = np.ones(len(rows), dtype=bool)
    is_first[1:] = (arranged[1:] != arranged[:-1]).any(axis=1)
    which = np.empty(len(rows), dtype=np.int64)
    which[order] = np.cumsum(is_first) - 1
    return arranged[is_first], which


_BLOCK = 8192
_THIN = 1e-12
"""Twice the area of a triangle divided by the square of a side, below which it counts as a line."""


def _planes(
    vertices: Floats,
    corners: Ints,
    firsts: Ints,
    counts: Ints,
) -> Floats:
    """Best planes of polygons: normals by Newell's sum, offsets so that no corner lies outside."""
    if not len(firsts):
        return np.empty((0, 4))
    if (counts == 3).all():
        return _triangle_planes(vertices, corners)
    normals = _doubled_areas(vertices, corners, firsts, counts)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    heights = dots(vertices[corners], np.repeat(normals, counts, axis=0))
    return np.column_stack([normals, np.maximum.reduceat(heights, firsts)])


def _doubled_areas(
    vertices: Floats,
    corners: Ints,
    firsts: Ints,
    counts: Ints,
) -> Floats:
    """Normals of polygons by Newell's sums, (m, 3); their lengths are twice the areas."""
    following = np.arange(1, len(corners) + 1)
    following[firsts + counts - 1] = firsts
    # Relative to the first corner: products of large coordinates would lose the digits of small faces.
    anchor = np.repeat(vertices[corners[firsts]], counts, axis=0)
    here = vertices[corners] - anchor
    there = vertices[corners[following]] - anchor
    return np.add.reduceat(crosses(here, there), firsts, axis=0)


def _triangle_planes(vertices: Floats, corners: Ints) -> Floats:
    """Planes of triangles, from the indices of their corners, (3 m,).

    Coordinate by coordinate, and a block at a time that fits into a cache: with vectors as rows, or all at
    once, the same takes several times as long.
    """
    places = [np.ascontiguousarray(vertices[:, axis]) for axis in range(3)]
    triangles = corners.reshape(-1, 3)
    planes = np.empty((len(triangles), 4))
    for first in range(0, len(triangles), _BLOCK):
        block = slice(first, first + _BLOCK)
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (
            [place[corner] for place in places] for corner in np.ascontiguousarray(triangles[block].T)
        )
        ux, uy, uz = bx - ax, by - ay, bz - az
        vx, vy, vz = cx - ax, cy - ay, cz - az
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        size = np.sqrt(x * x + y * y + z * z)
        x, y, z = x / size, y / size, z / size
        heights = [px * x + py * y + pz * z for px, py, pz in ((ax, ay, az), (bx, by, bz), (cx, cy, cz))]
        planes[block, 0], planes[block, 1], planes[block, 2] = x, y, z
        planes[block, 3] = np.maximum(np.maximum(heights[0], heights[1]), heights[2])
    return planes
