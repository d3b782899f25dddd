"""Planes."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING, ClassVar

from carom.description.pose import Quaternion, Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import NO_MOMENTS, MassTerms
from carom.description.shapes.shape import ORIGIN, Core, Measure, Parameter, Shape, TextureRule
from carom.description.transform import turn_of_z
from carom.layouts.codes import ShapeKind
from carom.layouts.contacts import MARGIN

if TYPE_CHECKING:
    from carom.description.shapes.surface import Surface

DRAWN_HALF_SIZE = 128.0
"""A plane is drawn as a square whose side is twice this length [m]."""

_UNBOUNDED = 1e30
"""Half extent of planes [m]; large enough to represent an infinite one."""
_X, _Y, _UP = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Plane(Shape):
    """The half space below the origin of its frame; `normal` points out of it.

    Attributes:
        normal: Unit vector.
        size: Half extents along x and y of the part that is seen of a plane whose normal is z [m]; 0 for as
            far as planes are drawn. All of it collides.
    """

    normal: Vector3 = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (0.0, 0.0)

    tag: ClassVar[str] = "plane"
    mjcf: ClassVar[str] = "plane"
    usd: ClassVar[str] = "Plane"
    geom: ClassVar[int] = 6
    geom_name: ClassVar[str] = "GEOM_PLANE"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("normal", Measure.DIRECTION, "normal", "planeNormal"),
    )
    is_unbounded: ClassVar[bool] = True
    is_ground: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.FROM_ABOVE

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds(ORIGIN, (_UNBOUNDED, _UNBOUNDED, _UNBOUNDED))

    def scaled(self, factors: Vector3) -> Plane:
        return self

    def own_turn(self) -> Quaternion:
        return turn_of_z(self.normal)

    def is_floor(self, least: float) -> bool:
        return True

    def core(self, *, implicit_cylinder: bool) -> Core:
        return Core(ShapeKind.PLANE, self.normal, MARGIN)

    def least_extent(self) -> float:
        return 0.0

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return NO_MOMENTS

    def sizes(self) -> tuple[float, ...]:
        """Without an end, with a grid."""
        return (0.0, 0.0, 0.01)

    def collision_data(self, *, implicit_cylinder: bool) -> tuple[int, Vector3, bytes]:
        return self.geom, self.normal, b""

    def surface(self, segments: int) -> Surface:
        """A rectangle, large along a half extent of 0; its texture repeats every two metres."""
        import numpy as np

        from carom.description.shapes.surface import Surface

        is_square = self.size == (0.0, 0.0) or self.normal != _UP
        across, along = _axes(self.normal) if is_square else (_X, _Y)
        width, height = (extent or DRAWN_HALF_SIZE for extent in self.size)
        positions, uvs = [], []
        for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            positions.append([width * a * across[i] + height * b * along[i] for i in range(3)])
            uvs.append((width if a > 0 else 0.0, height if b > 0 else 0.0))
        triangles = [(0, 1, 2), (0, 2, 3)]
        return Surface(*map(np.array, (positions, [self.normal] * 4, uvs, triangles))).ready()


def _axes(n: Vector3) -> tuple[Vector3, Vector3]:
    """Two unit vectors that form a right-handed frame with a unit normal."""
    x, y, z = n
    if abs(z) > 0.5**0.5:
        length = hypot(y, z)
        first = (0.0, -z / length, y / length)
    else:
        length = hypot(x, y)
        first = (-y / length, x / length, 0.0)
    second = (
        y * first[2] - z * first[1],
        z * first[0] - x * first[2],
        x * first[1] - y * first[0],
    )
    return first, second
