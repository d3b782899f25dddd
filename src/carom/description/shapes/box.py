"""Boxes."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import MassShape, MassTerms, box_terms
from carom.description.shapes.shape import ORIGIN, Core, Measure, Parameter, Shape, TextureRule
from carom.layouts.codes import ShapeKind
from carom.layouts.contacts import MARGIN

if TYPE_CHECKING:
    from carom.description.shapes.surface import Surface

# Each side of a box: its outward normal, two axes along the side with u × v = normal, and the texture
# coordinates of its corners (-u, -v), (u, -v), (u, v) and (-u, v). One image wraps around all sides, as in
# PyBullet.
SIDES: tuple[tuple[Vector3, Vector3, Vector3, tuple[tuple[float, float], ...]], ...] = (
    ((0, 0, 1), (1, 0, 0), (0, 1, 0), ((0.75, 0.25), (1.0, 0.25), (1.0, 0.0), (0.75, 0.0))),
    ((0, 0, -1), (-1, 0, 0), (0, 1, 0), ((0.25, 0.25), (0.5, 0.25), (0.5, 0.0), (0.25, 0.0))),
    ((-1, 0, 0), (0, 0, 1), (0, 1, 0), ((0.5, 0.0), (0.5, 0.25), (0.75, 0.25), (0.75, 0.0))),
    ((1, 0, 0), (0, 0, -1), (0, 1, 0), ((0.0, 0.5), (0.25, 0.5), (0.25, 0.25), (0.0, 0.25))),
    ((0, -1, 0), (0, 0, 1), (-1, 0, 0), ((0.5, 0.5), (0.5, 0.25), (0.25, 0.25), (0.25, 0.5))),
    ((0, 1, 0), (0, 0, 1), (1, 0, 0), ((0.0, 0.0), (0.0, 0.25), (0.25, 0.25), (0.25, 0.0))),
)


@dataclass(frozen=True, slots=True)
class Box(Shape):
    """A cuboid centred on its frame; `half_extents` is half its size along x, y and z."""

    half_extents: Vector3

    tag: ClassVar[str] = "box"
    mjcf: ClassVar[str] = "box"
    size_count: ClassVar[int] = 3
    usd: ClassVar[str] = "Cube"
    geom: ClassVar[int] = 3
    geom_name: ClassVar[str] = "GEOM_BOX"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("half_extents", Measure.LENGTHS, "size", "halfExtents", ("Size", 2.0), per_field=2.0),
    )
    has_edges: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.SIDES

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds(ORIGIN, self.half_extents)

    def scaled(self, factors: Vector3) -> Box:
        (x, y, z), (fx, fy, fz) = self.half_extents, factors
        return Box((x * fx, y * fy, z * fz))

    def lengths(self) -> tuple[float, ...]:
        return self.half_extents

    def sides(self) -> Vector3:
        x, y, z = self.half_extents
        return (2.0 * x, 2.0 * y, 2.0 * z)

    def with_sides(self, x: float, y: float, z: float) -> Box:
        return Box((0.5 * x, 0.5 * y, 0.5 * z))

    def is_floor(self, least: float) -> bool:
        return sum(2.0 * half > least for half in self.half_extents) >= 2

    def core(self, *, implicit_cylinder: bool) -> Core:
        return Core(ShapeKind.BOX, self.half_extents, MARGIN)

    def least_extent(self) -> float:
        return min(self.half_extents)

    def volume(self) -> float:
        a, b, c = self.half_extents
        return 8.0 * a * b * c

    def solid(self) -> MassShape:
        a, b, c = self.half_extents
        moments = ((b * b + c * c) / 3.0, (a * a + c * c) / 3.0, (a * a + b * b) / 3.0)
        return MassShape.central(self.volume(), moments)

    def shell(self) -> MassShape:
        half = a, b, c = self.half_extents
        # Pairs of faces across x, y and z.
        areas = (8.0 * b * c, 8.0 * a * c, 8.0 * a * b)
        squares = [0.0, 0.0, 0.0]
        for across, area in enumerate(areas):
            for axis in range(3):
                squares[axis] += area * half[axis] ** 2 * (1.0 if axis == across else 1.0 / 3.0)
        total = sum(areas)
        x, y, z = (square / total for square in squares)
        return MassShape.central(total, (y + z, x + z, x + y))

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return box_terms(12.0, 1.0, bounds)

    def controller_moments(self, mass: float) -> Vector3:
        x, y, z = self.half_extents
        return (mass / 3.0 * (y * y + z * z), mass / 3.0 * (x * x + z * z), mass / 3.0 * (x * x + y * y))

    @classmethod
    def of_sizes(cls, x: float, y: float, z: float) -> Box:
        return cls((x, y, z))

    def sizes(self) -> tuple[float, ...]:
        return self.half_extents

    def visual_dimensions(self) -> Vector3:
        x, y, z = self.half_extents
        return (2.0 * x, 2.0 * y, 2.0 * z)

    def surface(self, segments: int) -> Surface:
        import numpy as np

        cube = _cube()
        return cube.moved(cube.positions * np.array(self.half_extents))

    def scaled_unit(self) -> tuple[Box, Vector3]:
        return _UNIT, self.half_extents


_UNIT = Box((1.0, 1.0, 1.0))


@functools.cache
def _cube() -> Surface:
    """The box with half extents of 1; others have the same normals, texture coordinates and triangles."""
    import numpy as np

    from carom.description.shapes.surface import Surface

    positions, normals, uvs, triangles = [], [], [], []
    for normal, u, v, corners in SIDES:
        first = len(positions)
        for (a, b), uv in zip(((-1, -1), (1, -1), (1, 1), (-1, 1)), corners, strict=True):
            positions.append([normal[i] + a * u[i] + b * v[i] for i in range(3)])
            normals.append(normal)
            uvs.append(uv)
        triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return Surface(*map(np.array, (positions, normals, uvs, triangles))).ready()
