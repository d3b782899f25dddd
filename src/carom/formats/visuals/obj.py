"""Wavefront OBJ files for drawing: normals, texture coordinates and the material's texture."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from carom.files.bounded import read_bounded
from carom.formats.visuals.mtl import ObjMaterial
from carom.formats.visuals.plain_obj import ObjContents, distinct_corners, read_plain_obj
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh, face_normals, unit_vectors

_VERTEX, _UV, _NORMAL = 0, 1, 2


def read_obj_visual(file: Path) -> RenderMesh:
    """Reads an OBJ file for drawing.

    As in PyBullet a group (`g` or `o`) has the material that is in use at its end, and the whole mesh that of
    the first group whose material has a texture, otherwise that of the last group. Faces without normals are
    flat.

    Raises:
        DescriptionError: A number is missing or broken, or a face names something that does not exist.
    """
    data, _ = read_bounded(file)
    data = data.removeprefix(b"\xef\xbb\xbf") + b"\n"
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    contents = read_plain_obj(data)
    if contents is None:
        from carom.formats.visuals.obj_lines import read_obj_lines

        contents = read_obj_lines(data, file)
    return _mesh(contents, contents.groups.material_of_all(file.parent))


def _mesh(contents: ObjContents, material: ObjMaterial | None) -> RenderMesh:
    positions, uvs, normals = contents.positions, contents.uvs, contents.normals
    corners = contents.corners
    # Corners without a normal get that of their face, which is appended to the normals.
    if corners[:, :, _NORMAL].min(initial=0) < 0:
        flat = (corners[:, :, _NORMAL] < 0).any(axis=1)
        corners = corners.copy()
        corners[flat, :, _NORMAL] = len(normals) + np.arange(flat.sum())[:, None]
        normals = np.concatenate([normals, face_normals(positions[corners[flat, :, _VERTEX]])])
    corners = corners.reshape(-1, 3)
    first, numbers = distinct_corners(corners, (len(positions), len(uvs), len(normals)))
    vertex, uv, normal = corners.take(first, axis=0).T
    # -1 stands for the last row.
    uvs = np.concatenate([uvs, [np.zeros(2) if len(uvs) else np.full(2, NO_TEXTURE_UV)]])
    return RenderMesh(
        positions.take(vertex, axis=0).astype(np.float32),
        unit_vectors(normals.take(normal, axis=0)).astype(np.float32),
        uvs.take(uv, axis=0).astype(np.float32),
        numbers.reshape(-1, 3),
        None if material is None else material.texture,
        None if material is None else material.rgba,
    )
