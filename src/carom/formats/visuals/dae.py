"""COLLADA (DAE) files for drawing: normals and texture coordinates.

Images and colours are not read: PyBullet's software renderer does not show them either.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.files.bounded import read_bounded
from carom.files.xml_element import Element
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh, face_normals, unit_vectors
from carom.meshes.collada import ColladaReader, collada_reader, inputs, primitives, referenced
from carom.native.products import product

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class _Corners:
    """Values at the corners of triangles.

    Attributes:
        positions: (3 m, 3).
        normals: (3 m, 3), of any length.
        uvs: (3 m, 2).
    """

    positions: Floats
    normals: Floats
    uvs: Floats


def read_dae_visual(file: Path) -> RenderMesh:
    """Reads a DAE file for drawing, as `read_collada`. Triangles without usable normals are flat."""
    data, _ = read_bounded(file)
    reader = collada_reader(data, file)
    known: dict[str, list[_Corners]] = {}
    placed = []
    for identifier, placement in reader.scene():
        if identifier not in known:
            known[identifier] = list(_read_geometry(reader, reader.geometries[identifier]))
        placed += [_placed(corners, placement) for corners in known[identifier]]
    count = sum(len(corners.positions) for corners in placed)
    return RenderMesh(
        np.concatenate([corners.positions for corners in placed]).astype(np.float32),
        unit_vectors(np.concatenate([corners.normals for corners in placed])).astype(np.float32),
        np.concatenate([corners.uvs for corners in placed]).astype(np.float32),
        np.arange(count, dtype=np.int32).reshape(-1, 3),
    )


def _placed(corners: _Corners, placement: Floats) -> _Corners:
    linear = placement[:3, :3]
    # Up to length, the cofactor matrix transforms normals like the inverse transpose, without an inverse.
    cofactors = np.stack([np.cross(linear[i - 2], linear[i - 1]) for i in range(3)])
    return _Corners(
        product(corners.positions, linear.T) + placement[:3, 3],
        product(corners.normals, cofactors.T),
        corners.uvs,
    )


def _read_geometry(reader: ColladaReader, geometry: Element) -> list[_Corners]:
    result = []
    for mesh, primitive in primitives(geometry):
        source, offset, stride = reader.position_input(mesh, primitive)
        positions = source[reader.corner_indices(primitive, offset, stride)]
        normals = _attribute(reader, mesh, primitive, "NORMAL", 3, stride)
        if normals is None:
            normals = np.repeat(face_normals(positions), 3, axis=0)
        uvs = _attribute(reader, mesh, primitive, "TEXCOORD", 2, stride)
        if uvs is None:
            uvs = np.full((3 * len(positions), 2), NO_TEXTURE_UV)
        result.append(_Corners(positions.reshape(-1, 3), normals, uvs))
    return result


def _attribute(
    reader: ColladaReader, mesh: Element, primitive: Element, semantic: str, width: int, stride: int
) -> Floats | None:
    """(3 m, width) values of an attribute at all corners; None if the mesh does not have it."""
    entry, offset = next(inputs(primitive, semantic), None), 0
    if entry is not None:
        offset = reader.offset(entry)
    else:
        shared = reader.shared_input(mesh, primitive)
        if shared is not None:
            vertices, offset = shared
            entry = next(inputs(vertices, semantic), None)
    source = None if entry is None else referenced(mesh, "source", entry)
    if source is None:
        return None
    rows = reader.source_rows(source, width)
    indices = reader.corner_indices(primitive, offset, stride).reshape(-1)
    if len(indices) and not 0 <= indices.min() <= indices.max() < len(rows):
        return None
    return rows[indices]
