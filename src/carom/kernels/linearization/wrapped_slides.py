"""How the points slide where a path touches a sphere or a cylinder, by changes of the ends of the path.

All vectors are from the centre, in axes that turn with what is wrapped. A path touches a circle in a plane:
where a line through one of its ends is a tangent, or, held within, where both its parts have equal angles.
"""

import math

import warp as wp

from carom.kernels.types import Vector3, func, real

_TINY = real(1e-15)
_TURN = real(2.0 * math.pi)


@func
def flat(a: Vector3, axis: Vector3) -> Vector3:
    """The part of a vector across an axis."""
    return a - axis * wp.dot(axis, a)


@func
def tangent_slide(touch: Vector3, end: Vector3, change: Vector3, normal: Vector3) -> Vector3:
    """How a point slides where the line through an end touches a circle, by a change of that end."""
    along = wp.cross(normal, touch)
    reach = wp.dot(along, end)
    return along * wp.where(wp.abs(reach) > _TINY, -wp.dot(touch, change) / reach, real(0.0))


@func
def reflecting_slide(
    touch: Vector3, a: Vector3, b: Vector3, change_a: Vector3, change_b: Vector3, normal: Vector3
) -> Vector3:
    """How a point slides where a path between two ends touches a circle from without, held by it within."""
    along = wp.cross(normal, touch)
    to_a, to_b = a - touch, b - touch
    length_a, length_b = wp.length(to_a), wp.length(to_b)
    u, v = to_a / length_a, to_b / length_b
    pulled = wp.dot(along, change_a - u * wp.dot(u, change_a)) / length_a
    pulled += wp.dot(along, change_b - v * wp.dot(v, change_b)) / length_b
    square, across_u, across_v = wp.dot(along, along), wp.dot(along, u), wp.dot(along, v)
    held = wp.dot(touch, u + v) + (square - across_u * across_u) / length_a
    held += (square - across_v * across_v) / length_b
    return along * (pulled / held)


@func
def tilt_slide(touch: Vector3, a: Vector3, b: Vector3, change_a: Vector3, change_b: Vector3) -> Vector3:
    """How a point of a sphere slides out of the plane of the centre and both ends, which tilts."""
    normal = wp.cross(a, b)
    square = wp.dot(normal, normal)
    tilted = wp.cross(change_a, b) + wp.cross(a, change_b)
    return normal * wp.where(square > _TINY * _TINY, -wp.dot(touch, tilted) / square, real(0.0))


@func
def sphere_slides(
    a: Vector3,
    b: Vector3,
    begin: Vector3,
    finish: Vector3,
    inside: bool,
    change_a: Vector3,
    change_b: Vector3,
):
    """How the first and the last point slide on a sphere that a path from a to b touches."""
    normal = wp.normalize(wp.cross(a, b))
    first = tilt_slide(begin, a, b, change_a, change_b)
    last = tilt_slide(finish, a, b, change_a, change_b)
    if inside:
        along = reflecting_slide(begin, a, b, change_a, change_b, normal)
        first += along
        last += along
    else:
        first += tangent_slide(begin, a, change_a, normal)
        last += tangent_slide(finish, b, change_b, normal)
    return first, last


@func
def cylinder_slides(
    axis: Vector3,
    a: Vector3,
    b: Vector3,
    begin: Vector3,
    finish: Vector3,
    inside: bool,
    change_a: Vector3,
    change_b: Vector3,
):
    """As `sphere_slides`, on a cylinder; the path rises along its axis as evenly as it goes around."""
    touch_a, touch_b = flat(begin, axis), flat(finish, axis)
    flat_a, flat_b = flat(a, axis), flat(b, axis)
    moved_a, moved_b = flat(change_a, axis), flat(change_b, axis)
    arc, longer = real(0.0), real(0.0)
    if inside:
        first = reflecting_slide(touch_a, flat_a, flat_b, moved_a, moved_b, axis)
        last = first * real(1.0)
    else:
        first = tangent_slide(touch_a, flat_a, moved_a, axis)
        last = tangent_slide(touch_b, flat_b, moved_b, axis)
        radius = wp.length(touch_a)
        way = wp.where(wp.dot(wp.cross(axis, touch_a), touch_a - flat_a) >= 0.0, real(1.0), real(-1.0))
        angle = way * wp.atan2(wp.dot(axis, wp.cross(touch_a, touch_b)), wp.dot(touch_a, touch_b))
        if angle < 0.0:
            angle += _TURN
        arc = radius * angle
        turned = wp.dot(axis, wp.cross(touch_b, last)) - wp.dot(axis, wp.cross(touch_a, first))
        longer = way * turned / radius
    to_a, to_b = flat_a - touch_a, flat_b - touch_b
    before, after = wp.length(to_a), wp.length(to_b)
    whole = wp.max(before + arc + after, _TINY)
    before_grows = wp.dot(to_a, moved_a - first) / wp.max(before, _TINY)
    after_grows = wp.dot(to_b, moved_b - last) / wp.max(after, _TINY)
    whole_grows = before_grows + longer + after_grows
    rise, steeper = wp.dot(axis, b - a), wp.dot(axis, change_b - change_a)
    share, share_at_end = before / whole, (before + arc) / whole
    up = wp.dot(axis, change_a) + steeper * share + rise * (before_grows - share * whole_grows) / whole
    up_at_end = wp.dot(axis, change_a) + steeper * share_at_end
    up_at_end += rise * (before_grows + longer - share_at_end * whole_grows) / whole
    return first + axis * up, last + axis * up_at_end
