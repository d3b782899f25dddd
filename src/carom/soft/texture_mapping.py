"""Texture mapping of soft bodies: texture coordinates of what is drawn, and an image."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.formats.visuals.reader import read_mesh_visual
from carom.logger import Logger

_log = Logger(__name__)

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

# Repeats of the texture on each metre of a solid, as in PyBullet.
_REPEATS = 10.0


@dataclass(frozen=True, eq=False, slots=True)
class TextureMapping:
    """How a texture lies on the visible triangles of a soft body.

    Attributes:
        uvs: (3 t, 2) texture coordinates of the corners of all triangles, one triangle after the other.
        texture: Image file; it may be missing or broken. None: no texture until one is set.
        checkered: The texture is that of floors: white and blue squares, two by two.
    """

    uvs: Floats
    texture: Path | None = None
    checkered: bool = False


def mapping_of_file(file: Path, vertices: Floats, triangles: Ints) -> TextureMapping | None:
    """Texture coordinates and texture that an OBJ file has for its first object.

    Vertices (v, 3) and triangles (t, 3) are those of that object, as in the file. The result is None if the
    file has no texture coordinates, or if they cannot be read, with a warning.
    """
    try:
        mesh = read_mesh_visual(file)
    except DescriptionError as error:
        _log.warning("%s; the soft body goes without texture", error)
        return None
    corners = mesh.triangles[: len(triangles)]
    # The reader for drawing takes all objects, in the order of the file; the first one has to be the same.
    if corners.shape != triangles.shape or not np.array_equal(
        mesh.positions[corners], vertices[triangles].astype(np.float32)
    ):
        return None
    uvs = mesh.uvs[corners.reshape(-1)].astype(np.float64)
    return TextureMapping(uvs, mesh.texture_file) if np.ptp(uvs, axis=0).any() else None


def checkered(vertices: Floats, triangles: Ints) -> TextureMapping:
    """Squares of 5 cm, projected along z, as on PyBullet's solids from VTK files."""
    return TextureMapping(_REPEATS * np.abs(vertices[triangles.reshape(-1), :2]), checkered=True)


def stretched(vertices: Floats, triangles: Ints) -> TextureMapping:
    """One image stretched over the whole of a flat cloth."""
    low, size = vertices[:, :2].min(axis=0), np.maximum(np.ptp(vertices[:, :2], axis=0), np.finfo(float).tiny)
    return TextureMapping((vertices[triangles.reshape(-1), :2] - low) / size)
