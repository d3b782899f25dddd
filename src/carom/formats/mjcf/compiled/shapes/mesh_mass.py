"""Volume, centre of mass and inertia of triangle meshes, in each of the ways that MJCF knows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from carom.description.shapes.moments import MassShape
from carom.native.products import crosses, dots

Points = NDArray[np.float64]
Triangles = NDArray[np.int32]
Hull = Callable[[Points], tuple[Points, Triangles]]
"""Makes the convex hull of points (n, 3): vertices and triangles of it, counter-clockwise from outside."""

WAYS = ("convex", "exact", "legacy", "shell")
_LEAST = 1e-14


def mass_of_mesh(vertices: Points, triangles: Triangles, way: str, hull: Hull) -> MassShape | None:
    """The distribution of mass in a mesh with vertices (n, 3) and triangles (m, 3).

    `exact` takes the volume inside; `legacy` adds up all pyramids over triangles, as if those inside out
    were not; `shell` spreads the mass over the triangles; `convex` takes the convex hull. The apex of the
    pyramids is the centre of the surface. `hull` makes convex hulls. None if there is no volume or area.
    """
    if way == "convex":
        vertices, triangles = hull(vertices)
        way = "exact"
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = crosses(b - a, c - a)
    areas = 0.5 * np.sqrt((normals * normals).sum(axis=1))
    area = float(areas.sum())
    if area < _LEAST:
        return None
    middles = (a + b + c) / 3.0
    surface = (areas[:, None] * middles).sum(axis=0) / area
    if way == "shell":
        return MassShape(area, surface, _tensor(_second_of_triangles(a, b, c, areas, surface) / area))
    volumes = _pyramids(a, b, c, surface, way)
    volume = float(volumes.sum())
    if abs(volume) < _LEAST:
        return None
    centre = (volumes[:, None] * (0.75 * middles + 0.25 * surface)).sum(axis=0) / volume
    # Of pyramids whose apex is the centre of mass: it matters for meshes that are not closed.
    around = _pyramids(a, b, c, centre, way)
    a, b, c = a - centre, b - centre, c - centre
    total = a + b + c
    second = sum(
        (around[:, None, None] / 20.0 * p[:, :, None] * p[:, None, :]).sum(axis=0) for p in (a, b, c, total)
    )
    volume = float(around.sum())
    return MassShape(volume, centre, _tensor(np.asarray(second) / volume))


def mass_enclosed(corners: Points, least_volume: float) -> MassShape | None:
    """The distribution of mass in what triangles (n, 3, 3) enclose, by pyramids on them from the origin.

    None where that is less than a volume [m³].
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    volumes = dots(a, crosses(b, c)) / 6.0
    volume = float(volumes.sum())
    if abs(volume) < least_volume:
        return None
    total = a + b + c
    centre = (volumes[:, None] * total).sum(axis=0) / (4.0 * volume)
    squares = sum(p[:, :, None] * p[:, None, :] for p in (a, b, c, total))
    second = (volumes[:, None, None] * squares).sum(axis=0) / (20.0 * volume)
    return MassShape(abs(volume), centre, _tensor(second - np.outer(centre, centre)))


def _pyramids(a: Points, b: Points, c: Points, apex: Points, way: str) -> Points:
    a, b, c = a - apex, b - apex, c - apex
    volumes = (a * crosses(b, c)).sum(axis=1) / 6.0
    return np.abs(volumes) if way == "legacy" else volumes


def _second_of_triangles(a: Points, b: Points, c: Points, areas: Points, centre: Points) -> Points:
    """Second moments (3, 3) of mass on triangles about a centre."""
    a, b, c = a - centre, b - centre, c - centre
    parts = (a, b, c, a + b + c)
    return np.asarray(
        sum((areas[:, None, None] / 12.0 * p[:, :, None] * p[:, None, :]).sum(axis=0) for p in parts)
    )


def _tensor(second: Points) -> Points:
    """Tensor of inertia (3, 3) of second moments (3, 3)."""
    return np.trace(second) * np.eye(3) - second
