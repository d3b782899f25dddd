"""A skin as it is compiled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.description.link import Material

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False, slots=True)
class FileBone:
    """A bone of a skin.

    Attributes:
        body: Name of its body.
        vertices: (k,) numbers of the vertices that follow it.
        points: (k, 3) where they are in its frame [m].
        weights: (k,) its share of each; those of all bones of a vertex add up to 1.
    """

    body: str
    vertices: Ints
    points: Floats
    weights: Floats


@dataclass(frozen=True, eq=False, slots=True)
class FileSkin:
    """A skin.

    Attributes:
        name: Its name; empty if it has none.
        vertices: (n, 3) where its bones are at rest, in the world [m].
        triangles: (m, 3) numbers of vertices.
        uvs: (n, 2) texture coordinates, v upwards; None for none.
        bones: Its bones.
        inflation: How far vertices are moved along their normals [m].
        material: How it looks.
        group: Number of its group.
    """

    name: str
    vertices: Floats
    triangles: Ints
    uvs: Floats | None
    bones: list[FileBone]
    inflation: float
    material: Material
    group: int
