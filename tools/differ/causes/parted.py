"""Whether PyBullet answers as Carom does once it has dropped all pairs of bounds that have parted.

It looks at some of its pairs in each step: at as many as it met while it looked around links that moved, or
a tenth. So bodies that have parted stay one island for some steps, where many pairs are of links that stand
still. Before each step, or substep, a body far from all others is moved to and fro and pairs are looked for,
until all have been looked at. The same program with that body, but without looking, has to differ still.
"""

from __future__ import annotations

from collections.abc import Sequence

from tools.differ.causes.again import Performer, own_call, performed, with_contacts_of
from tools.differ.causes.substeps import step_by_step
from tools.differ.compare import Difference, compare
from tools.differ.pair import Outcome
from tools.differ.programs import Call

PARTED = "PyBullet looks at a part of its pairs in each step"
# Whether each of a tenth of the pairs, but at least one, has been looked at after so many searches.
_ALL, _NONE = 24, 0


def keeps_what_parted(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, ours: Outcome, difference: Difference
) -> str | None:
    """The words of the documentation, if a state differs only until PyBullet has looked at all pairs.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's first answer, whose phases count.
        ours: Carom's answer.
        difference: A difference between the two.
    """
    if difference.function != "@probe" or difference.phase == "start":
        return None

    def differs(searches: int) -> bool:
        outcome = _with_searches(pybullet, calls, theirs, searches)
        return len(outcome["results"]) <= difference.call or any(
            one.function == "@probe" and one.call <= difference.call for one in compare(calls, outcome, ours)
        )

    return PARTED if not differs(_ALL) and differs(_NONE) else None


def _with_searches(pybullet: Performer, calls: Sequence[Call], theirs: Outcome, searches: int) -> Outcome:
    """PyBullet's answer if it looks for pairs so many times before each substep, with the contacts it had."""
    steps, places = step_by_step(calls)
    made: list[Call] = []
    own: list[int] = []
    for step in steps:
        if step["f"] == "stepSimulation":
            made.append(own_call("@search", searches))
        own.append(len(made))
        made.append(step)
    return with_contacts_of(calls, theirs, performed(pybullet, made), [own[place] for place in places])
