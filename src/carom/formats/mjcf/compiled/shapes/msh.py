"""MuJoCo's binary mesh files: four counts, then vertices, normals, texture coordinates and triangles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge

_HEADER = 16


def read_msh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Vertices (n, 3) and triangles (m, 3) of an `.msh` file; there may be no triangles.

    Raises:
        DescriptionError: The file is missing, cut off, or says what cannot be.
    """
    with reading(path):
        return _read(read_bounded(path)[0], path)


def _read(data: bytes, path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    if len(data) < _HEADER:
        raise DescriptionError("it is too short for an .msh file", file=path)
    vertices, normals, coordinates, faces = (int(n) for n in np.frombuffer(data, "<i4", 4))
    counts = (vertices, normals, coordinates, faces)
    size = _HEADER + 4 * (3 * vertices + 3 * normals + 2 * coordinates + 3 * faces)
    if min(counts) < 0 or vertices < 4 or size != len(data):
        raise DescriptionError(
            f"its counts {counts} of vertices, normals, texture coordinates and triangles need {size} bytes; "
            f"it has {len(data)}",
            file=path,
        )
    charge("vertices", vertices + faces)
    points = np.frombuffer(data, "<f4", 3 * vertices, _HEADER).reshape(-1, 3).astype(np.float64)
    at = _HEADER + 4 * (3 * vertices + 3 * normals + 2 * coordinates)
    triangles = np.frombuffer(data, "<i4", 3 * faces, at).reshape(-1, 3).astype(np.int32)
    if not np.isfinite(points).all():
        raise DescriptionError("a vertex is not finite", file=path)
    if faces and (triangles.min() < 0 or triangles.max() >= vertices):
        raise DescriptionError(
            f"a triangle names a vertex that is not there; there are {vertices}", file=path
        )
    return points, triangles
