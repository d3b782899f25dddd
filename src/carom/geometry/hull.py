"""Convex hulls of points, by quickhull.

The point farthest from the present faces is always added next, so that stopping early gives a good hull with
few vertices. Sets of points that span no volume are given a small thickness.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.geometry.corner_order import Grid, corner_order
from carom.geometry.gridded import FLAT, LARGEST, ROUNDING, SMALLEST, first_corners, hull_on_grid
from carom.geometry.native_hull import COPLANAR, hull_loops
from carom.geometry.polyhedron import Polyhedron, polyhedron_of_loops
from carom.native.products import crosses, dots, length

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.geometry.corner_order import Ints

    Points = NDArray[np.float64]

EXACT = 1e-7
"""Relative error that single precision leaves in the points of mesh files."""

THICKEST_SLAB = 1e-4
"""Half thickness given to points that span no volume [m]; more only if they are more than 100 m apart."""

_SLAB = 1e-3
"""Half thickness given to points that span no volume, relative to their size."""


def convex_hull(
    points: Points,
    *,
    tolerance: float = EXACT,
    most_vertices: int | None = None,
    coplanar: float = COPLANAR,
) -> Polyhedron:
    """The convex hull of (n, 3) points; its vertices are some of them. Coplanar triangles are joined.

    Points may coincide, lie on a line or in a plane: then the hull is a slab around them, 0.2 mm thick or
    less; of points far apart, a millionth of their size. Those outside the hull by less than `tolerance`
    times its size are left out. It has at most `most_vertices`, at least 4; None for no limit.
    Triangles are in one plane up to `coplanar` times the size from it.

    Raises:
        ValueError: There are no points, one is not finite, or they are too far apart.
    """
    middle, centred, corners, counts = _hull_loops(points, tolerance, most_vertices, coplanar)
    return polyhedron_of_loops(centred, corners, counts).moved(middle)


def gridded_hull(
    points: Points, uses: Ints | None, *, tolerance: float, most_vertices: int | None
) -> Polyhedron:
    """The hull of (n, 3) points that have an extent along each axis, on PyBullet's grid and in its order.

    Coplanar points may not be coplanar on the grid, so the faces are those of the points themselves. `uses`
    are as of `corner_order`.

    Raises:
        ValueError: As by `convex_hull`.
    """
    made = hull_on_grid(points, uses, tolerance, len(points) if most_vertices is None else most_vertices)
    if made is not None:
        return made
    middle, centred, corners, counts = _hull_loops(points, tolerance, most_vertices)
    grid = Grid(points)
    _, ranks = corner_order(points, grid, uses)
    if len(centred) > len(points):
        # They lie in a plane and have been thickened: all are there several times.
        points, ranks = centred + middle, np.tile(ranks, len(centred) // len(points))
    return polyhedron_of_loops(grid.places(grid.cells(points)), corners, counts, ranks)


def extreme_points(points: Points) -> Points:
    """Those of (n, 3) points that are corners of their convex hull, without added thickness, (k, 3).

    Raises:
        ValueError: There are no points, or one is not finite.
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    _, _, corners, _ = _hull_loops(points, EXACT, None)
    # Thickening appends moved copies of all points.
    return points[np.unique(corners % len(points))]


def _hull_loops(
    points: Points, tolerance: float, most_vertices: int | None, coplanar: float = COPLANAR
) -> tuple[Points, Points, NDArray[np.int32], NDArray[np.int32]]:
    """Centre of the bounds, points relative to it, their indices around all faces, and how many each has."""
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
    corners = first_corners(centred, FLAT * size)
    if len(corners) < 4:
        centred = _thickened(centred, corners, size)
        size = float(np.abs(centred).max())
        corners = first_corners(centred, 0.0)
    a, b, c, d = corners
    p = centred[corners]
    if dots(crosses(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) > 0.0:
        b, c = c, b
    loops, counts = hull_loops(
        np.ascontiguousarray(centred),
        (a, b, c, d),
        size,
        rounding=ROUNDING * size,
        tolerance=tolerance * size,
        most_vertices=most_vertices,
        coplanar=coplanar * size,
    )
    return middle, centred, loops, counts


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


def hull_triangles(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The convex hull of points (n, 3): vertices (k, 3) and triangles (m, 3)."""
    hull = convex_hull(points)
    triangles = []
    for first, count in zip(hull.first_corner, hull.corner_count, strict=True):
        loop = hull.corners[first : first + count]
        triangles += [(loop[0], loop[k], loop[k + 1]) for k in range(1, count - 1)]
    return hull.vertices, np.array(triangles, np.int32)
