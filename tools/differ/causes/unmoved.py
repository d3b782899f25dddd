"""Whether PyBullet's rays hit what Carom's do once it has looked where bodies are.

Before its first step PyBullet has other bounds for the links of robots, and does not hit what a ray passes
outside of them: nothing, or what is behind. It is asked again after a `performCollisionDetection`, which
moves nothing: then the same link has to be hit, at the same place but for what statements explain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tools.differ.causes.again import Performer, own_call, performed
from tools.differ.causes.nearest import MARGIN
from tools.differ.compare import Difference
from tools.differ.programs import Call

UNMOVED = "PyBullet does not hit what a ray passes outside"
_RAYS = ("rayTest", "rayTestBatch")
# How far from a place where a slanting ray is within the margin it may go on to the surface [m].
_ALONG = 20.0 * MARGIN


def hits_once_bounds_are_there(
    pybullet: Performer, calls: Sequence[Call], theirs: Any, ours: Any, difference: Difference
) -> str | None:
    """The words of the documentation, if PyBullet hits the same after it has looked for collisions.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's answer to the program.
        ours: Carom's.
        difference: A difference between the two.
    """
    if difference.phase != "start" or difference.function not in _RAYS or difference.place.field != "hit":
        return None
    until = calls[: difference.call + 1]
    before, wanted = theirs["results"][difference.call], ours["results"][difference.call]
    results = performed(pybullet, [*until[:-1], own_call("performCollisionDetection"), until[-1]])["results"]
    if len(results) <= len(until) or any(one[0] != "ok" for one in (before, wanted, results[-1])):
        return None
    rays = zip(before[1], results[-1][1], wanted[1], strict=True)
    others = [(now, ours) for then, now, ours in rays if then[:2] != ours[:2]]
    return UNMOVED if others and all(_is_alike(now, ours) for now, ours in others) else None


def _is_alike(now: Sequence[Any], ours: Sequence[Any]) -> bool:
    """Whether two hits are of one link, at places that a margin explains."""
    return now[:2] == ours[:2] and (now[0] < 0 or math.dist(now[3], ours[3]) < _ALONG)
