"""Skins: surfaces that follow bones, which are links, or nodes of soft bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.description.link import Material
from carom.description.place import Place
from carom.description.pose import Pose

NO_NODE = -1
"""Number of the node of a bone that is a link."""


@dataclass(frozen=True, eq=False, slots=True)
class Bone:
    """What part of a skin follows.

    Attributes:
        place: The link that it is on, or the soft body whose node it is.
        frame: Its pose in the frame of that link; of a node its orientation in the world, which does not
            change.
        node: Number of the node of a soft body, -1 for none.
        vertices: (k,) numbers of the vertices that follow it.
        points: (k, 3) where they are in its frame [m].
        weights: (k,) its share of each; those of all bones of a vertex add up to 1.
    """

    place: Place
    frame: Pose
    vertices: NDArray[np.int32]
    points: NDArray[np.float64]
    weights: NDArray[np.float64]
    node: int = NO_NODE


@dataclass(frozen=True, eq=False, slots=True)
class Skin:
    """A surface that follows bones.

    Attributes:
        name: Its name.
        vertices: (n, 3) its vertices where its bones are at rest, in the world [m].
        triangles: (m, 3) numbers of vertices, counter-clockwise seen from outside.
        uvs: (n, 2) texture coordinates, v upwards; None for none.
        bones: Its bones.
        inflation: How far vertices are moved along their normals [m].
        material: How it looks.
        group: Number of its group, which windows show or hide.
    """

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uvs: NDArray[np.float64] | None
    bones: tuple[Bone, ...]
    inflation: float = 0.0
    material: Material | None = None
    group: int = 0
