"""Whether hulls that span no volume are asked for: Carom makes them a little thick, PyBullet does not."""

from __future__ import annotations

import numpy as np
from tools.differ.causes.calls import Seen, made_for
from tools.differ.programs import Call

_MESH = 5
# Half the thickness of such a hull, and what PyBullet's grid for corners moves it by, at most [m].
_HALF = 1.05e-4
_NO_EXTENT = 1e-6


def is_nearer_by_flat_hulls(seen: Seen) -> bool:
    """Whether points are nearer than PyBullet's by the thickness of the flat hulls that were asked for."""
    theirs, ours = seen.difference.place[1:3]
    asked = [*seen.call["a"][:2], *(seen.call["k"].get(f"collisionShape{side}") for side in "AB")]
    flat = sum(any(map(_spans_no_volume, made_for(seen, one))) for one in asked)
    return 0.0 < theirs[8] - ours[8] < flat * _HALF


def _spans_no_volume(call: Call) -> bool:
    """Whether a call makes a hull of points in a plane, on a line or in one place."""
    if call["f"] != "createCollisionShape" or call["a"][:1] != [_MESH] or call["k"].get("indices"):
        return False
    points = np.array(call["k"].get("vertices", []), dtype=float).reshape(-1, 3)
    if not len(points):
        return False
    points = (points - points.mean(axis=0)) * call["k"].get("meshScale", 1.0)
    size = float(np.abs(points).max())
    return int(np.linalg.matrix_rank(points, tol=_NO_EXTENT * size)) < points.shape[1]
