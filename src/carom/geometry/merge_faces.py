"""Joining coplanar triangles of a convex hull to polygons."""

from __future__ import annotations

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from carom.native.products import dots

COPLANAR = 1e-5
"""Distance from a plane, relative to the size of the hull, up to which a vertex counts as in the plane."""

LEAST_FACES = 4
"""Fewest faces that can enclose a volume."""

_PARALLEL = 0.999
"""Least cosine between the normals of triangles that are joined."""


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
    return merged if len(merged) >= LEAST_FACES else [list(triangle) for triangle in triangles]


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
