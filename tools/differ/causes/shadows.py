"""Whether images agree once nothing casts shadows.

Where PyBullet darkens everything in reach of the light, its image is darker than Carom's. Both take it again
with `shadow=0`: then a body whose colours differed must not differ any more.
"""

from __future__ import annotations

from collections.abc import Sequence

from tools.differ.causes.again import Performer
from tools.differ.causes.calls import Seen
from tools.differ.causes.images import casts_shadows, shades_along_the_link
from tools.differ.compare import Difference, compare
from tools.differ.programs import Call

SHADOWS = "Where PyBullet darkens everything in reach of the light"


def differs_by_shadows(
    pybullet: Performer, carom: Performer, calls: Sequence[Call], difference: Difference
) -> str | None:
    """The words of the documentation, if colours of a body differ only while there are shadows.

    Args:
        pybullet: Performs programs by real PyBullet.
        carom: Performs programs by Carom.
        calls: The program.
        difference: A difference between the two.
    """
    until = list(calls[: difference.call + 1])
    seen = Seen(difference, until)
    if not seen.differs("getCameraImage colour") or not casts_shadows(seen):
        return None
    last = until[-1]
    until[-1] = Call(f=last["f"], a=last["a"], k={**last["k"], "shadow": 0}, id=last["id"])
    pybullet.order(until)
    carom.order(until)
    theirs, ours = pybullet.answer(), carom.answer()
    if min(len(theirs["results"]), len(ours["results"])) < len(until):
        return None
    left = [one for one in compare(until, theirs, ours) if one.call == difference.call]
    same = [one for one in left if _body(one) == _body(difference) and one.place.field != "depth"]
    return None if any(not shades_along_the_link(Seen(one, until)) for one in same) else SHADOWS


def _body(difference: Difference) -> int:
    """The body whose pixels differ."""
    return int(str(difference.place.theirs).rsplit(" of ", 1)[1]) % (1 << 24)
