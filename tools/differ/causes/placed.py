"""Whether PyBullet answers as Carom does once links without shapes meet nothing.

It makes a model of an SDF file at the origin, and puts it where its `<pose>` says afterwards, without looking
for pairs. In the first step its links move one after the other, and those without shapes meet the bounds that
others still have elsewhere. When such a pair parts, the last one of the list takes its place, which may be
that of a finger with the floor. Carom finds pairs where the model is, of links with shapes alone.

Right after each file is loaded links without shapes are kept from all others, and the pairs of what has
shapes are looked for in the order of links.
"""

from __future__ import annotations

from collections.abc import Sequence

from tools.differ.assets import BARE
from tools.differ.causes.again import Performer, own_call, performed, with_contacts_of
from tools.differ.compare import AFTER_CONTACT, Difference, compare
from tools.differ.pair import Outcome
from tools.differ.programs import Call

PLACED = "PyBullet makes models of SDF files at the origin"
# So much of the difference may be left: it is the order of contacts alone.
_LEFT = 0.01


def was_placed_among_bare_links(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, ours: Outcome, difference: Difference
) -> str | None:
    """The words of the documentation, if a contact differs only while links without shapes meet others.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's first answer, whose contacts count.
        ours: Carom's answer.
        difference: A difference between the two.
    """
    if difference.function != "@probe" or difference.phase != "contact" or not _loads_bare_models(calls):
        return None
    outcome = with_own_calls(pybullet, calls, theirs, "@pass_bare_links", "load")
    return PLACED if agrees_but_for_rounding(calls, outcome, ours, difference) else None


def agrees_but_for_rounding(
    calls: Sequence[Call], outcome: Outcome, ours: Outcome, difference: Difference
) -> bool:
    """Whether another answer of PyBullet agrees with Carom's where it differed, and before."""
    found = compare(calls, outcome, ours, after_contact=min(_LEFT * difference.place.error, AFTER_CONTACT))
    return len(outcome["results"]) > difference.call and not any(
        one.function == "@probe" and one.call <= difference.call for one in found
    )


def _loads_bare_models(calls: Sequence[Call]) -> bool:
    """Whether an SDF file is loaded some links of which have no shapes."""
    return any(call["f"] == "loadSDF" and call["a"][:1] and call["a"][0] in BARE for call in calls)


def with_own_calls(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, function: str, after: str | tuple[str, ...]
) -> Outcome:
    """PyBullet's answer with a call of `perform.OWN` after some calls, and the contacts it had without.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's first answer.
        function: What is called.
        after: How the functions begin after which it is called.
    """
    made: list[Call] = []
    own: list[int] = []
    for call in calls:
        own.append(len(made))
        made.append(call)
        if call["f"].startswith(after):
            made.append(own_call(function))
    return with_contacts_of(calls, theirs, performed(pybullet, made), own)
