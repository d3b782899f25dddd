"""Whether links in a box are those whose present bounds PyBullet says are there.

`getOverlappingObjects` asks PyBullet's broad phase, which has bounds of the last step, larger by a margin.
Its `getAABB` has the bounds of where links are: links that are only in one of the two answers have to be
inside of the box by them if Carom has them, and outside if it does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tools.differ.causes.again import Performer, own_call, performed
from tools.differ.causes.calls import Seen, moved_since_the_last_step
from tools.differ.compare import Difference
from tools.differ.programs import Call

BOUNDS = "`getOverlappingObjects` lists links in the order of bodies and links, by their present bounds."
_ROUNDED = 1e-6
# By how much PyBullet's bounds are larger, on each side, of what has not been put elsewhere [m].
_MARGIN = 0.05


def has_present_bounds(pybullet: Performer, calls: Sequence[Call], difference: Difference) -> str | None:
    """The words of the documentation, if PyBullet's own `getAABB` says that Carom's links are the right ones.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        difference: A difference between the two.
    """
    if difference.signature.split()[:2] not in (
        ["getOverlappingObjects", "new"],
        ["getOverlappingObjects", "missing"],
    ):
        return None
    until = calls[: difference.call + 1]
    low, high = until[-1]["a"][:2]
    missing, new = difference.place.theirs, difference.place.ours
    asked = [own_call("getAABB", body, link) for body, link in (*missing, *new)]
    answers = performed(pybullet, [*until[:-1], own_call("performCollisionDetection"), *asked])["results"]
    bounds = answers[len(until) :]
    if len(bounds) < len(asked) or any(one[0] != "ok" for one in bounds):
        return None
    gaps = [_gap(one[1], low, high) for one in bounds]
    most = float("inf") if moved_since_the_last_step(Seen(difference, until)) else _MARGIN
    outside = all(-_ROUNDED < gap < most for gap in gaps[: len(missing)])
    inside = all(gap < _ROUNDED for gap in gaps[len(missing) :])
    return BOUNDS if outside and inside else None


def _gap(bounds: Sequence[Sequence[float]], low: Sequence[float], high: Sequence[float]) -> float:
    """How far bounds are from a box along the axis that keeps them apart; below 0 if none does."""
    lower, upper = bounds
    gaps: list[Any] = [max(b - y, x - a) for a, b, x, y in zip(upper, lower, low, high, strict=True)]
    return max(gaps)
