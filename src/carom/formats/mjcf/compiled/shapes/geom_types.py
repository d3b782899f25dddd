"""Types of geoms whose sizes files state: primitives and ellipsoids."""

from __future__ import annotations

from carom.description import ConvexHull, Geometry
from carom.description.geometry import BY_MJCF
from carom.description.pose import Vector3
from carom.formats.mjcf.compiled.shapes.ellipsoid import ellipsoid_points

ELLIPSOID = "ellipsoid"
SIZES: dict[str, int] = {kind: it.size_count for kind, it in BY_MJCF.items()} | {ELLIPSOID: 3}
"""How many sizes a file states of a type."""


def primitive(kind: str, size: Vector3) -> Geometry:
    """The shape of a geom of a type by its sizes [m]."""
    if kind in BY_MJCF:
        return BY_MJCF[kind].of_sizes(*size)
    return ConvexHull(ellipsoid_points(size), margin=0.0, half_axes=size)


def half_extents(kind: str, size: Vector3) -> Vector3:
    """Half extents of a geom of a type; of others what files state, which is 0 for meshes and terrain."""
    if kind in BY_MJCF:
        return BY_MJCF[kind].of_sizes(*size).bounds(implicit_cylinder=True).half
    return size
