"""Which contacts the volume of a site counts.

As in MuJoCo, a contact counts if its point lies in the volume, or if the ray from it outwards of the link
meets the volume.
"""

from __future__ import annotations

import numpy as np

from carom.checks import Array
from carom.description.site import SiteShape, SiteSpec
from carom.scene.sensors.vectors import dot


def is_touched(site: SiteSpec, points: Array, directions: Array) -> np.ndarray:
    """Whether rays from points (n, 3) along unit directions (n, 3) meet a site, all in its frame: (n,)."""
    size = np.array(site.size)
    if site.shape is SiteShape.SPHERE:
        return _meets_ellipsoid(points, directions, np.full(3, size[0]))
    if site.shape is SiteShape.ELLIPSOID:
        return _meets_ellipsoid(points, directions, size)
    if site.shape is SiteShape.BOX:
        return _later(*_slabs(points, directions, size))
    radius, half = size[0], size[1]
    tube = _disc(points, directions, radius)
    flat = _slabs(points[:, 2:], directions[:, 2:], np.array([half]))
    meets = _later(np.maximum(tube[0], flat[0]), np.minimum(tube[1], flat[1]))
    if site.shape is SiteShape.CAPSULE:
        for end in (-half, half):
            cap = points - np.array([0.0, 0.0, end])
            meets = meets | _meets_ellipsoid(cap, directions, np.full(3, radius))
    return meets


def _later(start: Array, end: Array) -> np.ndarray:
    """Whether an interval along the rays is not empty and not all before their starts."""
    return (start <= end) & (end >= 0.0)


def _meets_ellipsoid(points: Array, directions: Array, axes: Array) -> np.ndarray:
    if not axes.all():
        return np.zeros(len(points), dtype=bool)
    return _later(*_roots(points / axes, directions / axes, 1.0))


def _disc(points: Array, directions: Array, radius: float) -> tuple[Array, Array]:
    """The intervals in which rays are within a distance of the z axis."""
    flat = np.array([1.0, 1.0, 0.0])
    return _roots(points * flat, directions * flat, radius)


def _roots(points: Array, directions: Array, radius: float) -> tuple[Array, Array]:
    """The intervals in which points on rays are within a distance of the origin; (inf, -inf) for none."""
    a, b = dot(directions, directions), dot(points, directions)
    c = dot(points, points) - radius * radius
    inside = b * b - a * c
    root = np.sqrt(np.maximum(inside, 0.0))
    along = np.where(a > 0.0, a, 1.0)
    never = np.where(a > 0.0, inside < 0.0, c > 0.0)
    start = np.where(a > 0.0, (-b - root) / along, -np.inf)
    end = np.where(a > 0.0, (-b + root) / along, np.inf)
    return np.where(never, np.inf, start), np.where(never, -np.inf, end)


def _slabs(points: Array, directions: Array, half: Array) -> tuple[Array, Array]:
    """The intervals in which points on rays are between planes at a distance on both sides of the origin."""
    moving = directions != 0.0
    divisor = np.where(moving, directions, 1.0)
    first, second = (-half - points) / divisor, (half - points) / divisor
    within = np.abs(points) <= half
    start = np.where(moving, np.minimum(first, second), np.where(within, -np.inf, np.inf))
    end = np.where(moving, np.maximum(first, second), np.where(within, np.inf, -np.inf))
    return start.max(axis=1), end.min(axis=1)
