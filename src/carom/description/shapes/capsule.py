"""Capsules."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import TWELFTH, MassShape, MassTerms, box_terms
from carom.description.shapes.shape import (
    ORIGIN,
    Core,
    Measure,
    Parameter,
    Shape,
    Stretch,
    TextureRule,
    are_equal,
)
from carom.description.transform import Matrix3
from carom.layouts.codes import ShapeKind

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.description.shapes.surface import Surface

# Pictures have positions in single precision.
_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True)
class Capsule(Shape):
    """A cylinder of height `length` along z with a hemisphere of `radius` on each end."""

    radius: float
    length: float

    tag: ClassVar[str] = "capsule"
    mjcf: ClassVar[str] = "capsule"
    size_count: ClassVar[int] = 2
    usd: ClassVar[str] = "Capsule"
    geom: ClassVar[int] = 7
    geom_name: ClassVar[str] = "GEOM_CAPSULE"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("radius", Measure.LENGTH, "radius", "radius", ("Radius", 0.5)),
        Parameter("length", Measure.LENGTH, "length", "height", ("Height", 1.0)),
    )
    bullet_sdf_length: ClassVar[float | None] = 1.0
    sweeps: ClassVar[bool] = True
    margin_is_radius: ClassVar[bool] = True
    texture_rule: ClassVar[TextureRule] = TextureRule.OWN_UPWARDS

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds(ORIGIN, (self.radius, self.radius, self.radius + 0.5 * self.length))

    def scaled(self, factors: Vector3) -> Capsule:
        return Capsule(self.radius * factors[1], self.length * factors[2])

    def lengths(self) -> tuple[float, ...]:
        return (self.radius, self.length)

    def sides(self) -> Vector3:
        side = 2.0 * self.radius
        return (side, side, self.length + side)

    def with_sides(self, x: float, y: float, z: float) -> Capsule:
        if not are_equal(x, y):
            raise ValueError(f"a capsule is round about its z axis: its sides are not {x:g} and {y:g} m")
        if not (z > x or are_equal(x, z)):
            raise ValueError(f"a capsule is at least as long as it is wide, {x:g} m, not {z:g} m")
        return Capsule(0.5 * x, max(z - x, 0.0))

    def stretch(self, sides: NDArray[np.float64], end: int) -> Stretch:
        """Its ends stay round."""
        import numpy as np

        across, length = sides[..., :1] / (2.0 * self.radius), sides[..., 2] - sides[..., 0]
        if end:
            shift = 0.5 * end * (length - across[..., 0] * self.length)
            return Stretch(np.repeat(across, 3, axis=-1), shift)
        along = length / self.length if self.length else np.ones_like(length)
        factors = np.concatenate([across, across, along[..., np.newaxis]], axis=-1)
        return Stretch(factors, np.zeros_like(length))

    def ends_at(self, heights: NDArray[np.floating]) -> NDArray[np.int64]:
        import numpy as np

        half = (0.5 - _ROUNDING) * self.length
        return np.where(heights >= half, 1, np.where(heights <= -half, -1, 0))

    def with_shaft(self) -> Capsule:
        return self if self.length else Capsule(self.radius, self.radius)

    def core(self, *, implicit_cylinder: bool) -> Core:
        return Core(ShapeKind.CAPSULE, (self.radius, 0.5 * self.length, 0.0), self.radius)

    def bullet_margin(self) -> float:
        return self.radius

    def swept_half(self, rotation: Matrix3) -> Vector3:
        x, y, z = (0.5 * self.length * abs(row[2]) + self.radius for row in rotation)
        return (x, y, z)

    def volume(self) -> float:
        return pi * self.radius * self.radius * self.length + 4.0 / 3.0 * pi * self.radius**3

    def solid(self) -> MassShape:
        r, h = self.radius, 0.5 * self.length
        tube, ball = 2.0 * pi * r * r * h, 4.0 / 3.0 * pi * r**3
        volume = tube + ball
        # Each half ball has its centre 3/8 of the radius beyond the end of the tube.
        across = tube * (r * r / 4.0 + h * h / 3.0) + ball * (0.4 * r * r + h * h + 0.75 * r * h)
        along = tube * 0.5 * r * r + ball * 0.4 * r * r
        return MassShape.central(volume, (across / volume, across / volume, along / volume))

    def shell(self) -> MassShape:
        r, h = self.radius, 0.5 * self.length
        side, ball = 4.0 * pi * r * h, 4.0 * pi * r * r
        area = side + ball
        # Each half sphere has its centre half of the radius beyond the end of the tube.
        across = side * (0.5 * r * r + h * h / 3.0) + ball * (2.0 / 3.0 * r * r + h * h + r * h)
        along = side * r * r + ball * 2.0 / 3.0 * r * r
        return MassShape.central(area, (across / area, across / area, along / area))

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return box_terms(1.0, TWELFTH, bounds)

    def controller_moments(self, mass: float) -> Vector3:
        """Those of a capsule along y."""
        radius, length = self.radius, self.length
        # Volumes over π r², which are not rounded to 0 before the sizes are.
        cylinder, half_ball = length, 2.0 / 3.0 * radius
        volume = cylinder + 2.0 * half_ball
        if volume == 0.0:
            return (0.0, 0.0, 0.0)
        cylinder, half_ball = mass * (cylinder / volume), mass * (half_ball / volume)
        across = cylinder * (radius * radius / 4.0 + length * length / 12.0) + 2.0 * half_ball * (
            0.4 * radius * radius + 0.375 * radius * length + 0.5 * length * length
        )
        return (across, (0.5 * cylinder + 0.8 * half_ball) * radius * radius, across)

    @classmethod
    def of_sizes(cls, x: float, y: float, z: float) -> Capsule:
        return cls(x, 2.0 * y)

    def sizes(self) -> tuple[float, ...]:
        return (self.radius, 0.5 * self.length)

    @classmethod
    def fitted(cls, half: Vector3, *, by_bounds: bool) -> Vector3:
        a, b, c = half
        across = max(a, b) if by_bounds else 0.5 * (a + b)
        return (across, max(0.0, c - (across if by_bounds else 0.5 * across)), 0.0)

    def visual_dimensions(self) -> Vector3:
        return (self.length, self.radius, 0.0)

    def surface(self, segments: int) -> Surface:
        from carom.description.shapes.surface import ball_between

        return ball_between(self.radius, self.length, segments)

    def in_bullets_images(self) -> NDArray[np.float64]:
        """No more than the tips and the rims of the shaft."""
        import numpy as np

        from carom.description.shapes.cylinder import rims

        tip = 0.5 * self.length + self.radius
        return np.array([*rims(self.radius, self.length), (0.0, 0.0, tip), (0.0, 0.0, -tip)])
