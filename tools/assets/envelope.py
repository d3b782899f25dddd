"""Room for collision shapes: primitives placed so that together they fill given bounds exactly.

PyBullet derives a link's default inertia from the extents of its collision shapes, so shapes that span
the same bounds as another file's give the same inertia.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot, sqrt

from tools.assets.parts import QUARTER_TURN, Box, Capsule, Shape, Vector3

COMPOUND_MARGIN = 0.001
"""PyBullet widens a link's bounds by this when its shapes do not coincide with the inertial frame."""

ALONG: dict[str, Vector3] = {
    "x": (0.0, QUARTER_TURN, 0.0),
    "y": (QUARTER_TURN, 0.0, 0.0),
    "z": (0.0, 0.0, 0.0),
}


def rod(start: Vector3, end: Vector3, radius: float) -> Shape:
    """A capsule whose half balls are centred on two points."""
    x, y, z = (b - a for a, b in zip(start, end, strict=True))
    level = hypot(x, y)
    middle = ((start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0, (start[2] + end[2]) / 2.0)
    return Shape(Capsule(radius, hypot(level, z)), middle, (0.0, atan2(level, z), atan2(y, x)))


@dataclass(frozen=True)
class Envelope:
    """Axis-aligned bounds in the link frame, as getAABB reports them for a link with several shapes."""

    low: Vector3
    high: Vector3

    @classmethod
    def of_inertia(cls, centre: Vector3, inertia: Vector3, mass: float) -> Envelope:
        """The box around a centre that has the given principal inertias."""
        (a, b, c), (x, y, z) = inertia, centre
        dx, dy, dz = (sqrt(1.5 * part / mass) for part in (b + c - a, c + a - b, a + b - c))
        return cls((x - dx, y - dy, z - dz), (x + dx, y + dy, z + dz))

    def inner(self, axis: str) -> tuple[float, float]:
        """The range the shapes themselves must span along one axis."""
        number = "xyz".index(axis)
        return self.low[number] + COMPOUND_MARGIN, self.high[number] - COMPOUND_MARGIN

    def width(self, axis: str) -> float:
        """Length of `inner`."""
        low, high = self.inner(axis)
        return high - low

    def capsule(self, along: str, radius: float, **place: float | str) -> Shape:
        """A capsule that spans the bounds along one axis.

        Args:
            along: The axis, x, y or z.
            radius: [m].
            **place: For each other axis "low" or "high" to touch that bound, or its centre [m].
                For the axis itself `start` and `stop` cut the span short.
        """
        low, high = self.inner(along)
        low, high = float(place.get("start", low)), float(place.get("stop", high))
        centre = {along: (low + high) / 2.0}
        for axis in "xyz".replace(along, ""):
            first, last = self.inner(axis)
            where = place[axis]
            if where == "low":
                centre[axis] = first + radius
            elif where == "high":
                centre[axis] = last - radius
            else:
                centre[axis] = float(where)
        length = high - low - 2.0 * radius
        if length <= 0.0:
            raise ValueError(f"no capsule of radius {radius} fits between {low} and {high}")
        return Shape(Capsule(radius, length), (centre["x"], centre["y"], centre["z"]), ALONG[along])

    def box(self, **limits: tuple[float | None, float | None]) -> Shape:
        """A box out to the bounds, cut short where a limit (low, high) is given for an axis."""
        spans: list[tuple[float, float]] = []
        for axis in "xyz":
            first, last = self.inner(axis)
            low, high = limits.get(axis, (None, None))
            spans.append((first if low is None else low, last if high is None else high))
        (x0, x1), (y0, y1), (z0, z1) = spans
        return Shape(Box((x1 - x0, y1 - y0, z1 - z0)), ((x0 + x1) / 2.0, (y0 + y1) / 2.0, (z0 + z1) / 2.0))
