"""The shapes a link can have. All lengths are in metres and already scaled."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.layouts.contacts import MARGIN

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MAX_SIZE = 1e15
"""Size [m] up to which scripts make and scale shapes; beyond it the normals of contacts are lost."""


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere centred on its frame."""

    radius: float


@dataclass(frozen=True, slots=True)
class Box:
    """A cuboid centred on its frame; `half_extents` is half its size along x, y and z."""

    half_extents: Vector3


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder centred on its frame, its axis along z; `length` is its full height."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """A cylinder of height `length` along z with a hemisphere of `radius` on each end."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Plane:
    """The half space below the origin of its frame; `normal` points out of it.

    Attributes:
        normal: Unit vector.
        size: Half extents along x and y of the part that is seen of a plane whose normal is z [m]; 0 for as
            far as planes are drawn. All of it collides.
    """

    normal: Vector3 = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Mesh:
    """A triangle mesh from a file.

    Attributes:
        path: The file, as it was found.
        scale: Factor along x, y and z, the global scaling included.
        concave: The triangles themselves collide, not their convex hull (static bodies only).
        asked_for: The file name that a script passed; empty if no script did.
        margin: Distance of the colliding surface from the hull [m]: PyBullet's, or 0 where a file means the
            hull itself.
    """

    path: Path
    scale: Vector3 = (1.0, 1.0, 1.0)
    concave: bool = False
    asked_for: str = field(default="", compare=False)
    margin: float = MARGIN


@dataclass(frozen=True, slots=True)
class SignedDistanceField:
    """A shape given by distances on a grid, from a file."""

    path: Path


@dataclass(frozen=True, eq=False, slots=True)
class ConvexHull:
    """The convex hull of points.

    Attributes:
        points: (n, 3) positions.
        scale: Factor along x, y and z that the points have been multiplied by.
        margin: Distance of the colliding surface from the hull [m]; 0 for the hull of exactly these points.
        uses: (n,) how often a file's triangles have each point as a corner, on which PyBullet's order of the
            hull's corners depends; None for once.
    """

    points: NDArray[np.float64]
    scale: Vector3 = (1.0, 1.0, 1.0)
    margin: float = MARGIN
    uses: NDArray[np.int32] | None = None


@dataclass(frozen=True, eq=False, slots=True)
class TriangleMesh:
    """A triangle mesh that is not replaced by its convex hull.

    Attributes:
        vertices: (n, 3) positions.
        triangles: (m, 3) indices into `vertices`, counter-clockwise seen from outside.
        margin: Collision margin: distance of the colliding surface from the triangles [m].
        scale: Factor along x, y and z that the vertices have been multiplied by.
        normals: (n, 3) normals for shading, if there are any.
        uvs: (n, 2) texture coordinates, if there are any.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    margin: float = 0.0
    scale: Vector3 = (1.0, 1.0, 1.0)
    normals: NDArray[np.float64] | None = None
    uvs: NDArray[np.float64] | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Heightfield:
    """Terrain: heights on a grid, centred on its frame, z up.

    Attributes:
        heights: (columns along y, rows along x) heights, unscaled.
        scale: Distance between neighbours along x and y, and factor on the heights.
        middle: Unscaled height at the origin of the frame.
    """

    heights: NDArray[np.float64]
    scale: Vector3
    middle: float


Geometry = (
    Sphere
    | Box
    | Cylinder
    | Capsule
    | Plane
    | Mesh
    | SignedDistanceField
    | ConvexHull
    | TriangleMesh
    | Heightfield
)
