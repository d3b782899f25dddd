"""Whether PyBullet's depths of a floor change as much when it is pushed along itself.

A floor of 30 m that is seen from a few centimetres above has corners so far outside of the image that single
precision decides about depths. Pushed along itself it fills the same pixels at the same depth; PyBullet's
depths change all the same. Only pixels whose depth differs by little more than that are explained.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tools.differ.causes.again import Performer, own_call, performed
from tools.differ.causes.calls import Seen, maker_of
from tools.differ.compare import Difference
from tools.differ.images import flat, is_as_deep
from tools.differ.pair import Outcome
from tools.differ.programs import Call

DEPTHS = "single precision decides about PyBullet's depths"
_FLOOR = "plane.urdf"
_LABELS_OF_A_LINK = 1 << 24
# How far the floor is pushed [m]: little beside its size, so that no edge comes into sight.
_WAYS = ([0.01, 0.0, 0.0], [0.3, 0.2, 0.0], [0.7, -0.6, 0.0], [-0.4, 0.9, 0.0])
_MOST = 5e-4
_SHARE = 0.5


def is_as_deep_elsewhere(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, ours: Outcome, difference: Difference
) -> str | None:
    """The words of the documentation, if PyBullet has as different depths of a floor that is pushed aside.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's answer to the program.
        ours: Carom's.
        difference: A difference between the two.
    """
    until = list(calls[: difference.call + 1])
    if difference.function != "getCameraImage" or difference.place.field != "depth":
        return None
    body = int(str(difference.place.theirs).rsplit(" of ", 1)[1]) % _LABELS_OF_A_LINK
    maker = maker_of(Seen(difference, until), body)
    if maker is None or maker["f"] != "loadURDF" or maker["a"][:1] != [_FLOOR]:
        return None
    before, own = (outcome["results"][difference.call][1] for outcome in (theirs, ours))
    pixels = _pixels_of(body, before, own)
    most = dict.fromkeys(pixels, 0.0)
    for way in _WAYS:
        results = performed(pybullet, [*until[:-1], own_call("@push", body, way), until[-1]])["results"]
        if len(results) <= len(until) or results[-1][0] != "ok":
            continue
        now, then = flat(results[-1][1][3]), flat(before[3])
        for pixel in pixels:
            most[pixel] = max(most[pixel], abs(now[pixel] - then[pixel]))
    then, here = flat(before[3]), flat(own[3])
    for pixel in pixels:
        away = abs(here[pixel] - then[pixel])
        if not is_as_deep(away) and (away > _MOST or most[pixel] < _SHARE * away):
            return None
    return DEPTHS


def _pixels_of(body: int, theirs: Sequence[Any], ours: Sequence[Any]) -> list[int]:
    """The pixels of an image in which both see a body."""
    labels = zip(flat(theirs[4]), flat(ours[4]), strict=True)
    return [
        pixel for pixel, (a, b) in enumerate(labels) if a == b >= 0 and int(a) % _LABELS_OF_A_LINK == body
    ]
