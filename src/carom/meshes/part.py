"""Parts of meshes, which all mesh readers return."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.errors import DescriptionError
from carom.native.arrays import ends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.native.arrays import Corner

# Positions for each corner up to which a table of them takes less time than sorting the corners.
_MOST_UNUSED = 8


class MeshPart:
    """One piece of a mesh file: an object or group of an OBJ, a geometry of a DAE, a whole STL.

    Attributes:
        vertices: (n, 3) float64 positions [m], each used by a triangle. They are rounded to single
            precision, in which mesh files are written and PyBullet reads them. Read-only.
        triangles: (m, 3) int32 indices into `vertices`, counter-clockwise seen from outside. Read-only.
        name: Name of the object, group or geometry; may be empty.
    """

    __slots__ = ("_ends", "name", "triangles", "vertices")

    def __init__(self, vertices: NDArray[np.float64], triangles: NDArray[np.int32], name: str = "") -> None:
        self.vertices = vertices
        self.triangles = triangles
        self.name = name
        self._ends: tuple[Corner, Corner] | None = None

    @property
    def ends(self) -> tuple[Corner, Corner]:
        """Lowest and highest corner of the vertices [m]."""
        # Inertia, bounds and the order of shapes ask for them, one after the other.
        if self._ends is None:
            self._ends = ends(self.vertices)
        return self._ends


def make_part(
    file: Path, positions: NDArray[np.float64], corners: NDArray[np.int64], name: str = ""
) -> MeshPart:
    """A part from positions (k, 3) and corners (m, 3), indices in range; unused positions are left out.

    Raises:
        DescriptionError: A position is not finite; `file` is named.
    """
    used, inverse = _used(corners.reshape(-1), len(positions))
    with np.errstate(over="ignore"):
        vertices = positions[used].astype(np.float32).astype(np.float64)
    if not np.isfinite(vertices).all():
        raise DescriptionError("a vertex is not finite, or beyond single precision", file=file)
    triangles = inverse.reshape(-1, 3).astype(np.int32)
    vertices.setflags(write=False)
    triangles.setflags(write=False)
    return MeshPart(vertices, triangles, name)


def _used(corners: NDArray[np.int64], count: int) -> tuple[NDArray[np.int64], NDArray[np.integer]]:
    """The indices below `count` that there are, in order, and the place of each corner's among them."""
    if count > _MOST_UNUSED * len(corners):
        # One of many small groups: a table of all positions for each would take long.
        return np.unique(corners, return_inverse=True)
    is_used = np.zeros(count, dtype=bool)
    is_used[corners] = True
    used = is_used.nonzero()[0]
    places = np.empty(count, dtype=np.int32)
    places[used] = np.arange(len(used), dtype=np.int32)
    return used, places[corners]


def cut_into_fans(corners: NDArray[np.int64], sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Polygons cut into triangle fans from the first corner; those with fewer than three corners vanish.

    `corners` are those of all polygons, one after the other, and `sizes` the number of corners of each. The
    result is (m, 3).
    """
    if (sizes == 3).all():
        return corners.reshape(-1, 3)
    counts = np.maximum(sizes - 2, 0)
    starts = np.repeat(np.cumsum(sizes) - sizes, counts)
    # 0, 1, 2, ... within each polygon
    steps = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return corners[np.stack([starts, starts + steps + 1, starts + steps + 2], axis=1)]
