"""Whether what moves otherwise touches a height field, and elsewhere than in PyBullet.

Both perform the program again and are asked for contacts after each step. Every body that differs has to be
among those that touch a height field, or touch what does; and the points there have to be others than
PyBullet's in some step until then, while what was before agreed. How much faster a body is may differ by no
more than what stops it where it is, or makes it as fast again the other way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tools.differ.causes.again import Performer, own_call, performed
from tools.differ.compare import Difference
from tools.differ.pair import Outcome
from tools.differ.programs import Call

HEIGHTS = "**on triangle meshes and height fields** shapes touch with all points at once"
_FIELD = 9
_SAME = 1e-7
# How much faster what hardly moves may become [m/s, rad/s].
_TWICE, _AT_LEAST = 2.0, (0.5, 10.0)
Points = list[Any]


def touches_heights_elsewhere(
    pybullet: Performer,
    carom: Performer,
    calls: Sequence[Call],
    theirs: Outcome,
    ours: Outcome,
    difference: Difference,
) -> str | None:
    """The words of the documentation, if bodies differ that touch height fields at other points.

    Args:
        pybullet: Performs programs by real PyBullet.
        carom: Performs programs by Carom.
        calls: The program.
        theirs: PyBullet's answer.
        ours: Carom's answer.
        difference: A difference between the two.
    """
    fields = _fields(calls[: difference.call], theirs)
    if not fields or difference.function not in ("@probe", "getContactPoints"):
        return None
    if difference.function == "getContactPoints":
        a, b = (outcome["results"][difference.call][1] or [] for outcome in (theirs, ours))
        return HEIGHTS if _others_are_the_same(a, b, fields) else None
    if difference.phase != "contact" or not _is_no_faster(theirs, ours, difference):
        return None
    a, b = (_contacts(engine, calls, difference.call) for engine in (pybullet, carom))
    touching = set[int]()
    for points, others in zip(a, b, strict=False):
        if _differ(_of(points, fields), _of(others, fields)):
            touching |= _touching([*points, *others], fields)
    return HEIGHTS if touching and set(difference.bodies) <= touching else None


def _fields(calls: Sequence[Call], theirs: Outcome) -> set[int]:
    """The ids of bodies that are height fields."""
    shapes = [
        {"$": call["id"]} for call in calls if call["f"] == "createCollisionShape" and call["a"][0] == _FIELD
    ]
    made = zip(calls, theirs["results"], strict=False)
    return {
        result[1]
        for call, result in made
        if call["f"] == "createMultiBody" and result[0] == "ok" and call["a"][1:2] and call["a"][1] in shapes
    }


def _contacts(engine: Performer, calls: Sequence[Call], last: int) -> list[Points]:
    """The contacts there are after each step up to a call."""
    made: list[Call] = []
    places: list[int] = []
    for call in calls[: last + 1]:
        made.append(call)
        if call["f"] == "stepSimulation":
            places.append(len(made))
            made.append(own_call("getContactPoints"))
    results = performed(engine, made)["results"]
    return [results[place][1] or [] for place in places if place < len(results) and results[place][0] == "ok"]


def _of(points: Points, fields: set[int]) -> Points:
    return [point for point in points if point[1] in fields or point[2] in fields]


def _others_are_the_same(theirs: Points, ours: Points, fields: set[int]) -> bool:
    """Whether contacts differ, but not those of what touches no height field."""
    a, b = ([point for point in points if not _of([point], fields)] for points in (theirs, ours))
    touching = _touching([*theirs, *ours], fields)
    free = [[point for point in points if touching.isdisjoint(point[1:3])] for points in (a, b)]
    return _differ(_of(theirs, fields), _of(ours, fields)) and not _differ(*free)


def _differ(theirs: Points, ours: Points) -> bool:
    """Whether contacts are others, or elsewhere."""
    if len(theirs) != len(ours):
        return True
    return any(
        a[1:5] != b[1:5] or math.dist(a[5], b[5]) > _SAME or abs(a[8] - b[8]) > _SAME
        for a, b in zip(theirs, ours, strict=True)
    )


def _touching(points: Points, fields: set[int]) -> set[int]:
    """The bodies that touch height fields, or others that do."""
    found, before = set(fields), set[int]()
    while found != before:
        before = set(found)
        found |= {body for point in points if not found.isdisjoint(point[1:3]) for body in point[1:3]}
    return found - fields


def _is_no_faster(theirs: Outcome, ours: Outcome, difference: Difference) -> bool:
    """Whether velocities differ by at most twice what PyBullet's are, or a little."""
    a, b = (outcome["results"][difference.call][1][0] for outcome in (theirs, ours))
    pairs = [(x[1][2:4], y[1][2:4]) for x, y in zip(a, b, strict=False) if x[1] and y[1]]
    return all(
        math.dist(v, w) < least + _TWICE * math.hypot(*v)
        for theirs_of, ours_of in pairs
        for v, w, least in zip(theirs_of, ours_of, _AT_LEAST, strict=True)
    )
