"""Cylinders."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import NO_TERM, MassShape, MassTerm, MassTerms
from carom.description.shapes.shape import (
    ORIGIN,
    Core,
    Facets,
    Measure,
    Parameter,
    Shape,
    TextureRule,
    are_equal,
    as_unknown_mesh,
)
from carom.layouts.codes import PathKind, ShapeKind
from carom.layouts.contacts import MARGIN
from carom.native.trigonometry import cos, sin

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.description.shapes.surface import Surface

HULL_SIDES = 32
"""Number of sides of a cylinder that is represented by its hull."""

_RIM = 32
"""Number of corners of a rim in PyBullet's images."""


@dataclass(frozen=True, slots=True)
class Cylinder(Shape):
    """A cylinder centred on its frame, its axis along z; `length` is its full height."""

    radius: float
    length: float

    tag: ClassVar[str] = "cylinder"
    mjcf: ClassVar[str] = "cylinder"
    size_count: ClassVar[int] = 2
    usd: ClassVar[str] = "Cylinder"
    geom: ClassVar[int] = 4
    geom_name: ClassVar[str] = "GEOM_CYLINDER"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("radius", Measure.LENGTH, "radius", "radius", ("Radius", 1.0)),
        Parameter("length", Measure.LENGTH, "length", "height", ("Height", 2.0)),
    )
    bullet_sdf_length: ClassVar[float | None] = 0.1
    tendon_path: ClassVar[PathKind | None] = PathKind.CYLINDER
    has_edges: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.OWN

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        exact = Bounds(ORIGIN, (self.radius, self.radius, 0.5 * self.length))
        return exact if implicit_cylinder else exact.grown(MARGIN).grown(MARGIN)

    def scaled(self, factors: Vector3) -> Cylinder:
        fx, fy, fz = factors
        if fx != fy:
            raise ValueError("a cylinder has to stay round")
        return Cylinder(self.radius * fx, self.length * fz)

    def lengths(self) -> tuple[float, ...]:
        return (self.radius, self.length)

    def sides(self) -> Vector3:
        side = 2.0 * self.radius
        return (side, side, self.length)

    def with_sides(self, x: float, y: float, z: float) -> Cylinder:
        if not are_equal(x, y):
            raise ValueError(f"a cylinder is round about its z axis: its sides are not {x:g} and {y:g} m")
        return Cylinder(0.5 * x, z)

    def core(self, *, implicit_cylinder: bool) -> Core | None:
        if not implicit_cylinder:
            return None
        return Core(ShapeKind.CYLINDER, (self.radius, 0.5 * self.length, 0.0), MARGIN)

    def facets(self) -> Facets:
        import numpy as np

        angles = [2.0 * pi * side / HULL_SIDES for side in range(HULL_SIDES)]
        rim = [(self.radius * sin(angle), self.radius * cos(angle)) for angle in angles]
        half = 0.5 * self.length
        points = np.array([(x, y, z) for z in (-half, half) for x, y in rim])
        sides = range(HULL_SIDES)
        bottom, top = list(sides), [HULL_SIDES + side for side in reversed(sides)]
        following = [*sides[1:], 0]
        quads = [[a, HULL_SIDES + a, HULL_SIDES + b, b] for a, b in zip(sides, following, strict=True)]
        return Facets(points, [bottom, top, *quads], MARGIN, on_grid=True)

    def least_extent(self) -> float:
        return min(self.radius, 0.5 * self.length)

    def volume(self) -> float:
        return pi * self.radius * self.radius * self.length

    def solid(self) -> MassShape:
        r, h = self.radius, 0.5 * self.length
        across = r * r / 4.0 + h * h / 3.0
        return MassShape.central(2.0 * pi * r * r * h, (across, across, 0.5 * r * r))

    def shell(self) -> MassShape:
        r, h = self.radius, 0.5 * self.length
        side, lids = 4.0 * pi * r * h, 2.0 * pi * r * r
        area = side + lids
        across = side * (0.5 * r * r + h * h / 3.0) + lids * (0.25 * r * r + h * h)
        along = side * r * r + lids * 0.5 * r * r
        return MassShape.central(area, (across / area, across / area, along / area))

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        if not implicit_cylinder:
            return Shape.mass_terms(self, bounds, margin, implicit_cylinder=False)
        radius, length = self.radius, self.length
        across = MassTerm(12.0, (length, length, 1.0)), MassTerm(4.0, (radius, radius, 1.0))
        return (across, across, (MassTerm(2.0, (radius, radius, 1.0)), NO_TERM))

    @classmethod
    def of_sizes(cls, x: float, y: float, z: float) -> Cylinder:
        return cls(x, 2.0 * y)

    def sizes(self) -> tuple[float, ...]:
        return (self.radius, 0.5 * self.length)

    @classmethod
    def fitted(cls, half: Vector3, *, by_bounds: bool) -> Vector3:
        a, b, c = half
        return (max(a, b) if by_bounds else 0.5 * (a + b), c, 0.0)

    def visual_dimensions(self) -> Vector3:
        return (self.length, self.radius, 0.0)

    def collision_data(self, *, implicit_cylinder: bool) -> tuple[int, Vector3, bytes]:
        return self.visual_data() if implicit_cylinder else as_unknown_mesh()

    def surface(self, segments: int) -> Surface:
        import numpy as np

        positions, surface = _unit(segments)
        return surface.moved(positions * np.array((self.radius, self.radius, self.length)))

    def scaled_unit(self) -> tuple[Cylinder, Vector3]:
        return _UNIT, (self.radius, self.radius, self.length)

    def in_bullets_images(self) -> NDArray[np.float64]:
        import numpy as np

        return np.array(rims(self.radius, self.length))


_UNIT = Cylinder(1.0, 1.0)


def rims(radius: float, length: float) -> list[Vector3]:
    """Points of both rims of a shaft, for PyBullet's images."""
    half = 0.5 * length
    angles = [2.0 * pi * (i / _RIM) for i in range(_RIM)]
    return [(radius * sin(a), radius * cos(a), z) for a in angles for z in (half, -half)]


@functools.cache
def _unit(segments: int) -> tuple[NDArray[np.float64], Surface]:
    """The cylinder with a radius and a length of 1, and its positions in double precision.

    Others have the same normals, texture coordinates and triangles.
    """
    import numpy as np

    from carom.description.shapes.surface import Surface, band, circle

    ring, turn = circle(segments)
    rings, normals, uvs, triangles = [], [], [], []
    for z, v in ((-0.5, 0.0), (0.5, 1.0)):
        rings.append(np.column_stack([ring, np.full(segments + 1, z)]))
        normals.append(np.column_stack([ring, np.zeros(segments + 1)]))
        uvs.append(np.column_stack([turn, np.full(segments + 1, v)]))
    triangles.append(band(0, segments))
    for z, direction in ((-0.5, -1.0), (0.5, 1.0)):
        first = sum(map(len, rings))
        rim = ring[:-1]
        rings.append(np.column_stack([rim, np.full(segments, z)]))
        normals.append(np.tile([0.0, 0.0, direction], (segments, 1)))
        uvs.append(0.5 + 0.5 * rim)
        fan = np.array([(first, first + i, first + i + 1) for i in range(1, segments - 1)])
        triangles.append(fan if direction > 0.0 else fan[:, ::-1])
    positions = np.concatenate(rings)
    rest = (np.concatenate(parts) for parts in (normals, uvs, triangles))
    return positions, Surface(positions, *rest).ready()
