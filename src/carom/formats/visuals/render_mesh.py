"""Triangle meshes for rendering: positions, normals and texture coordinates of vertices."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.description.link import Rgba

Floats = NDArray[np.float32]
Indices = NDArray[np.int32]

NO_TEXTURE_UV = 0.5
"""Value of both texture coordinates of vertices that have none."""


@dataclass(frozen=True, repr=False, eq=False, slots=True)
class RenderMesh:
    """Triangles ready to be drawn. All arrays are read-only.

    Attributes:
        positions: (n, 3) [m].
        normals: (n, 3) of unit length, or zero where a triangle has no area.
        uvs: (n, 2) texture coordinates, v upwards; they wrap around.
        triangles: (m, 3) indices of vertices, counter-clockwise seen from outside.
        texture_file: Image its material names; it may be missing or broken.
        material_rgba: Colour of its material.
    """

    positions: Floats
    normals: Floats
    uvs: Floats
    triangles: Indices
    texture_file: Path | None = None
    material_rgba: Rgba | None = None

    def __post_init__(self) -> None:
        for array in (self.positions, self.normals, self.uvs, self.triangles):
            array.setflags(write=False)


def mesh_of(positions: object, normals: object, uvs: object, triangles: object) -> RenderMesh:
    """A mesh from anything NumPy can make arrays of."""
    return RenderMesh(
        np.array(positions, dtype=np.float32).reshape(-1, 3),
        np.array(normals, dtype=np.float32).reshape(-1, 3),
        np.array(uvs, dtype=np.float32).reshape(-1, 2),
        np.array(triangles, dtype=np.int32).reshape(-1, 3),
    )


def face_normals(corners: NDArray[np.floating]) -> NDArray[np.float64]:
    """Unit normals (m, 3) of triangles given by their corners (m, 3, 3); zero for those without area."""
    corners = corners.astype(np.float64)
    return unit_vectors(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def unit_vectors(vectors: NDArray[np.floating]) -> NDArray[np.float64]:
    """Rows normalised to length 1; zero, infinite and undefined rows become zero."""
    # NumPy goes along rows, which are longer this way.
    columns = np.ascontiguousarray(vectors.T)
    x, y, z = columns
    with np.errstate(all="ignore"):
        result = columns / np.sqrt(x * x + y * y + z * z)
    return np.ascontiguousarray(np.where(np.isfinite(result), result, 0.0).T)


def flat_mesh(corners: NDArray[np.floating]) -> RenderMesh:
    """A mesh of separate flat triangles, from corners (m, 3, 3)."""
    count = len(corners)
    return RenderMesh(
        np.ascontiguousarray(corners, dtype=np.float32).reshape(-1, 3),
        np.repeat(face_normals(corners), 3, axis=0).astype(np.float32),
        np.full((3 * count, 2), NO_TEXTURE_UV, dtype=np.float32),
        np.arange(3 * count, dtype=np.int32).reshape(-1, 3),
    )
