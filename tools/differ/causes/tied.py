"""Whether PyBullet answers as Carom does once links that fixed joints tie to each other do not touch.

With `URDF_USE_SELF_COLLISION` PyBullet has contacts of such links. Nothing can move them apart, so the forces
of these contacts grow with every sweep, and what rounding leaves of them moves the robot a little.

Right after a body is made, contacts of its links that fixed joints tie together are switched off.
"""

from __future__ import annotations

from collections.abc import Sequence

from tools.differ.causes.again import Performer
from tools.differ.causes.calls import MAKE, TOUCHES_ITSELF
from tools.differ.causes.placed import agrees_but_for_rounding, with_own_calls
from tools.differ.compare import Difference
from tools.differ.pair import Outcome
from tools.differ.programs import Call

TIED = "what rounding leaves of them moves the robot"


def touches_what_it_is_tied_to(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, ours: Outcome, difference: Difference
) -> str | None:
    """The words of the documentation, if a contact differs only while links touch that fixed joints tie.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's first answer, whose contacts count.
        ours: Carom's answer.
        difference: A difference between the two.
    """
    until = calls[: difference.call]
    if difference.function != "@probe" or difference.phase != "contact" or not any(map(_touches, until)):
        return None
    outcome = with_own_calls(pybullet, calls, theirs, "@pass_tied_links", MAKE)
    return TIED if agrees_but_for_rounding(calls, outcome, ours, difference) else None


def _touches(call: Call) -> bool:
    """Whether a call makes a body whose links may touch each other."""
    return call["f"].startswith(MAKE) and bool(call["k"].get("flags", 0) & TOUCHES_ITSELF)
