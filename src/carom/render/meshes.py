"""Triangle meshes of all kinds of shapes, for rendering."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np

from carom.description import (
    ConvexHull,
    Geometry,
    Heightfield,
    Mesh,
    SignedDistanceField,
    TriangleMesh,
)
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.formats.visuals.reader import read_mesh_visual
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh, flat_mesh, mesh_of, unit_vectors
from carom.geometry.hull import convex_hull
from carom.geometry.polyhedron import Polyhedron
from carom.logger import Logger
from carom.meshes.part import cut_into_fans
from carom.render.primitives import primitive_mesh

_log = Logger("carom")

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


def stretched(mesh: RenderMesh, old: Geometry, new: Geometry) -> RenderMesh:
    """The triangles of a shape of another size, with the texture as on the first one."""
    positions = mesh.positions.astype(np.float64)
    ends, sides = old.ends_at(positions[:, 2]), np.array(new.sides())
    for end in (-1, 0, 1):
        at, how = ends == end, old.stretch(sides, end)
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

    return _landscape(flat_mesh(_corners(heightfield_surface(shape.heights, shape.scale, shape.middle))))


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
