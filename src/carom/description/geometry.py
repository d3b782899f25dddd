"""The shapes a link can have. All lengths are in metres and already scaled."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from carom.description.pose import Vector3


@dataclass(frozen=True, slots=True)
class Sphere:
    """A ball around the origin of its frame."""

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
    """A cylinder of height `length` along z with a half ball of `radius` on each end."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Plane:
    """The half space below the origin of its frame; `normal` points out of it."""

    normal: Vector3 = (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Mesh:
    """A triangle mesh from a file.

    Attributes:
        path: The file, resolved to where it was found.
        scale: Factor along x, y and z, the global scaling included.
        concave: The triangles themselves collide, not their convex hull (static bodies only).
    """

    path: Path
    scale: Vector3 = (1.0, 1.0, 1.0)
    concave: bool = False


@dataclass(frozen=True, slots=True)
class SignedDistanceField:
    """A shape given by distances on a grid, from a file."""

    path: Path


Geometry = Sphere | Box | Cylinder | Capsule | Plane | Mesh | SignedDistanceField
