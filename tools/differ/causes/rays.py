"""What a program has done before a ray differs, and how it does."""

from __future__ import annotations

import math

from tools.differ.causes.calls import Seen
from tools.differ.causes.nearest import MARGIN, ROUNDED

# Cosine of the angle between faces of a fine mesh that lie beside each other.
_NEXT_FACE = 0.996
# How far PyBullet's normals are off those of the planes through its own points, 1.7e-4 or less.
_NEARLY_NORMAL = 2e-4
_BESIDE = 1e-8


def is_a_little_before(seen: Seen) -> bool:
    """Whether a ray ends less than the margin before where it does here, on that face or the next one."""
    theirs, ours = seen.difference.place[1:3]
    further = [b - a for a, b in zip(theirs[3], ours[3], strict=True)]
    apart = abs(sum(part * normal for part, normal in zip(further, ours[4], strict=True)))
    turned = sum(a * b for a, b in zip(theirs[4], ours[4], strict=True))
    return theirs[2] < ours[2] and apart < MARGIN and turned > _NEXT_FACE and _lies_on_a_ray(seen)


def _lies_on_a_ray(seen: Seen) -> bool:
    """Whether the place that is hit is as much further along one of the rays as its fraction says."""
    theirs, ours = seen.difference.place[1:3]
    further, share = math.dist(theirs[3], ours[3]), ours[2] - theirs[2]
    starts, ends = seen.call["a"][:2]
    rays = zip(starts, ends, strict=True) if isinstance(starts[0], list) else [(starts, ends)]
    return any(abs(further - share * math.dist(*ray)) < _BESIDE for ray in rays)


def hits_the_same_face(seen: Seen) -> bool:
    """Whether a ray ends at the same point in both, and only the normal there is a little turned."""
    theirs, ours = seen.difference.place[1:3]
    apart = max(abs(a - b) for a, b in zip(theirs[3], ours[3], strict=True))
    turned = max(abs(a - b) for a, b in zip(theirs[4], ours[4], strict=True))
    return max(abs(theirs[2] - ours[2]), apart) < ROUNDED and turned < _NEARLY_NORMAL


def hits_another_at_the_same_place(seen: Seen) -> bool:
    """Whether a ray hits another body than PyBullet's, as far away."""
    theirs, ours = seen.difference.place[1:3]
    return min(theirs[0], ours[0]) >= 0 and abs(theirs[2] - ours[2]) < ROUNDED


def counts_hits(seen: Seen) -> bool:
    """Whether hits of rays are asked for by number."""
    return seen.call["k"].get("reportHitNumber", -1) >= 0
