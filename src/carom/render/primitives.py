"""Triangle meshes of boxes, spheres, cylinders, capsules and planes."""

from __future__ import annotations

import functools
from math import hypot

import numpy as np
from numpy.typing import NDArray

from carom.description import Box, Capsule, Cylinder, Plane, Sphere
from carom.description.pose import Vector3
from carom.formats.visuals.render_mesh import RenderMesh, mesh_of
from carom.native.trigonometry import cos, sin

SEGMENTS = 48
"""Sides of the polygon that approximates a circle; its edges deviate by at most 0.2 % of the radius."""

PLANE_HALF_SIZE = 128.0
"""A plane is drawn as a square whose side is twice this length [m]."""

_X, _Y, _UP = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

Primitive = Sphere | Box | Cylinder | Capsule | Plane


@functools.lru_cache(maxsize=1024)
def primitive_mesh(shape: Primitive, segments: int = SEGMENTS) -> RenderMesh:
    """The triangles of a primitive, in its frame; circles have `segments` sides, a multiple of 4."""
    if isinstance(shape, Box):
        return _box(shape.half_extents)
    if isinstance(shape, Plane):
        return _plane(shape.normal, shape.size)
    if isinstance(shape, Cylinder):
        return _cylinder(shape.radius, shape.length, segments)
    return _rounded(shape.radius, 0.0 if isinstance(shape, Sphere) else shape.length, segments)


def _moved(mesh: RenderMesh, positions: NDArray[np.floating]) -> RenderMesh:
    """A mesh with other positions. `dataclasses.replace` would compile the class's methods first."""
    return RenderMesh(positions.astype(np.float32), mesh.normals, mesh.uvs, mesh.triangles)


# Each side of a box: its outward normal, two axes along the side with u × v = normal, and the texture
# coordinates of its corners (-u, -v), (u, -v), (u, v) and (-u, v). One image wraps around all sides, as in
# PyBullet.
_BOX_SIDES: tuple[tuple[Vector3, Vector3, Vector3, tuple[tuple[float, float], ...]], ...] = (
    ((0, 0, 1), (1, 0, 0), (0, 1, 0), ((0.75, 0.25), (1.0, 0.25), (1.0, 0.0), (0.75, 0.0))),
    ((0, 0, -1), (-1, 0, 0), (0, 1, 0), ((0.25, 0.25), (0.5, 0.25), (0.5, 0.0), (0.25, 0.0))),
    ((-1, 0, 0), (0, 0, 1), (0, 1, 0), ((0.5, 0.0), (0.5, 0.25), (0.75, 0.25), (0.75, 0.0))),
    ((1, 0, 0), (0, 0, -1), (0, 1, 0), ((0.0, 0.5), (0.25, 0.5), (0.25, 0.25), (0.0, 0.25))),
    ((0, -1, 0), (0, 0, 1), (-1, 0, 0), ((0.5, 0.5), (0.5, 0.25), (0.25, 0.25), (0.25, 0.5))),
    ((0, 1, 0), (0, 0, 1), (1, 0, 0), ((0.0, 0.0), (0.0, 0.25), (0.25, 0.25), (0.25, 0.0))),
)


def _box(half: Vector3) -> RenderMesh:
    mesh = _cube()
    return _moved(mesh, mesh.positions * np.array(half))


@functools.cache
def _cube() -> RenderMesh:
    """The box with half extents of 1; others have the same normals, texture coordinates and triangles."""
    positions, normals, uvs, triangles = [], [], [], []
    for normal, u, v, corners in _BOX_SIDES:
        first = len(positions)
        for (a, b), uv in zip(((-1, -1), (1, -1), (1, 1), (-1, 1)), corners, strict=True):
            positions.append([normal[i] + a * u[i] + b * v[i] for i in range(3)])
            normals.append(normal)
            uvs.append(uv)
        triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return mesh_of(positions, normals, uvs, triangles)


def _plane(normal: Vector3, half: tuple[float, float]) -> RenderMesh:
    """A rectangle, large along a half extent of 0; its texture repeats every two metres."""
    across, along = _plane_axes(normal) if half == (0.0, 0.0) or normal != _UP else (_X, _Y)
    width, height = (extent or PLANE_HALF_SIZE for extent in half)
    positions, uvs = [], []
    for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        positions.append([width * a * across[i] + height * b * along[i] for i in range(3)])
        uvs.append((width if a > 0 else 0.0, height if b > 0 else 0.0))
    return mesh_of(positions, [normal] * 4, uvs, [(0, 1, 2), (0, 2, 3)])


def _plane_axes(n: Vector3) -> tuple[Vector3, Vector3]:
    """Two unit vectors that form a right-handed frame with a unit normal."""
    x, y, z = n
    if abs(z) > 0.5**0.5:
        length = hypot(y, z)
        first = (0.0, -z / length, y / length)
    else:
        length = hypot(x, y)
        first = (-y / length, x / length, 0.0)
    second = (
        y * first[2] - z * first[1],
        z * first[0] - x * first[2],
        x * first[1] - y * first[0],
    )
    return first, second


@functools.cache
def _circle(segments: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (segments + 1, 2) around a circle of radius 1, and the fraction of the full turn at each."""
    turn = np.linspace(0.0, 1.0, segments + 1)
    angles = (2.0 * np.pi * turn).tolist()
    return np.array([(cos(angle), sin(angle)) for angle in angles]), turn


def _cylinder(radius: float, length: float, segments: int) -> RenderMesh:
    positions, mesh = _unit_cylinder(segments)
    return _moved(mesh, positions * np.array((radius, radius, length)))


@functools.cache
def _unit_cylinder(segments: int) -> tuple[NDArray[np.float64], RenderMesh]:
    """The cylinder with a radius and a length of 1, and its positions in double precision.

    Others have the same normals, texture coordinates and triangles.
    """
    circle, turn = _circle(segments)
    rings, normals, uvs, triangles = [], [], [], []
    for z, v in ((-0.5, 0.0), (0.5, 1.0)):
        rings.append(np.column_stack([circle, np.full(segments + 1, z)]))
        normals.append(np.column_stack([circle, np.zeros(segments + 1)]))
        uvs.append(np.column_stack([turn, np.full(segments + 1, v)]))
    triangles.append(_band(0, segments))
    for z, direction in ((-0.5, -1.0), (0.5, 1.0)):
        first = sum(map(len, rings))
        rim = circle[:-1]
        rings.append(np.column_stack([rim, np.full(segments, z)]))
        normals.append(np.tile([0.0, 0.0, direction], (segments, 1)))
        uvs.append(0.5 + 0.5 * rim)
        fan = np.array([(first, first + i, first + i + 1) for i in range(1, segments - 1)])
        triangles.append(fan if direction > 0.0 else fan[:, ::-1])
    positions = np.concatenate(rings)
    return positions, mesh_of(positions, *(np.concatenate(parts) for parts in (normals, uvs, triangles)))


def _rounded(radius: float, length: float, segments: int) -> RenderMesh:
    """A sphere if `length` is 0, else a capsule whose half-spheres are `length` apart along z."""
    circle, turn = _circle(segments)
    # Number of bands of triangles from pole to pole: even, so that a capsule can be cut at the equator.
    rings = segments // 2
    # Latitudes from the lower pole to the upper one; a capsule has the equator twice.
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, rings + 1)
    halves = np.where(angles < 0.0, -0.5, 0.5) * length
    if length > 0.0:
        middle = rings // 2
        angles = np.insert(angles, middle, 0.0)
        halves = np.insert(halves, middle, -0.5 * length)
    positions, normals, uvs = [], [], []
    for angle, shift in zip(angles, halves, strict=True):
        normal = np.column_stack([cos(angle) * circle, np.full(segments + 1, sin(angle))])
        normals.append(normal)
        positions.append(radius * normal + (0.0, 0.0, shift))
        uvs.append(np.column_stack([turn, np.full(segments + 1, angle / np.pi + 0.5)]))
    row = segments + 1
    bands = [_band(i * row, segments) for i in range(len(angles) - 1)]
    # At the poles half of the triangles of a band have no area and are left out.
    bands[0], bands[-1] = bands[0][1::2], bands[-1][::2]
    return mesh_of(*(np.concatenate(parts) for parts in (positions, normals, uvs, bands)))


def _band(lower: int, segments: int) -> NDArray[np.int64]:
    """Triangles (2 segments, 3) between a ring, given by its first vertex, and the next ring."""
    upper = lower + segments + 1
    i = np.arange(segments)
    first = np.stack([lower + i, lower + i + 1, upper + i], axis=1)
    second = np.stack([lower + i + 1, upper + i + 1, upper + i], axis=1)
    return np.stack([first, second], axis=1).reshape(-1, 3)
