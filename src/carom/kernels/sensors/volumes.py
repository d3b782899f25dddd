"""Which contacts the volume of a site counts, as in `carom.scene.sensors.volumes`."""

import warp as wp

from carom.kernels.types import Int32, Vector2, Vector3, func, real
from carom.layouts.queries import BOX_VOLUME, CAPSULE_VOLUME, ELLIPSOID_VOLUME, SPHERE_VOLUME

FAR = real(1e300)


@func
def is_touched(shape: Int32, size: Vector3, point: Vector3, direction: Vector3) -> bool:
    """Whether a ray from a point along a unit direction meets a volume, all in its frame."""
    if shape == SPHERE_VOLUME:
        return meets_ellipsoid(point, direction, Vector3(size[0], size[0], size[0]))
    if shape == ELLIPSOID_VOLUME:
        return meets_ellipsoid(point, direction, size)
    if shape == BOX_VOLUME:
        x, y = between(point[0], direction[0], size[0]), between(point[1], direction[1], size[1])
        return is_later(both(both(x, y), between(point[2], direction[2], size[2])))
    radius, half = size[0], size[1]
    flat_point = Vector3(point[0], point[1], 0.0)
    flat_direction = Vector3(direction[0], direction[1], 0.0)
    tube = within_radius(flat_point, flat_direction, radius)
    if is_later(both(tube, between(point[2], direction[2], half))):
        return True
    if shape == CAPSULE_VOLUME:
        axes = Vector3(radius, radius, radius)
        up = Vector3(0.0, 0.0, half)
        return meets_ellipsoid(point + up, direction, axes) or meets_ellipsoid(point - up, direction, axes)
    return False


@func
def is_later(interval: Vector2) -> bool:
    """Whether an interval along a ray is not empty and not all before its start."""
    return interval[0] <= interval[1] and interval[1] >= 0.0


@func
def both(a: Vector2, b: Vector2) -> Vector2:
    """What two intervals have in common."""
    return Vector2(wp.max(a[0], b[0]), wp.min(a[1], b[1]))


@func
def meets_ellipsoid(point: Vector3, direction: Vector3, axes: Vector3) -> bool:
    """Whether a ray meets an ellipsoid about the origin."""
    if axes[0] * axes[1] * axes[2] == 0.0:
        return False
    return is_later(within_radius(wp.cw_div(point, axes), wp.cw_div(direction, axes), 1.0))


@func
def within_radius(point: Vector3, direction: Vector3, radius: real) -> Vector2:
    """The interval in which points on a ray are within a distance of the origin."""
    a, b = wp.dot(direction, direction), wp.dot(point, direction)
    c = wp.dot(point, point) - radius * radius
    if a > 0.0:
        inside = b * b - a * c
        if inside < 0.0:
            return Vector2(FAR, -FAR)
        root = wp.sqrt(inside)
        return Vector2((-b - root) / a, (-b + root) / a)
    if c > 0.0:
        return Vector2(FAR, -FAR)
    return Vector2(-FAR, FAR)


@func
def between(point: real, direction: real, half: real) -> Vector2:
    """The interval in which a coordinate on a ray is at most `half` away from 0."""
    if direction != 0.0:
        first, second = (-half - point) / direction, (half - point) / direction
        return Vector2(wp.min(first, second), wp.max(first, second))
    if wp.abs(point) <= half:
        return Vector2(-FAR, FAR)
    return Vector2(FAR, -FAR)
