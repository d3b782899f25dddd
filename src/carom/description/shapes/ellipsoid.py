"""Ellipsoids."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import MassShape, MassTerms, box_terms
from carom.description.shapes.shape import (
    ORIGIN,
    Facets,
    Measure,
    Parameter,
    Shape,
    TextureRule,
    as_unknown_mesh,
)
from carom.native.trigonometry import cos, sin

if TYPE_CHECKING:
    from carom.description.shapes.surface import Surface

# Circles of latitude and longitude of the facets that stand for it where its surface is not asked.
_RINGS, _SECTORS = 9, 16


@dataclass(frozen=True, slots=True)
class Ellipsoid(Shape):
    """An ellipsoid centred on its frame, its axes along those of the frame.

    Attributes:
        half_axes: Half its size along x, y and z [m].
    """

    half_axes: Vector3

    mjcf: ClassVar[str] = "ellipsoid"
    size_count: ClassVar[int] = 3
    parameters: ClassVar[tuple[Parameter, ...]] = (Parameter("half_axes", Measure.LENGTHS, "radii", ""),)
    margin_is_radius: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.OWN

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds(ORIGIN, self.half_axes)

    def scaled(self, factors: Vector3) -> Ellipsoid:
        x, y, z = (abs(factor) * half for factor, half in zip(factors, self.half_axes, strict=True))
        return Ellipsoid((x, y, z))

    def lengths(self) -> tuple[float, ...]:
        return self.half_axes

    def sides(self) -> Vector3:
        x, y, z = self.half_axes
        return (2.0 * x, 2.0 * y, 2.0 * z)

    def with_sides(self, x: float, y: float, z: float) -> Ellipsoid:
        return Ellipsoid((0.5 * x, 0.5 * y, 0.5 * z))

    def facets(self) -> Facets:
        import numpy as np

        points = [(0.0, 0.0, 1.0)]
        for ring in range(1, _RINGS + 1):
            polar = pi * ring / (_RINGS + 1)
            for sector in range(_SECTORS):
                angle = 2.0 * pi * sector / _SECTORS
                points.append((sin(polar) * cos(angle), sin(polar) * sin(angle), cos(polar)))
        points.append((0.0, 0.0, -1.0))
        faces = []
        for sector in range(_SECTORS):
            beside = (sector + 1) % _SECTORS
            faces.append([0, 1 + sector, 1 + beside])
            for ring in range(_RINGS - 1):
                above, below = 1 + ring * _SECTORS, 1 + (ring + 1) * _SECTORS
                faces.append([above + sector, below + sector, below + beside, above + beside])
            last = 1 + (_RINGS - 1) * _SECTORS
            faces.append([last + beside, last + sector, len(points) - 1])
        return Facets(np.array(points) * self.half_axes, faces, 0.0, on_grid=False, half_axes=self.half_axes)

    def bullet_margin(self) -> float:
        return 0.0

    def volume(self) -> float:
        a, b, c = self.half_axes
        return 4.0 / 3.0 * pi * a * b * c

    def solid(self) -> MassShape:
        a, b, c = self.half_axes
        moments = (0.2 * (b * b + c * c), 0.2 * (a * a + c * c), 0.2 * (a * a + b * b))
        return MassShape.central(self.volume(), moments)

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return box_terms(12.0, 1.0, bounds)

    def visual_data(self) -> tuple[int, Vector3, bytes]:
        return as_unknown_mesh()

    @classmethod
    def of_sizes(cls, x: float, y: float, z: float) -> Ellipsoid:
        return cls((x, y, z))

    def sizes(self) -> tuple[float, ...]:
        return self.half_axes

    def surface(self, segments: int) -> Surface:
        """A sphere that is stretched, with the normals of the ellipsoid."""
        import numpy as np

        from carom.description.shapes.surface import Surface, ball_between

        ball = ball_between(1.0, 0.0, segments)
        # Sites may have no extent.
        unit, half = np.asarray(ball.positions, dtype=np.float64), np.maximum(self.half_axes, 1e-9)
        normals = unit / half
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        return Surface(unit * half, normals, ball.uvs, ball.triangles).ready()
