"""About which axes a convex polyhedron rolls as a wheel or a ball does, and on which faces it can lie."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.geometry.polyhedron import Polyhedron

FEWEST_SIDES = 8
"""With fewer corners around its axis a prism is not round."""

ROUND = 0.05
"""Share of the radius, and of the angle between corners, by which these may be out of place."""

FLAT = 1.0 / 16.0
"""Share of the surface from which on a face is one to lie on: those of a cube are, a ball's are not."""


def flat_faces_first(solid: Polyhedron) -> tuple[Polyhedron, int]:
    """The solid with the faces on which it can lie before the others, and their number."""
    areas = solid.face_areas()
    is_flat = areas >= FLAT * areas.sum()
    count = int(is_flat.sum())
    # As a rule either all are flat, or none.
    return (
        solid if is_flat[:count].all() else solid.with_faces_in_order(np.argsort(~is_flat, kind="stable"))
    ), count


def round_about(solid: Polyhedron) -> tuple[bool, bool, bool]:
    """Whether a convex solid, seen along each of the axes of its frame, is round.

    It is if the corners of its outline lie about on a circle around the middle of its bounds, without
    large gaps: a wheel along one axis, a ball along all.
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
