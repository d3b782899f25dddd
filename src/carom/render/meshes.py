"""Triangle meshes of all kinds of shapes, for rendering."""

from __future__ import annotations

import functools
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.description import (
    Capsule,
    ConvexHull,
    Geometry,
    Heightfield,
    Mesh,
    SignedDistanceField,
    TriangleMesh,
)
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.formats.mesh.part import cut_into_fans
from carom.formats.visuals.reader import read_mesh_visual
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh, flat_mesh, mesh_of, unit_vectors
from carom.geometry.hull import convex_hull
from carom.geometry.polyhedron import Polyhedron
from carom.logger import Logger
from carom.render.primitives import primitive_mesh

_log = Logger("carom")

# Positions are in single precision.
_ROUNDING = 1e-6
_NOTHING = mesh_of([], [], [], [])


def shape_mesh(shape: Geometry) -> RenderMesh:
    """The triangles of a shape in its frame.

    The result is empty for a signed distance field. It is also empty, and a warning is logged, if the file of
    a mesh cannot be used.
    """
    if isinstance(shape, SignedDistanceField):
        return _NOTHING
    if isinstance(shape, Mesh):
        try:
            return _scaled(read_mesh_visual(shape.path), shape.scale)
        except DescriptionError as error:
            _log.warning("%s; the mesh is not shown", error)
            return _NOTHING
    if isinstance(shape, (ConvexHull, TriangleMesh, Heightfield)):
        return _from_memory(shape)
    return primitive_mesh(shape)


class Stretch(NamedTuple):
    """How the surface of a shape becomes that of others of its kind, in its frame; normals stay as they are.

    Attributes:
        factors: Along x, y and z, (..., 3).
        shift: Then along z [m], (...).
    """

    factors: NDArray[np.float64]
    shift: NDArray[np.float64]


def stretch_of(geometry: Geometry, sides: NDArray[np.float64], end: int = 0) -> Stretch:
    """How a shape gets other sides (..., 3) [m].

    Args:
        geometry: The shape, which has sides.
        sides: Lengths of the new ones along its axes.
        end: Of a capsule, which end along z is meant, -1 or 1, or 0 for what is between them.
    """
    factors = sides / np.array(geometry.sides())
    if not isinstance(geometry, Capsule):
        return Stretch(factors, np.zeros(sides.shape[:-1]))
    across, length = factors[..., :1], sides[..., 2] - sides[..., 0]
    if end == 0:
        along = (length / geometry.length if geometry.length else np.ones_like(length))[..., np.newaxis]
        return Stretch(np.concatenate([across, across, along], axis=-1), np.zeros(sides.shape[:-1]))
    return Stretch(np.repeat(across, 3, axis=-1), 0.5 * end * (length - across[..., 0] * geometry.length))


def ends_of(geometry: Geometry, heights: NDArray[np.floating]) -> NDArray[np.int64]:
    """At which end of a shape points at some heights along its z axis are (-1 or 1); 0 for no capsule."""
    if not isinstance(geometry, Capsule):
        return np.zeros(len(heights), np.int64)
    half = (0.5 - _ROUNDING) * geometry.length
    return np.where(heights >= half, 1, np.where(heights <= -half, -1, 0))


def stretched(mesh: RenderMesh, old: Geometry, new: Geometry) -> RenderMesh:
    """The triangles of a shape of another size, with the texture as on the first one."""
    positions = mesh.positions.astype(np.float64)
    ends, sides = ends_of(old, positions[:, 2]), np.array(new.sides())
    for end in (-1, 0, 1):
        at, how = ends == end, stretch_of(old, sides, end)
        positions[at] = positions[at] * how.factors + (0.0, 0.0, float(how.shift))
    # `replace` would compile the methods of the class first.
    return RenderMesh(
        *(positions.astype(np.float32), mesh.normals, mesh.uvs, mesh.triangles),
        *(mesh.texture_file, mesh.material_rgba),
    )


@functools.lru_cache(maxsize=256)
def _scaled(mesh: RenderMesh, scale: Vector3) -> RenderMesh:
    if scale == (1.0, 1.0, 1.0):
        return mesh
    factors = np.array(scale)
    # Normals scale with the cofactors, which need no division by a factor that may be 0.
    cofactors = np.array([scale[1] * scale[2], scale[2] * scale[0], scale[0] * scale[1]])
    mirrored = factors.prod() < 0.0
    # `replace` would compile the methods of the class first.
    return RenderMesh(
        (mesh.positions * factors).astype(np.float32),
        unit_vectors(mesh.normals * (-cofactors if mirrored else cofactors)).astype(np.float32),
        mesh.uvs,
        np.ascontiguousarray(mesh.triangles[:, ::-1]) if mirrored else mesh.triangles,
        mesh.texture_file,
        mesh.material_rgba,
    )


@functools.lru_cache(maxsize=256)
def _from_memory(shape: ConvexHull | TriangleMesh | Heightfield) -> RenderMesh:
    if isinstance(shape, TriangleMesh):
        return _given_triangles(shape)
    if isinstance(shape, ConvexHull):
        return flat_mesh(_corners(convex_hull(shape.points)))
    from carom.geometry.heightfield import heightfield_surface

    return _landscape(flat_mesh(_corners(heightfield_surface(shape))))


def _landscape(surface: RenderMesh) -> RenderMesh:
    """A height field with its texture stretched over it once, from the greatest x and y to the least."""
    places = surface.positions[:, :2]
    low, high = places.min(axis=0), places.max(axis=0)
    return replace(surface, uvs=((high - places) / (high - low)).astype(np.float32))


def _given_triangles(shape: TriangleMesh) -> RenderMesh:
    count = len(shape.vertices)
    if shape.normals is None or len(shape.normals) != count:
        flat = flat_mesh(shape.vertices[shape.triangles])
        if shape.uvs is None or len(shape.uvs) != count:
            return flat
        return replace(flat, uvs=shape.uvs[shape.triangles.reshape(-1)].astype(np.float32))
    uvs = np.full((count, 2), NO_TEXTURE_UV) if shape.uvs is None or len(shape.uvs) != count else shape.uvs
    return mesh_of(shape.vertices, unit_vectors(shape.normals), uvs, shape.triangles)


def _corners(solid: Polyhedron) -> np.ndarray:
    """Corners (m, 3, 3) of the triangles into which the faces are cut."""
    triangles = cut_into_fans(solid.corners.astype(np.int64), solid.corner_count.astype(np.int64))
    return solid.vertices[triangles]
