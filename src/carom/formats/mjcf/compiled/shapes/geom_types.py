"""Types of geoms whose sizes files state: primitives."""

from __future__ import annotations

from carom.description.geometry import BY_MJCF
from carom.description.pose import Vector3

SIZES: dict[str, int] = {kind: it.size_count for kind, it in BY_MJCF.items()}
"""How many sizes a file states of a type."""


def half_extents(kind: str, size: Vector3) -> Vector3:
    """Half extents of a geom of a type; of others what files state, which is 0 for meshes and terrain."""
    if kind in BY_MJCF:
        return BY_MJCF[kind].of_sizes(*size).bounds(implicit_cylinder=True).half
    return size
