"""How a path goes around a sphere or a cylinder.

Both are wrapped in a plane: a sphere in that of its centre and the two points that the path connects, a
cylinder in that across its axis, in which its path is a circle seen along the axis. There a path touches the
circle at the points where lines through its ends are tangents, and follows the arc between them.
"""

import math

import warp as wp

from carom.kernels.types import Int32, Quaternion, Vector2, Vector3, func, real
from carom.layouts.codes import PATH_CYLINDER

_TINY = real(1e-15)
_BISECTIONS = 60
_TURN = real(2.0 * math.pi)


@func
def nearest_to_origin(a: Vector2, b: Vector2) -> Vector2:
    """The point of a line segment that is nearest to the origin."""
    along = b - a
    square = wp.dot(along, along)
    share = real(0.0)
    if square > 0.0:
        share = wp.clamp(-wp.dot(along, a) / square, real(0.0), real(1.0))
    return a + along * share


@func
def tangent_point(a: Vector2, radius: real, side: real) -> Vector2:
    """Where a line from a point touches a circle: clockwise of it if `side` is 1, else (-1) the other way."""
    square = wp.dot(a, a)
    across = side * radius * wp.sqrt(wp.max(square - radius * radius, real(0.0)))
    return (a * (radius * radius) + Vector2(a[1], -a[0]) * across) / square


@func
def turned_from(origin: Vector2, first: Vector2, second: Vector2) -> real:
    """Twice the area of a triangle, positive if it is walked counterclockwise."""
    a, b = first - origin, second - origin
    return a[0] * b[1] - a[1] * b[0]


@func
def are_crossing(a: Vector2, b: Vector2, c: Vector2, d: Vector2) -> bool:
    """Whether the segments from a to b and from c to d cross."""
    return (
        turned_from(a, b, c) * turned_from(a, b, d) < 0.0
        and turned_from(c, d, a) * turned_from(c, d, b) < 0.0
    )


@func
def is_between(a: Vector2, b: Vector2, direction: Vector2) -> bool:
    """Whether a ray from the origin crosses the segment from a to b."""
    whole = a[0] * b[1] - a[1] * b[0]
    before = a[0] * direction[1] - a[1] * direction[0]
    after = direction[0] * b[1] - direction[1] * b[0]
    return whole * before > 0.0 and whole * after > 0.0


@func
def wrapped_outside(a: Vector2, b: Vector2, radius: real, side: Vector2, has_side: Int32):
    """Length of the arc on a circle that a path from a to b follows, and where it begins and ends.

    The arc is negative if the path does not touch the circle: the segment does not meet it, and does not lie
    between it and the side opposite to `side`.
    """
    nothing = real(-1.0)
    first, last = a * real(1.0), b * real(1.0)
    square = radius * radius
    if wp.dot(a, a) < square or wp.dot(b, b) < square:
        return nothing, first, last
    near = nearest_to_origin(a, b)
    if wp.dot(near, near) > square and (has_side == 0 or not is_between(a, b, -side)):
        return nothing, first, last
    best = real(-1e30)
    way = real(1.0)
    choice = real(1.0)
    while choice >= -1.0:
        start, end = tangent_point(a, radius, choice), tangent_point(b, radius, -choice)
        value = -wp.dot(start - end, start - end)
        if has_side != 0:
            # The way whose ends are both near the side.
            value = wp.min(wp.dot(start, side), wp.dot(end, side))
        if are_crossing(a, start, b, end):
            value = real(-1e20)
        if value > best:
            best = value
            way = choice
            first = start
            last = end
        choice -= 2.0
    if best <= -1e20:
        return nothing, a, b
    clockwise = wp.atan2(first[1] * last[0] - first[0] * last[1], wp.dot(first, last)) * way
    if clockwise < 0.0:
        clockwise += _TURN
    return radius * clockwise, first, last


@func
def wrapped_inside(a: Vector2, b: Vector2, radius: real):
    """As `wrapped_outside`, for a path that is held within a circle, which it touches at one point."""
    nothing = real(-1.0)
    to_a, to_b = wp.length(a), wp.length(b)
    near = nearest_to_origin(a, b)
    if to_a <= radius or to_b <= radius or wp.length(near) <= radius:
        return nothing, a, b
    cross = a[0] * b[1] - a[1] * b[0]
    between = wp.abs(wp.atan2(cross, wp.dot(a, b)))
    # The sine of the angle between the path and the radius at the touching point, the same on both sides.
    share_a, share_b = radius / to_a, radius / to_b
    low, high = real(0.0), real(1.0)
    touch = wp.normalize(a / to_a + b / to_b) * radius
    if wp.asin(share_a) + wp.asin(share_b) - _TURN * 0.5 + between < 0.0:
        step = Int32(0)
        while step < _BISECTIONS:
            middle = 0.5 * (low + high)
            rest = wp.asin(share_a * middle) + wp.asin(share_b * middle) - 2.0 * wp.asin(middle) + between
            if rest > 0.0:
                low = middle
            else:
                high = middle
            step += 1
        angle = wp.asin(low) - wp.asin(share_a * low)
        if cross < 0.0:
            angle = -angle
        c, s = wp.cos(angle), wp.sin(angle)
        touch = Vector2(c * a[0] - s * a[1], s * a[0] + c * a[1]) * (radius / to_a)
    return real(0.0), touch, touch


@func
def across(a: Vector3, b: Vector3) -> Vector3:
    """A unit vector perpendicular to both, or to the first if they are parallel."""
    normal = wp.cross(a, b)
    if wp.length(normal) < _TINY:
        smallest = Vector3(1.0, 0.0, 0.0)
        if wp.abs(a[1]) < wp.abs(a[0]) and wp.abs(a[1]) <= wp.abs(a[2]):
            smallest = Vector3(0.0, 1.0, 0.0)
        elif wp.abs(a[2]) < wp.abs(a[0]):
            smallest = Vector3(0.0, 0.0, 1.0)
        normal = wp.cross(a, smallest)
    return wp.normalize(normal)


@func
def wrapped(
    kind: Int32,
    center: Vector3,
    turn: Quaternion,
    radius: real,
    start: Vector3,
    end: Vector3,
    side: Vector3,
    has_side: Int32,
):
    """Length on a sphere or cylinder of a path from `start` to `end`, and where it touches first and last.

    All points are in world axes. The length is negative if the path does not touch.
    """
    a, b = wp.quat_rotate_inv(turn, start - center), wp.quat_rotate_inv(turn, end - center)
    s = wp.quat_rotate_inv(turn, side - center)
    x, y = Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0)
    inside = wp.length(Vector2(s[0], s[1])) < radius
    if kind != PATH_CYLINDER:
        inside = wp.length(s) < radius
        x = wp.normalize(a)
        y = wp.cross(across(a, b), x)
    flat_a, flat_b = Vector2(wp.dot(a, x), wp.dot(a, y)), Vector2(wp.dot(b, x), wp.dot(b, y))
    flat_side = wp.normalize(Vector2(wp.dot(s, x), wp.dot(s, y)))
    if has_side != 0 and inside:
        arc, first, last = wrapped_inside(flat_a, flat_b, radius)
    else:
        arc, first, last = wrapped_outside(flat_a, flat_b, radius, flat_side, has_side)
    length = arc
    begin, finish = x * first[0] + y * first[1], x * last[0] + y * last[1]
    if kind == PATH_CYLINDER and arc >= 0.0:
        before, after = wp.length(flat_a - first), wp.length(flat_b - last)
        whole = wp.max(before + arc + after, _TINY)
        rise = b[2] - a[2]
        begin[2] = a[2] + rise * before / whole
        finish[2] = a[2] + rise * (before + arc) / whole
        length = wp.length(Vector2(arc, finish[2] - begin[2]))
    return length, center + wp.quat_rotate(turn, begin), center + wp.quat_rotate(turn, finish)
