"""Whether images agree, but for edges of round shapes, once the near plane is next to the camera.

PyBullet draws polyhedra that lie inside of round shapes. Where the near plane is between the two, what is
there of the round shape is cut off: Carom shows what is behind it, PyBullet the polyhedron. Both take the
image again with the same view and the near plane a hundredth as far away.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from tools.differ.causes.again import Performer
from tools.differ.causes.calls import Seen
from tools.differ.causes.images import shows_something_round, stands_out_round
from tools.differ.compare import Difference, compare
from tools.differ.programs import Call

CUT = "a part of its near plane"
_NEARER = 0.01
_OTHER = re.compile(r".*are nearer: (-?\d+)")
# Which arguments of a projection are in proportion to the distance of the near plane, if the view stays.
_SCALED = {"computeProjectionMatrix": range(5), "computeProjectionMatrixFOV": range(2, 3)}


def cuts_something_round(
    pybullet: Performer, carom: Performer, calls: Sequence[Call], difference: Difference
) -> str | None:
    """The words of the documentation, if an image differs only where the near plane cuts round shapes.

    Args:
        pybullet: Performs programs by real PyBullet.
        carom: Performs programs by Carom.
        calls: The program.
        difference: A difference between the two.
    """
    until = calls[: difference.call + 1]
    seen = Seen(difference, until)
    if not seen.differs("getCameraImage segments") or not _shows_something_round(seen):
        return None
    nearer = with_near_planes_next_to_cameras(until)
    if nearer is None:
        return None
    pybullet.order(nearer)
    carom.order(nearer)
    theirs, ours = pybullet.answer(), carom.answer()
    last = difference.call
    if min(len(theirs["results"]), len(ours["results"])) <= last or theirs["results"][last][0] != "ok":
        return None
    left = [one for one in compare(nearer, theirs, ours) if one.call == last]
    return CUT if all(_is_an_edge(Seen(one, nearer)) for one in left) else None


def _shows_something_round(seen: Seen) -> bool:
    """Whether most of what differs is a body with round shapes in one of the two images."""
    said = _OTHER.match(str(seen.difference.place.theirs))
    labels = [int(said[1])] if said else []
    return any(shows_something_round(seen, label) for label in [*labels, seen.difference.place.ours])


def _is_an_edge(left: Seen) -> bool:
    if left.differs("getCameraImage segments"):
        return stands_out_round(left)
    # Depths and colours are compared only where segments agree.
    return left.differs("getCameraImage depth", "getCameraImage colour")


def with_near_planes_next_to_cameras(calls: Sequence[Call]) -> list[Call] | None:
    """The same calls with a nearer plane for the last image; None if its projection is not known."""
    asked = calls[-1]["a"][3:4]
    made = asked[0].get("whole") if asked and isinstance(asked[0], dict) else None
    changed = list[Call]()
    for call in calls:
        if call["id"] == made and call["f"] in _SCALED:
            scaled = _SCALED[call["f"]]
            given = [_NEARER * value if place in scaled else value for place, value in enumerate(call["a"])]
            changed.append({**call, "a": given})
        else:
            changed.append(call)
    return None if changed == list(calls) else changed
