"""Spheres."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import NO_TERM, MassShape, MassTerm, MassTerms
from carom.description.shapes.shape import ORIGIN, Core, Measure, Parameter, Shape, TextureRule, are_equal
from carom.layouts.codes import PathKind, ShapeKind

if TYPE_CHECKING:
    from carom.description.shapes.surface import Surface


@dataclass(frozen=True, slots=True)
class Sphere(Shape):
    """A sphere centred on its frame."""

    radius: float

    tag: ClassVar[str] = "sphere"
    mjcf: ClassVar[str] = "sphere"
    size_count: ClassVar[int] = 1
    usd: ClassVar[str] = "Sphere"
    geom: ClassVar[int] = 2
    geom_name: ClassVar[str] = "GEOM_SPHERE"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("radius", Measure.LENGTH, "radius", "radius", ("Radius", 1.0)),
    )
    bullet_scales_sdf: ClassVar[bool] = False
    tendon_path: ClassVar[PathKind | None] = PathKind.SPHERE
    bounds_turn: ClassVar[bool] = False
    margin_is_radius: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.OWN

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds(ORIGIN, (self.radius, self.radius, self.radius))

    def scaled(self, factors: Vector3) -> Sphere:
        return Sphere(self.radius * factors[0])

    def lengths(self) -> tuple[float, ...]:
        return (self.radius,)

    def sides(self) -> Vector3:
        side = 2.0 * self.radius
        return (side, side, side)

    def with_sides(self, x: float, y: float, z: float) -> Sphere:
        if not (are_equal(x, y) and are_equal(x, z)):
            raise ValueError(f"the three sides of a sphere are equal, not {x:g}, {y:g} and {z:g} m")
        return Sphere(0.5 * x)

    def core(self, *, implicit_cylinder: bool) -> Core:
        return Core(ShapeKind.SPHERE, (self.radius, 0.0, 0.0), self.radius)

    def bullet_margin(self) -> float:
        return self.radius

    def volume(self) -> float:
        return 4.0 / 3.0 * pi * self.radius**3

    def solid(self) -> MassShape:
        moment = 0.4 * self.radius * self.radius
        return MassShape.central(self.volume(), (moment, moment, moment))

    def shell(self) -> MassShape:
        r = self.radius
        moment = 2.0 / 3.0 * r * r
        return MassShape.central(4.0 * pi * r * r, (moment, moment, moment))

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        ball = MassTerm(1.0, (0.4, self.radius, self.radius)), NO_TERM
        return (ball, ball, ball)

    def controller_moments(self, mass: float) -> Vector3:
        moment = 0.4 * mass * self.radius * self.radius
        return (moment, moment, moment)

    @classmethod
    def of_sizes(cls, x: float, y: float, z: float) -> Sphere:
        return cls(x)

    def sizes(self) -> tuple[float, ...]:
        return (self.radius,)

    @classmethod
    def fitted(cls, half: Vector3, *, by_bounds: bool) -> Vector3:
        a, b, c = half
        return (max(half) if by_bounds else (a + b + c) / 3.0, 0.0, 0.0)

    def visual_dimensions(self) -> Vector3:
        return (self.radius, 0.0, 0.0)

    def collision_data(self, *, implicit_cylinder: bool) -> tuple[int, Vector3, bytes]:
        return self.geom, (self.radius, self.radius, self.radius), b""

    def surface(self, segments: int) -> Surface:
        from carom.description.shapes.surface import ball_between

        return ball_between(self.radius, 0.0, segments)

    def scaled_unit(self) -> tuple[Sphere, Vector3]:
        return _UNIT, (self.radius, self.radius, self.radius)

    def in_bullets_images(self) -> float:
        return float(self.radius)


_UNIT = Sphere(1.0)
