"""Reading mesh files for drawing: with normals, texture coordinates and the texture of the material."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import FileCache, FileStamp
from carom.formats.visuals.obj import read_obj_visual
from carom.formats.visuals.render_mesh import RenderMesh, flat_mesh
from carom.meshes import read_mesh


def read_mesh_visual(path: Path) -> RenderMesh:
    """Reads a mesh file of any kind for drawing.

    Unchanged files are served from a cache, and so are files that were deleted after they were read.

    Raises:
        DescriptionError: The file is missing, cut off or broken, its kind is unknown, or it has no triangles.
    """
    file = path.absolute()
    cached = _cache.get(file, file)
    if cached is not None:
        return cached
    stamp = None
    with suppress(OSError):
        stamp = FileStamp.of(file)
    with reading(file, untyped=True):
        mesh = _read(file)
    if stamp is not None:
        _cache.put(file, stamp, mesh)
    return mesh


def _read(file: Path) -> RenderMesh:
    kind = file.suffix.lower()
    if kind == ".obj":
        with suppress(DescriptionError):
            mesh = read_obj_visual(file)
            if len(mesh.triangles):
                return mesh
    # This makes all checks of the reader that physics uses; what it says of a broken file comes first.
    parts = read_mesh(file)
    if kind == ".obj":
        return read_obj_visual(file)
    if kind == ".dae":
        from carom.formats.visuals.dae import read_dae_visual

        return read_dae_visual(file)
    if kind == ".stl":
        from carom.formats.visuals.stl import read_stl_visual

        return read_stl_visual(file, parts)
    return flat_mesh(np.concatenate([part.vertices[part.triangles] for part in parts]))


_cache: FileCache[Path, RenderMesh] = FileCache(128, outlive=True)
