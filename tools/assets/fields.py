"""Rounded bodies as signed-distance fields: each field maps points (n, 3) to distances (n,) [m].

Negative is inside. Fields are blended into one another, which is how cast and moulded housings look.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Distances = NDArray[np.float64]
Field = Callable[[Points], Distances]
Place = tuple[float, float, float]


def ball(centre: Place, radius: float) -> Field:
    """A sphere."""
    return lambda points: np.linalg.norm(points - np.asarray(centre), axis=1) - radius


def rod(start: Place, end: Place, radius: float, end_radius: float | None = None) -> Field:
    """A bar with round ends from one point to another, tapering where a second radius is given."""
    a, b = np.asarray(start), np.asarray(end)
    along = b - a
    taper = 0.0 if end_radius is None else end_radius - radius

    def field(points: Points) -> Distances:
        share = np.clip((points - a) @ along / (along @ along), 0.0, 1.0)
        return np.linalg.norm(points - a - share[:, None] * along, axis=1) - (radius + taper * share)

    return field


def drum(start: Place, end: Place, radius: float, rounding: float) -> Field:
    """A cylinder between the centres of its flat ends; edges are rounded."""
    a, b = np.asarray(start), np.asarray(end)
    length = float(np.linalg.norm(b - a))
    axis = (b - a) / length

    def field(points: Points) -> Distances:
        along = (points - a) @ axis
        radial = np.linalg.norm(points - a - along[:, None] * axis, axis=1)
        return _rounded_corner(
            radial - radius, np.abs(along - length / 2.0) - length / 2.0, rounding=rounding
        )

    return field


def block(centre: Place, size: Place, rounding: float) -> Field:
    """A cuboid with rounded edges."""
    half = np.asarray(size) / 2.0

    def field(points: Points) -> Distances:
        beyond = np.abs(points - np.asarray(centre)) - half
        return _rounded_corner(*beyond.T, rounding=rounding)

    return field


def blend(*fields: Field, width: float) -> Field:
    """The union of bodies with a fillet of about `width` where they meet."""

    def field(points: Points) -> Distances:
        distance = fields[0](points)
        for other in fields[1:]:
            further = other(points)
            overlap = np.clip(width - np.abs(distance - further), 0.0, None) / width
            distance = np.minimum(distance, further) - overlap**2 * width / 4.0
        return distance

    return field


def without(body: Field, hole: Field) -> Field:
    """A body with another one taken out of it."""
    return lambda points: np.maximum(body(points), -hole(points))


def within(body: Field, bounds: Field) -> Field:
    """What two bodies share."""
    return lambda points: np.maximum(body(points), bounds(points))


def _rounded_corner(*beyond: Distances, rounding: float) -> Distances:
    """Distance to the corner where flat sides meet, given the distance beyond each side."""
    inset = np.stack(beyond, axis=1) + rounding
    outside = np.linalg.norm(np.maximum(inset, 0.0), axis=1)
    return outside + np.minimum(inset.max(axis=1), 0.0) - rounding
