"""Triangle meshes of primitive shapes, as they are drawn."""

from __future__ import annotations

import functools

import numpy as np

from carom.description.shapes.shape import Shape
from carom.formats.visuals.render_mesh import RenderMesh

SEGMENTS = 48
"""Sides of the polygon that approximates a circle; its edges deviate by at most 0.2 % of the radius."""


@functools.lru_cache(maxsize=1024)
def primitive_mesh(shape: Shape, segments: int = SEGMENTS) -> RenderMesh:
    """The triangles of a primitive, in its frame; circles have `segments` sides, a multiple of 4."""
    positions, normals, uvs, triangles = shape.surface(segments)
    # They are in single precision; `asarray` does not copy what is.
    return RenderMesh(
        np.asarray(positions, np.float32),
        np.asarray(normals, np.float32),
        np.asarray(uvs, np.float32),
        np.asarray(triangles, np.int32),
    )
