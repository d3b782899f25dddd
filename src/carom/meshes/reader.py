"""Reading a mesh file of any supported format into parts."""

from __future__ import annotations

from pathlib import Path

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import FileCache, read_bounded
from carom.meshes.obj import read_obj
from carom.meshes.part import MeshPart

MAX_CACHED_BYTES = 256 << 20
"""Most memory that the meshes of unchanged files take; robots may have a hundred of them."""


# Those of the rarer formats are imported when there is such a file.
def _read_collada(data: bytes, file: Path) -> list[MeshPart]:
    from carom.meshes.collada import read_collada

    return read_collada(data, file)


def _read_gltf(data: bytes, file: Path) -> list[MeshPart]:
    from carom.meshes.gltf import read_gltf

    return read_gltf(data, file)


def _read_ply(data: bytes, file: Path) -> list[MeshPart]:
    from carom.meshes.ply import read_ply

    return read_ply(data, file)


def _read_stl(data: bytes, file: Path) -> list[MeshPart]:
    from carom.meshes.stl import read_stl

    return read_stl(data, file)


_READERS = {
    ".obj": read_obj,
    ".stl": _read_stl,
    ".dae": _read_collada,
    ".glb": _read_gltf,
    ".gltf": _read_gltf,
    ".ply": _read_ply,
}


def read_mesh(path: Path, *, by_ears: bool = False) -> list[MeshPart]:
    """Reads the triangles of an OBJ, STL, DAE, GLB, glTF or PLY file.

    Polygons become fans of triangles, as in PyBullet; those of OBJ files are cut `by_ears` instead, as MuJoCo
    cuts them, if asked for.

    Unchanged files are served from a cache; changed files are read again.

    Returns:
        The parts of the file, in file order: at least one with at least one triangle. Of an OBJ file without
        faces, all vertices are a part without triangles if asked for `by_ears`.

    Raises:
        DescriptionError: The file is missing, cut off or broken, its kind is unknown, or it has no triangles
            otherwise.
    """
    reader = _READERS.get(path.suffix.lower())
    by_ears = by_ears and reader is read_obj
    if reader is None:
        raise DescriptionError(f"unknown kind of mesh; known are {', '.join(_READERS)}", file=path)
    file = path.absolute()
    cached = _cache.get((file, by_ears), file)
    if cached is not None:
        return list(cached)
    with reading(file, untyped=True):
        data, stamp = read_bounded(file)
        parts = read_obj(data, file, by_ears=True) if by_ears else reader(data, file)
    if not parts:
        raise DescriptionError("there are no triangles", file=file)
    size = sum(it.vertices.nbytes + it.triangles.nbytes for it in parts)
    _cache.put((file, by_ears), stamp, tuple(parts), size)
    return parts


_cache: FileCache[tuple[Path, bool], tuple[MeshPart, ...]] = FileCache(1024, most_bytes=MAX_CACHED_BYTES)
