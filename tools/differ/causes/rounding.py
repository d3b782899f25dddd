"""Whether PyBullet itself has two answers: with bodies a little elsewhere, or in a process of its own.

After a contact bodies are put 1e-12 m elsewhere, and where contacts are asked for: PyBullet's search ends
somewhere else on cylinders and capsules then. In free motion it is 1e-14 m, a few times the rounding of a
place: a difference of 1e-9 that this makes was made 50,000 times as large by what came after, as where joints
lie exactly at their limits, rows pull in opposite directions, or a spinning body is about to tumble. There
joints are put elsewhere as well that the program leaves as they are made: what hangs by some turns as fast as
it can or not at all. Since PyBullet looks for pairs when a joint is reset, such answers are compared with one
that has the same calls, but puts nothing elsewhere.

Joints that are at a limit are also put 1e-14 beyond it or before it, before each step. Whether such a limit
has a row is left to rounding, which in PyBullet is always the same until something changes it.
"""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Iterator, Sequence
from random import Random
from typing import Any

from tools.differ.assets import FILES, SPHERICAL
from tools.differ.causes.again import Performer, performed
from tools.differ.causes.calls import MAINTAIN_LINK_ORDER, Seen, types_in_order
from tools.differ.causes.rows import are_tied
from tools.differ.compare import AFTER_CONTACT, STRICT, Difference, compare
from tools.differ.pair import Outcome
from tools.differ.programs import Call

ROUNDING = "There motion agrees to rounding until rounding decides"
MEMORY = "Some answers of PyBullet depend on what earlier commands left in its memory"
_ELSEWHERE = {"free": 1e-14, "contact": 1e-12}
_ONE_BODY = ("createMultiBody", "loadURDF")
_RENUMBERS = MAINTAIN_LINK_ORDER | 524288
_UNTURNED = [0.0, 0.0, 0.0, 1.0]
_TRIALS, _SHARE = 4, 0.5
# One in two to twenty such places makes PyBullet's search end elsewhere.
_TRIALS_OF_CONTACTS = 24
# In the fields of differences, the places of a contact; in a contact, its bodies and links.
_PLACE = re.compile(r"\.\d+\.[56]")
_LINKS = slice(1, 5)
_PAIRS = ("links", ".len")
_POSE = re.compile(r"base\.\d+\.[01]\b|positions\b")
# Whether joints at a limit are put beyond it, before it, or each to either side.
_AT_LIMIT, _AS_IT_IS, _SIDES = 1e-14, 0, (1, -1, None, None)


def doubted_by_pybullet(
    pybullet: Performer,
    afresh: Performer,
    calls: Sequence[Call],
    theirs: Outcome,
    ours: Outcome,
    difference: Difference,
) -> str | None:
    """What PyBullet's own other answers say about a difference: words of the documentation, or None.

    Args:
        pybullet: Performs programs by real PyBullet.
        afresh: The same, in a process that has loaded nothing before.
        calls: The program.
        theirs: PyBullet's first answer.
        ours: Carom's answer.
        difference: A difference between the two.
    """
    if not _has(compare(calls, performed(afresh, calls), ours), difference, 0.0):
        return MEMORY
    if difference.function == "getContactPoints" and _PLACE.fullmatch(difference.place.field):
        return ROUNDING if _touches_elsewhere(pybullet, calls, theirs, difference) else None
    if difference.function == "getContactPoints" and difference.place.field in _PAIRS:
        return ROUNDING if _come_and_go(pybullet, calls, theirs, ours, difference) else None
    if difference.function != "@probe" or difference.phase not in _ELSEWHERE:
        return None
    free = difference.phase == "free"
    # Resetting joints makes PyBullet look for pairs: only the same calls can be compared.
    reference = _performed_with_joints(pybullet, calls, 0.0, Random(0)) if free else theirs
    for trial in range(_TRIALS):
        random = Random(trial)
        there = elsewhere(calls, _ELSEWHERE[difference.phase], random)
        if free:
            moved = _performed_with_joints(pybullet, there, _ELSEWHERE["free"], random)
        else:
            moved = performed(pybullet, there)
        if is_as_large(calls, reference, moved, difference):
            return ROUNDING
    if _changes_at_limits(pybullet, calls, theirs, difference):
        return ROUNDING
    return None


def _touches_elsewhere(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, difference: Difference
) -> bool:
    """Whether in PyBullet the place of the same contact differs by as much where bodies are elsewhere."""
    number, place = (int(part) for part in difference.place.field.split(".")[1:])
    before = theirs["results"][difference.call][1]
    away = math.dist(difference.place.theirs, difference.place.ours)
    for trial in range(_TRIALS_OF_CONTACTS):
        there = elsewhere(calls[: difference.call + 1], _ELSEWHERE["contact"], Random(trial))
        results = performed(pybullet, there)["results"]
        if len(results) <= difference.call or results[-1][0] != "ok" or len(results[-1][1]) != len(before):
            continue
        after = results[-1][1]
        same = before[number][_LINKS] == after[number][_LINKS]
        if same and math.dist(before[number][place], after[number][place]) > _SHARE * away:
            return True
    return False


def _come_and_go(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, ours: Outcome, difference: Difference
) -> bool:
    """Whether pairs that touch in one only come and go in PyBullet, too, but for those that joints tie."""
    seen = Seen(difference, calls[: difference.call + 1])
    before, own = (_pairs(outcome["results"][difference.call][1]) for outcome in (theirs, ours))
    left = {pair for pair in before ^ own if not are_tied(seen, *pair)}
    trial = 0
    while left and trial < _TRIALS_OF_CONTACTS:
        there = elsewhere(seen.before, _ELSEWHERE["contact"], Random(trial))
        results = performed(pybullet, there)["results"]
        if len(results) > difference.call and results[-1][0] == "ok":
            left -= before ^ _pairs(results[-1][1])
        trial += 1
    return trial > 0 and not left


def _pairs(points: Sequence[Any]) -> set[tuple[tuple[int, int], tuple[int, int]]]:
    """The pairs of links of contacts, each a body and a link, the lower one first."""
    return {
        (min((a, link_a), (b, link_b)), max((a, link_a), (b, link_b)))
        for _, a, b, link_a, link_b, *_ in points
    }


def _changes_at_limits(
    pybullet: Performer, calls: Sequence[Call], theirs: Outcome, difference: Difference
) -> bool:
    """Whether PyBullet's answer changes as joints at limits are beyond or before them, and only then."""
    if is_as_large(calls, theirs, _at_limits(pybullet, calls, _AS_IT_IS, 0), difference):
        return False
    return any(
        is_as_large(calls, theirs, _at_limits(pybullet, calls, side, seed), difference)
        for seed, side in enumerate(_SIDES)
    )


def _at_limits(pybullet: Performer, calls: Sequence[Call], side: int | None, seed: int) -> Outcome:
    """What comes of a program if joints at limits are put to one side of them before each step."""
    made: list[Call] = []
    places: list[int] = []
    for call in calls:
        if call["f"] == "stepSimulation":
            made.append({"f": "@nudge", "a": [_AT_LIMIT, seed, side], "k": {}, "id": -1})
        places.append(len(made))
        made.append(call)
    outcome = performed(pybullet, made)
    results = outcome["results"]
    kept = [results[place] for place in places if place < len(results)]
    return {"results": kept, "died": outcome["died"]}


def is_as_large(calls: Sequence[Call], theirs: Outcome, moved: Outcome, difference: Difference) -> bool:
    """Whether two answers of one engine differ by much of a difference, there or before."""
    least = _SHARE * difference.place.error
    if difference.phase == "free":
        return _has(compare(calls, theirs, moved, strict=min(least, STRICT)), difference, least)
    if _has(compare(calls, theirs, moved, after_contact=min(least, AFTER_CONTACT)), difference, least):
        return True
    # What differs by less may come first, and hides the rest; of poses only poses are as much.
    found = compare(calls, theirs, moved, after_contact=least)
    a_pose = _POSE.match(difference.place.field)
    return _has([one for one in found if not a_pose or _POSE.match(one.place.field)], difference, least)


def _performed_with_joints(
    pybullet: Performer, calls: Sequence[Call], distance: float, random: Random
) -> Outcome:
    """What came of a program whose joints are put up to so far from 0 as soon as they are made."""
    made: list[Call] = []
    own: set[int] = set()
    for call in calls:
        own.add(len(made))
        made += [call, *_resets(call, distance, random)]
    outcome = performed(pybullet, made)
    results = [result for place, result in enumerate(outcome["results"]) if place in own]
    return {"results": results, "died": outcome["died"]}


def _resets(call: Call, distance: float, random: Random) -> Iterator[Call]:
    """Calls that put all joints of the bodies that a call makes, but for spherical ones, near 0."""
    for number, types in enumerate(_joints(call)):
        body = {"$": call["id"]} if call["f"] in _ONE_BODY else {"$": call["id"], "i": number}
        for joint, kind in enumerate(types):
            if kind != SPHERICAL:
                arguments = [body, joint, distance * random.uniform(-1, 1)]
                yield Call(f="resetJointState", a=arguments, k={}, id=-1)


def _joints(call: Call) -> Sequence[Sequence[int]]:
    """Of each body that a call makes the types of the joints, as they are numbered; none if unknown."""
    if call["f"] == "createMultiBody":
        return [] if "batchPositions" in call["k"] else [types_in_order(call)]
    if not call["f"].startswith("load") or not call["a"]:
        return []
    bodies = [[joint.type for joint in joints] for joints in FILES.get(str(call["a"][0]), ())]
    # Which joint has which number depends on flags; this matters only where there are spherical ones.
    known = not call["k"].get("flags", 0) & _RENUMBERS or not any(SPHERICAL in types for types in bodies)
    return bodies if known else []


def _has(found: list[Difference], difference: Difference, least: float) -> bool:
    """Whether one is as early, of the same function and phase, and at least so large."""
    return any(
        one.call <= difference.call
        and (one.function, one.phase) == (difference.function, difference.phase)
        and one.place.error >= least
        for one in found
    )


def elsewhere(calls: Sequence[Call], distance: float, random: Random) -> list[Call]:
    """The program with bodies, links and joints placed, and bodies turned, up to so far elsewhere."""

    def moved(value: Any) -> Any:
        if isinstance(value, list):
            return [moved(part) for part in value]
        return value + distance * random.uniform(-1, 1) if isinstance(value, (int, float)) else value

    found = copy.deepcopy(list(calls))
    for call in found:
        arguments, keywords = call["a"], call["k"]
        if call["f"] == "createMultiBody":
            arguments[3:4] = moved(arguments[3:4])
            keywords["baseOrientation"] = moved(keywords.get("baseOrientation", _UNTURNED))
            if "linkPositions" in keywords:
                keywords["linkPositions"] = moved(keywords["linkPositions"])
        elif call["f"] == "loadURDF":
            keywords["basePosition"] = moved(keywords.get("basePosition", [0.0, 0.0, 0.0]))
            keywords["baseOrientation"] = moved(keywords.get("baseOrientation", _UNTURNED))
        elif call["f"] == "resetBasePositionAndOrientation":
            arguments[1:3] = moved(arguments[1:3])
        elif call["f"] == "resetJointState":
            arguments[2:3] = moved(arguments[2:3])
    return found
