"""Spheres, cylinders and capsules as PyBullet's images show them.

They are not round there: each is the hull of its farthest points along 42 directions; a capsule is no more
than the tips and the rims of its shaft. Textures and normals go by the direction from the middle.
"""

from __future__ import annotations

import functools
from math import pi

import numpy as np
from numpy.typing import NDArray

from carom.description import Geometry
from carom.description.shapes.shape import UPRIGHT
from carom.formats.visuals.render_mesh import RenderMesh, mesh_of, unit_vectors
from carom.native.trigonometry import atan2
from carom.render.meshes import shape_mesh
from carom.render.sampled_hull import sampled_hull

_MARGIN = 1e-3
"""Cylinders and capsules are thicker by this much [m]."""

# Millionths: the corners of an icosahedron and the middles of its sides, in PyBullet's order and rounding.
# Directions that are level ask for the upper rim, because it comes first.
_DIRECTIONS = (
    (0, 0, -1000000), (723608, -525725, -447219), (-276388, -850649, -447219), (-894426, 0, -447216),
    (-276388, 850649, -447220), (723608, 525725, -447219), (276388, -850649, 447220),
    (-723608, -525725, 447219), (-723608, 525725, 447219), (276388, 850649, 447219), (894426, 0, 447216),
    (0, 0, 1000000), (425323, -309011, -850654), (-162456, -499995, -850654), (262869, -809012, -525738),
    (425323, 309011, -850654), (850648, 0, -525736), (-525730, 0, -850652), (-688190, -499997, -525736),
    (-162456, 499995, -850654), (-688190, 499997, -525736), (262869, 809012, -525738), (951058, 309013, 0),
    (951058, -309013, 0), (587786, -809017, 0), (0, -1000000, 0), (-587786, -809017, 0),
    (-951058, -309013, 0), (-951058, 309013, 0), (-587786, 809017, 0), (0, 1000000, 0), (587786, 809017, 0),
    (688190, -499997, 525736), (-262869, -809012, 525738), (-850648, 0, 525736), (-262869, 809012, 525738),
    (688190, 499997, 525736), (525730, 0, 850652), (162456, -499995, 850654), (-425323, -309011, 850654),
    (-425323, 309011, 850654), (162456, 499995, 850654),
)  # fmt: skip


def mesh_in_pybullet(shape: Geometry) -> RenderMesh | None:
    """The triangles of a shape as PyBullet's images show it, in its frame; None if they are the usual."""
    form = shape.in_bullets_images()
    if isinstance(form, float):
        ball = _ball()
        return RenderMesh(ball.positions * np.float32(form), ball.normals, ball.uvs, ball.triangles)
    if form is not None:
        return _rounded(shape)
    return _flat(shape) if shape.own_turn() != UPRIGHT else None


@functools.lru_cache(maxsize=1024)
def _rounded(shape: Geometry) -> RenderMesh:
    directions = np.array(_DIRECTIONS) * 1e-6
    corners = shape.in_bullets_images()
    assert isinstance(corners, np.ndarray), "a ball has no corners"
    x, y, z = corners.T
    reach = directions[:, :1] * x + directions[:, 1:2] * y + directions[:, 2:] * z
    return _mesh(corners[reach.argmax(axis=1)] + _MARGIN * unit_vectors(directions))


@functools.cache
def _ball() -> RenderMesh:
    """The ball with a radius of 1."""
    return _mesh(unit_vectors(np.array(_DIRECTIONS) * 1e-6))


def _mesh(points: NDArray[np.float64]) -> RenderMesh:
    """The hull of points; seen from its origin, its corners give normals and texture coordinates."""
    positions, triangles = sampled_hull(points)
    normals = unit_vectors(positions)
    turns = [atan2(x, z) / (2.0 * pi) + 0.5 for x, _, z in normals.tolist()]
    return mesh_of(positions, normals, np.column_stack([turns, normals[:, 1] * 0.5 + 0.5]), triangles)


@functools.lru_cache(maxsize=64)
def _flat(plane: Geometry) -> RenderMesh:
    """A plane's square, pressed flat onto z = 0: nothing is left of an upright one."""
    mesh = shape_mesh(plane)
    return mesh_of(mesh.positions * (1.0, 1.0, 0.0), [(0.0, 0.0, 1.0)] * 4, mesh.uvs, mesh.triangles)
