"""STL files for drawing: each triangle has the normal that the file gives it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from carom.files.bounded import read_bounded
from carom.formats.visuals.render_mesh import RenderMesh, flat_mesh, unit_vectors
from carom.meshes.part import MeshPart
from carom.meshes.stl import stl_normals


def read_stl_visual(file: Path, parts: Sequence[MeshPart]) -> RenderMesh:
    """An STL file for drawing, of the parts that `read_mesh` has read from it.

    As in PyBullet, triangles are shaded by the normals in the file. Where these are zero or not finite,
    PyBullet's are black; here they are flat.
    """
    mesh = flat_mesh(np.concatenate([part.vertices[part.triangles] for part in parts]))
    data, _ = read_bounded(file)
    count = len(mesh.triangles)
    given = np.repeat(unit_vectors(stl_normals(data, count)).astype(np.float32), 3, axis=0)
    if len(given) != 3 * count:
        # It has been written anew since.
        return mesh
    normals = np.where(given.any(axis=1, keepdims=True), given, mesh.normals)
    # `replace` would compile the methods of the class first.
    return RenderMesh(mesh.positions, normals, mesh.uvs, mesh.triangles)
