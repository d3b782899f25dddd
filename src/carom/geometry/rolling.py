"""The axes about which a convex polyhedron rolls like a wheel or a ball, and the faces it can lie on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.geometry.polyhedron import Polyhedron

FEWEST_SIDES = 8
"""Fewest corners around its axis with which a prism counts as round."""

ROUND = 0.05
"""Tolerance of the radius, and of the angle between corners, as a fraction of them."""

FLAT = 1.0 / 16.0
"""Least share of the surface area of faces to lie on: those of a cube, but not those of a ball."""


def flat_faces_first(solid: Polyhedron) -> tuple[Polyhedron, int]:
    """The solid with the faces on which it can lie first, and their number."""
    areas = solid.face_areas()
    is_flat = areas >= FLAT * areas.sum()
    count = int(is_flat.sum())
    # As a rule either all are flat, or none.
    return (
        solid if is_flat[:count].all() else solid.with_faces_in_order(np.argsort(~is_flat, kind="stable"))
    ), count


def round_about(solid: Polyhedron) -> tuple[bool, bool, bool]:
    """Whether a convex solid is round as seen along the x, y and z axis of its frame.

    It is if the corners of its outline lie approximately on a circle around the centre of its bounds, without
    large gaps: a wheel is round along one axis, a ball along all.
    """
    low, high = solid.bounds()
    x, y, z = (solid.vertices - 0.5 * (low + high)).T
    return _is_round(y, z), _is_round(z, x), _is_round(x, y)


def _is_round(x: NDArray[np.float64], y: NDArray[np.float64]) -> bool:
    radii = np.hypot(x, y)
    rim = radii >= (1.0 - ROUND) * radii.max()
    angles = np.sort(np.arctan2(y[rim], x[rim]))
    gaps = np.diff(angles, append=angles[0] + 2.0 * np.pi)
    return bool(gaps.max() <= 2.0 * np.pi / FEWEST_SIDES * (1.0 + ROUND))
