"""How a path goes around a sphere or a cylinder: as `kernels.tendons.wrapping`, for one path on the host."""

from __future__ import annotations

from math import hypot, sqrt
from typing import NamedTuple

from carom.description.pose import Pose, Vector3
from carom.description.transform import compose, inverse
from carom.layouts.codes import PathKind
from carom.native.trigonometry import asin, atan2, cos, sin

Point = tuple[float, float]
_PI = 3.14159265358979323846
_BISECTIONS = 60


class Wrap(NamedTuple):
    """The part of a path on a sphere or cylinder: its length, and where it touches first and last."""

    length: float
    begin: Vector3
    end: Vector3


def wrapped(
    kind: PathKind, frame: Pose, radius: float, start: Vector3, end: Vector3, side: Vector3 | None
) -> Wrap | None:
    """The part of a path that is on a sphere or cylinder; None if it does not touch. All in world axes."""
    into = inverse(frame)
    a, b = compose(into, Pose(start)).position, compose(into, Pose(end)).position
    s = None if side is None else compose(into, Pose(side)).position
    x, y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    if kind is PathKind.SPHERE:
        x = _unit(a)
        y = _cross(_across(a, b), x)
    flat_a, flat_b = (_dot(a, x), _dot(a, y)), (_dot(b, x), _dot(b, y))
    if s is None:
        found = _outside(flat_a, flat_b, radius, None)
    elif (_length(s) if kind is PathKind.SPHERE else hypot(s[0], s[1])) < radius:
        found = _inside(flat_a, flat_b, radius)
    else:
        flat = (_dot(s, x), _dot(s, y))
        size = hypot(*flat)
        found = _outside(flat_a, flat_b, radius, (flat[0] / size, flat[1] / size) if size else flat)
    if found is None:
        return None
    arc, first, last = found
    low, high = 0.0, 0.0
    if kind is PathKind.CYLINDER:
        before = hypot(flat_a[0] - first[0], flat_a[1] - first[1])
        after = hypot(flat_b[0] - last[0], flat_b[1] - last[1])
        whole = max(before + arc + after, 1e-15)
        low = a[2] + (b[2] - a[2]) * before / whole
        high = a[2] + (b[2] - a[2]) * (before + arc) / whole
    begin, finish = (
        compose(
            frame, Pose((p[0] * x[0] + p[1] * y[0], p[0] * x[1] + p[1] * y[1], p[0] * x[2] + p[1] * y[2] + z))
        )
        for p, z in ((first, low), (last, high))
    )
    return Wrap(hypot(arc, high - low), begin.position, finish.position)


def _outside(a: Point, b: Point, radius: float, side: Point | None) -> tuple[float, Point, Point] | None:
    square = radius * radius
    if a[0] * a[0] + a[1] * a[1] < square or b[0] * b[0] + b[1] * b[1] < square:
        return None
    near = _nearest(a, b)
    if near[0] * near[0] + near[1] * near[1] > square and (
        side is None or not _is_between(a, b, (-side[0], -side[1]))
    ):
        return None
    choices: list[tuple[float, float, Point, Point]] = []
    for way in (1.0, -1.0):
        first, last = _tangent(a, radius, way), _tangent(b, radius, -way)
        if not _cross_each_other(a, first, b, last):
            if side is None:
                value = -((first[0] - last[0]) ** 2 + (first[1] - last[1]) ** 2)
            else:
                # The way whose ends are both near the side.
                value = min(end[0] * side[0] + end[1] * side[1] for end in (first, last))
            choices.append((value, way, first, last))
    if not choices:
        return None
    _, way, first, last = max(choices, key=lambda it: it[0])
    clockwise = way * atan2(first[1] * last[0] - first[0] * last[1], first[0] * last[0] + first[1] * last[1])
    return radius * (clockwise + 2.0 * _PI if clockwise < 0.0 else clockwise), first, last


def _inside(a: Point, b: Point, radius: float) -> tuple[float, Point, Point] | None:
    to_a, to_b = hypot(*a), hypot(*b)
    if to_a <= radius or to_b <= radius or hypot(*_nearest(a, b)) <= radius:
        return None
    cross = a[0] * b[1] - a[1] * b[0]
    between = abs(atan2(cross, a[0] * b[0] + a[1] * b[1]))
    share_a, share_b = radius / to_a, radius / to_b
    if asin(share_a) + asin(share_b) - _PI + between < 0.0:
        low, high = 0.0, 1.0
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            rest = asin(share_a * middle) + asin(share_b * middle) - 2.0 * asin(middle) + between
            low, high = (middle, high) if rest > 0.0 else (low, middle)
        angle = asin(low) - asin(share_a * low)
        c, s = cos(angle), sin(angle if cross >= 0.0 else -angle)
        touch = share_a * (c * a[0] - s * a[1]), share_a * (s * a[0] + c * a[1])
    else:
        middle = a[0] / to_a + b[0] / to_b, a[1] / to_a + b[1] / to_b
        size = hypot(*middle) or 1.0
        touch = radius * middle[0] / size, radius * middle[1] / size
    return 0.0, touch, touch


def _nearest(a: Point, b: Point) -> Point:
    x, y = b[0] - a[0], b[1] - a[1]
    square = x * x + y * y
    share = min(max(-(x * a[0] + y * a[1]) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return a[0] + x * share, a[1] + y * share


def _is_between(a: Point, b: Point, direction: Point) -> bool:
    """Whether a ray from the origin crosses the segment from a to b."""
    origin = (0.0, 0.0)
    whole = _turn(origin, a, b)
    return whole * _turn(origin, a, direction) > 0.0 and whole * _turn(origin, direction, b) > 0.0


def _tangent(a: Point, radius: float, way: float) -> Point:
    square = a[0] * a[0] + a[1] * a[1]
    aside = way * radius * sqrt(max(square - radius * radius, 0.0))
    x, y = a[0] * radius * radius + a[1] * aside, a[1] * radius * radius - a[0] * aside
    return x / square, y / square


def _turn(origin: Point, a: Point, b: Point) -> float:
    return (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0])


def _cross_each_other(a: Point, b: Point, c: Point, d: Point) -> bool:
    return _turn(a, b, c) * _turn(a, b, d) < 0.0 and _turn(c, d, a) * _turn(c, d, b) < 0.0


def _across(a: Vector3, b: Vector3) -> Vector3:
    normal = _cross(a, b)
    if _length(normal) < 1e-15:
        smallest = min(range(3), key=lambda axis: abs(a[axis]))
        axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        normal = _cross(a, axes[smallest])
    return _unit(normal)


def _dot(a: Vector3, b: Vector3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector3, b: Vector3) -> Vector3:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _length(a: Vector3) -> float:
    return hypot(*a)


def _unit(a: Vector3) -> Vector3:
    size = _length(a) or 1.0
    return a[0] / size, a[1] / size, a[2] / size
