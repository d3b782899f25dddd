"""Boxes with round edges and corners."""

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

# Half extents that are left of the box within at least, so that its faces have normals [m].
_LEAST = 1e-9
_SIGNS = (-1.0, 1.0)
# The corners of the box within, x slowest, and its faces, counter-clockwise seen from outside.
_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
_QUADRANTS = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))


@dataclass(frozen=True, slots=True)
class RoundedBox(Shape):
    """A cuboid centred on its frame whose edges and corners are round: a smaller one, and all near to it.

    Attributes:
        half_extents: Half its size along x, y and z, rounding included [m].
        radius: Of its edges and corners, at most the least half extent [m].
    """

    half_extents: Vector3
    radius: float

    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("half_extents", Measure.LENGTHS, "size", "", per_field=2.0),
        Parameter("radius", Measure.LENGTH, "radius", ""),
    )
    margin_is_radius: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.OWN

    def within(self) -> Vector3:
        """Half extents of the box that this one is around, at the distance of the radius [m]."""
        x, y, z = (max(half - self.radius, _LEAST) for half in self.half_extents)
        return (x, y, z)

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds(ORIGIN, self.half_extents)

    def scaled(self, factors: Vector3) -> RoundedBox:
        fx, fy, fz = factors
        if not fx == fy == fz:
            raise ValueError("the edges of a rounded box have to stay round: scale it by one factor")
        x, y, z = self.half_extents
        return RoundedBox((x * fx, y * fx, z * fx), self.radius * fx)

    def lengths(self) -> tuple[float, ...]:
        return (*self.half_extents, self.radius)

    def sides(self) -> Vector3:
        x, y, z = self.half_extents
        return (2.0 * x, 2.0 * y, 2.0 * z)

    def with_sides(self, x: float, y: float, z: float) -> RoundedBox:
        if min(x, y, z) < 2.0 * self.radius:
            raise ValueError(
                f"a side of {min(x, y, z):g} m is shorter than edges with a radius of {self.radius:g} m"
            )
        return RoundedBox((0.5 * x, 0.5 * y, 0.5 * z), self.radius)

    def is_floor(self, least: float) -> bool:
        return sum(2.0 * half > least for half in self.half_extents) >= 2

    def facets(self) -> Facets:
        import numpy as np

        a, b, c = self.within()
        points = [(x * a, y * b, z * c) for x in _SIGNS for y in _SIGNS for z in _SIGNS]
        return Facets(np.array(points), _FACES, self.radius, on_grid=False)

    def bullet_margin(self) -> float:
        return self.radius

    def volume(self) -> float:
        (a, b, c), r = self.within(), self.radius
        faces, edges = a * b + b * c + c * a, a + b + c
        return 8.0 * a * b * c + 8.0 * r * faces + 2.0 * pi * r * r * edges + 4.0 / 3.0 * pi * r**3

    def solid(self) -> MassShape:
        a, b, c = self.within()
        volume, r = self.volume(), self.radius
        xx, yy, zz = (_second_moment(*it, r) / volume for it in ((a, b, c), (b, c, a), (c, a, b)))
        return MassShape.central(volume, (yy + zz, xx + zz, xx + yy))

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return box_terms(12.0, 1.0, bounds)

    def visual_data(self) -> tuple[int, Vector3, bytes]:
        return as_unknown_mesh()

    def surface(self, segments: int) -> Surface:
        """Eight parts of a sphere, with faces and edges between them."""
        import numpy as np

        from carom.description.shapes.surface import Surface

        steps = segments // 4
        quarter = [0.5 * pi * step / steps for step in range(steps + 1)]
        # Around z, then from below: direction, sign of the corner that it belongs to, texture coordinate.
        around = np.array(
            [
                (
                    cos(angle + 0.5 * pi * place),
                    sin(angle + 0.5 * pi * place),
                    *signs,
                    0.25 * (place + angle / pi * 2.0),
                )
                for place, signs in enumerate(_QUADRANTS)
                for angle in quarter
            ]
        )
        around = np.vstack([around, around[:1] + np.array((0.0, 0.0, 0.0, 0.0, 1.0))])
        upwards = np.array(
            [
                (cos(angle), sin(angle), sign, 0.5 + angle / pi)
                for sign, start in ((-1.0, -0.5 * pi), (1.0, 0.0))
                for angle in (start + it for it in quarter)
            ]
        )
        shape = (len(upwards), len(around))
        normals = np.empty((*shape, 3))
        normals[..., :2] = upwards[:, None, :1] * around[None, :, :2]
        normals[..., 2] = upwards[:, None, 1]
        corners = np.empty((*shape, 3))
        corners[..., :2] = around[None, :, 2:4]
        corners[..., 2] = upwards[:, None, 2]
        positions = (corners * np.array(self.within()) + self.radius * normals).reshape(-1, 3)
        uvs = np.empty((*shape, 2))
        uvs[..., 0] = around[None, :, 4]
        uvs[..., 1] = upwards[:, None, 3]
        row, low = shape[1], np.arange(shape[0] - 1)[:, None] * shape[1] + np.arange(shape[1] - 1)[None]
        low = low.reshape(-1)
        sides = [np.stack([low, low + 1, low + row], 1), np.stack([low + 1, low + row + 1, low + row], 1)]
        # The faces below and above lie between four points, each of which is a whole part of its ring.
        first, last = (start + np.arange(4) * (steps + 1) for start in (0, (shape[0] - 1) * row))
        caps = [first[[0, 2, 1]], first[[0, 3, 2]], last[[0, 1, 2]], last[[0, 2, 3]]]
        triangles = np.concatenate([*sides, np.array(caps)])
        a, b, c = positions[triangles].transpose(1, 0, 2)
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        # At the poles some have no area.
        triangles = triangles[areas > 1e-9 * max(self.half_extents) ** 2 / segments]
        return Surface(positions, normals, uvs, triangles).ready()


def _second_moment(a: float, b: float, c: float, r: float) -> float:
    """The integral of x² over a rounded box, by half extents of the box within and the radius [m⁵]."""
    third = a * a / 3.0
    # The box and the plates on its faces across y and z, and across x.
    plates = 8.0 * third * (a * b * c + r * a * b + r * a * c) + 8.0 * b * c * ((a + r) ** 3 - a**3) / 3.0
    # Quarters of cylinders along x, and those along y and z, which lie beyond a.
    edges = 2.0 * pi * r * r * a * third
    edges += 2.0 * (b + c) * (pi * r * r * a * a + 8.0 / 3.0 * a * r**3 + 0.25 * pi * r**4)
    # Eighths of a ball.
    corners = 4.0 / 3.0 * pi * r**3 * a * a + pi * a * r**4 + 4.0 / 15.0 * pi * r**5
    return plates + edges + corners
