"""The words our asset tables are written in: links, joints and shapes as plain facts."""

from __future__ import annotations

from dataclasses import dataclass, field

Vector3 = tuple[float, float, float]
ZERO: Vector3 = (0.0, 0.0, 0.0)
ONE: Vector3 = (1.0, 1.0, 1.0)
QUARTER_TURN = 1.57079632679
HALF_TURN = 3.14159265359
ALONG_Y: Vector3 = (QUARTER_TURN, 0.0, 0.0)
"""Lays a cylinder or capsule along y."""


@dataclass(frozen=True)
class Box:
    """A cuboid with the given edge lengths."""

    size: Vector3


@dataclass(frozen=True)
class Sphere:
    """A ball."""

    radius: float


@dataclass(frozen=True)
class Cylinder:
    """A cylinder along z."""

    radius: float
    length: float


@dataclass(frozen=True)
class Capsule:
    """A cylinder along z of the given length with a half ball on each end."""

    radius: float
    length: float


@dataclass(frozen=True)
class Plane:
    """The half space below the origin."""

    normal: Vector3 = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Mesh:
    """A mesh file, named relative to the folder of the URDF."""

    file: str
    scale: Vector3 = ONE


Geometry = Box | Sphere | Cylinder | Capsule | Plane | Mesh


@dataclass(frozen=True)
class Paint:
    """A named colour, with highlights where `specular` is given."""

    name: str
    rgba: tuple[float, float, float, float]
    specular: Vector3 | None = None


@dataclass(frozen=True)
class Shape:
    """A geometry at a place in its link; `paint` is for shapes that are seen."""

    geometry: Geometry
    xyz: Vector3 = ZERO
    rpy: Vector3 = ZERO
    paint: Paint | None = None
    group: int | None = None
    mask: int | None = None


@dataclass(frozen=True)
class Inertial:
    """Mass [kg], centre of mass [m] and (ixx, ixy, ixz, iyy, iyz, izz) [kg m²] of a link."""

    mass: float
    xyz: Vector3 = ZERO
    rpy: Vector3 = ZERO
    tensor: tuple[float, float, float, float, float, float] = (1.0, 0.0, 0.0, 1.0, 0.0, 1.0)


def diagonal(ixx: float, iyy: float, izz: float) -> tuple[float, float, float, float, float, float]:
    """An inertia tensor without products."""
    return (ixx, 0.0, 0.0, iyy, 0.0, izz)


@dataclass(frozen=True)
class Link:
    """A link; `contact` maps the tags of the URDF contact element to values, None for a bare tag."""

    name: str
    inertial: Inertial | None = None
    seen: tuple[Shape, ...] = ()
    touching: tuple[Shape, ...] = ()
    contact: dict[str, float | None] = field(default_factory=dict)


@dataclass(frozen=True)
class Joint:
    """A joint; `limit` maps the attributes of the URDF limit element to values."""

    name: str
    type: str
    parent: str
    child: str
    xyz: Vector3 = ZERO
    rpy: Vector3 = ZERO
    axis: Vector3 | None = None
    limit: dict[str, float] = field(default_factory=dict)
    damping: float | None = None
    friction: float | None = None
    soft_limits: tuple[float, float, float, float] | None = None
    mimic: str | None = None


@dataclass(frozen=True)
class Robot:
    """A robot and the sentence that introduces its file."""

    name: str
    about: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...] = ()
