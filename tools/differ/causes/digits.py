"""Whether Carom's own answer changes as much where it loses digits of moments of inertia, and not PyBullet's.

Carom adds up the moments of a robot about the centre of its base, PyBullet in the axes of each link. Where a
link or the base turns next to nothing beside a mass times the square of its distance, Carom's answer depends
on the last bits of a pose. Such a body differs, in free motion, by about as much as from itself with bodies
turned by 1e-14; whether PyBullet does so, too, is asked before (`rounding.py`).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from random import Random

from tools.differ.causes.again import Performer, own_call, performed
from tools.differ.causes.rounding import elsewhere, is_as_large
from tools.differ.compare import Difference
from tools.differ.pair import Outcome
from tools.differ.programs import Call

DIGITS = "Rounding shows where links turn next to nothing"
LOST = 1e5
"""How many times the least moment of inertia the mass times its distance squared is, at least."""
_ELSEWHERE, _TRIALS = 1e-14, 4
_MOTION = re.compile(r"(?:base|positions|velocities|reactions)\.(\d+)\b")


def loses_digits(
    carom: Performer, calls: Sequence[Call], ours: Outcome, difference: Difference
) -> str | None:
    """The words of the documentation, if Carom loses digits of a body, and so many that they explain it.

    Args:
        carom: Performs programs by Carom.
        calls: The program.
        ours: Carom's first answer.
        difference: A difference from PyBullet.
    """
    said = _MOTION.match(difference.place.field)
    if difference.function != "@probe" or difference.phase != "free" or not said:
        return None
    before = [*calls[: difference.call], own_call("@digits_lost")]
    lost = performed(carom, before)["results"][-1]
    if lost[0] != "ok" or len(lost[1]) <= int(said[1]) or lost[1][int(said[1])] < LOST:
        return None
    until = calls[: difference.call + 1]
    changes = any(
        is_as_large(until, ours, performed(carom, elsewhere(until, _ELSEWHERE, Random(trial))), difference)
        for trial in range(_TRIALS)
    )
    return DIGITS if changes else None
