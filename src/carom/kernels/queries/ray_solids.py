"""Ray tests with convex shapes, in the frame of the shape.

A ray goes from `start` to `start + way`; positions on it are fractions of `way`. A ray that starts inside a
shape does not hit it, with one exception, as in PyBullet: a ray that starts in the margin around the core of
a shape and goes towards the core hits at fraction 0. The core of a sphere is its centre, that of a capsule
its axis; boxes, cylinders and hulls have thin margins. A ray of length zero hits nothing. Each function
returns the fraction, which is `MISS` if there is no hit, and the outward normal.
"""

import warp as wp

from carom.kernels.types import Vector3, func, real
from carom.layouts.contacts import MARGIN

MISS = real(2.0)
TINY = real(1.0e-30)
GRAZE = real(1.0e-3)
"""Distance from a convex shape at which a ray hits it, see `ray_grazing` [m]."""
THICKNESS = real(MARGIN)
"""Thickness of the margin around the core of boxes and cylinders [m]."""


@func
def ray_from_margin(from_core: Vector3, way: Vector3):
    """Ray that starts in the margin; `from_core` is its start relative to the core's nearest point."""
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    if wp.dot(from_core, way) < 0.0:
        fraction = real(0.0)
        normal = wp.normalize(from_core)
    return fraction, normal


@func
def beyond(x: real, core: real) -> real:
    """Signed distance of a coordinate from the interval [-core, core]; `core` < 0 counts as 0."""
    max_distance = wp.max(core, real(0.0))
    return x - wp.clamp(x, -max_distance, max_distance)


@func
def ray_ball(start: Vector3, way: Vector3, center: Vector3, radius: real):
    """Ray against a sphere."""
    offset = start - center
    a = wp.length_sq(way)
    b = wp.dot(offset, way)
    c = wp.length_sq(offset) - radius * radius
    root = b * b - a * c
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    if a > TINY and c > 0.0 and b < 0.0 and root >= 0.0:
        at = c / (-b + wp.sqrt(root))
        if at <= 1.0:
            fraction = at
            normal = wp.normalize(offset + way * at)
    elif c <= 0.0:
        fraction, normal = ray_from_margin(offset, way)
    return fraction, normal


@func
def ray_ellipsoid(start: Vector3, way: Vector3, half_axes: Vector3):
    """Ray against an ellipsoid: where it is a ball, along stretched axes."""
    origin = wp.cw_div(start, half_axes)
    fraction, normal = ray_ball(origin, wp.cw_div(way, half_axes), Vector3(0.0, 0.0, 0.0), real(1.0))
    return fraction, wp.normalize(wp.cw_div(normal, half_axes))


@func
def ray_box(start: Vector3, way: Vector3, size: Vector3):
    """Ray against a box around the origin with half extents `size`."""
    enter = real(-1.0)
    leave = real(1.0)
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    if wp.abs(start[0]) <= size[0] and wp.abs(start[1]) <= size[1] and wp.abs(start[2]) <= size[2]:
        from_core = Vector3(
            beyond(start[0], size[0] - THICKNESS),
            beyond(start[1], size[1] - THICKNESS),
            beyond(start[2], size[2] - THICKNESS),
        )
        fraction, normal = ray_from_margin(from_core, way)
        return fraction, normal
    for axis in range(3):
        if way[axis] == 0.0:
            if wp.abs(start[axis]) > size[axis]:
                leave = real(-2.0)
        else:
            near = (-size[axis] - start[axis]) / way[axis]
            far = (size[axis] - start[axis]) / way[axis]
            if near > far:
                swapped = near
                near = far
                far = swapped
            if near > enter:
                enter = near
                normal = Vector3(0.0, 0.0, 0.0)
                normal[axis] = -wp.sign(way[axis])
            leave = wp.min(leave, far)
    if enter >= 0.0 and enter <= leave:
        fraction = enter
    return fraction, normal


@func
def ray_tube(start: Vector3, way: Vector3, radius: real, half_length: real):
    """Ray from outside against the lateral surface of a cylinder along z."""
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    a = way[0] * way[0] + way[1] * way[1]
    b = start[0] * way[0] + start[1] * way[1]
    c = start[0] * start[0] + start[1] * start[1] - radius * radius
    root = b * b - a * c
    if a > TINY and c > 0.0 and b < 0.0 and root >= 0.0:
        at = c / (-b + wp.sqrt(root))
        point = start + way * at
        if at <= 1.0 and wp.abs(point[2]) <= half_length:
            fraction = at
            normal = Vector3(point[0] / radius, point[1] / radius, 0.0)
    return fraction, normal


@func
def ray_cylinder(start: Vector3, way: Vector3, radius: real, half_length: real):
    """Ray against a cylinder along z: the lateral surface first, then the caps."""
    fraction, normal = ray_tube(start, way, radius, half_length)
    aside = wp.sqrt(start[0] * start[0] + start[1] * start[1])
    if aside <= radius and wp.abs(start[2]) <= half_length:
        outside = beyond(aside, radius - THICKNESS) / wp.max(aside, TINY)
        above = beyond(start[2], half_length - THICKNESS)
        fraction, normal = ray_from_margin(Vector3(start[0] * outside, start[1] * outside, above), way)
    elif wp.abs(start[2]) > half_length and start[2] * way[2] < 0.0:
        at = (half_length - wp.abs(start[2])) / (wp.sign(start[2]) * way[2])
        point = start + way * at
        if at <= 1.0 and point[0] * point[0] + point[1] * point[1] <= radius * radius:
            fraction = at
            normal = Vector3(0.0, 0.0, wp.sign(start[2]))
    return fraction, normal


@func
def ray_capsule(start: Vector3, way: Vector3, radius: real, half_length: real):
    """Ray against a capsule along z: the first hit of its lateral surface and its two spheres."""
    nearest = start - Vector3(0.0, 0.0, wp.clamp(start[2], -half_length, half_length))
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    if wp.length(nearest) > radius:
        fraction, normal = ray_tube(start, way, radius, half_length)
        for end in range(2):
            z = half_length * (2.0 * real(end) - 1.0)
            at, outward = ray_ball(start, way, Vector3(0.0, 0.0, z), radius)
            if at < fraction:
                fraction = at
                normal = outward
    else:
        fraction, normal = ray_from_margin(nearest, way)
    return fraction, normal


@func
def ray_plane(start: Vector3, way: Vector3, normal: Vector3):
    """Ray against a plane through the origin, from either side; the normal is that of the side hit."""
    height = wp.dot(start, normal)
    slope = wp.dot(way, normal)
    fraction = -height / slope if height * slope < 0.0 and wp.abs(height) <= wp.abs(slope) else real(MISS)
    return fraction, normal * wp.sign(height)
