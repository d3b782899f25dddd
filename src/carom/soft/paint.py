"""Texture coordinates and textures of soft bodies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.formats.visuals.reader import read_mesh_visual
from carom.logger import Logger
from carom.record import record

_log = Logger(__name__)

# Squares of a solid on each metre, as in PyBullet: the texture has two by two.
_REPEATS = 10.0


@record(eq=False)
class Paint:
    """What is painted on the visible triangles of a soft body.

    Attributes:
        uvs: (3 t, 2) texture coordinates of the corners of all triangles, one triangle after the other.
        texture: Image file; it may be missing or broken. Without one, colours are plain until
            `changeVisualShape` sets a texture.
        checkered: The texture is that of floors: white and blue squares.
    """

    uvs: NDArray[np.float64]
    texture: Path | None = None
    checkered: bool = False


def paint_of_file(file: Path, vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Paint | None:
    """Texture coordinates and texture that an OBJ file has for its first object.

    Args:
        file: The file.
        vertices: (v, 3) vertices of that object, as in the file.
        triangles: (t, 3) its triangles.

    Returns:
        None if the file has no texture coordinates, or if they cannot be read, with a warning.
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
    return Paint(uvs, mesh.texture_file) if np.ptp(uvs, axis=0).any() else None


def squares(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Paint:
    """The squares that PyBullet paints on solids from VTK files, from above: 5 cm wide."""
    return Paint(_REPEATS * np.abs(vertices[triangles.reshape(-1), :2]), checkered=True)


def spread(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Paint:
    """One image over the whole of a flat cloth, by x and y."""
    low, size = vertices[:, :2].min(axis=0), np.maximum(np.ptp(vertices[:, :2], axis=0), np.finfo(float).tiny)
    return Paint((vertices[triangles.reshape(-1), :2] - low) / size)
