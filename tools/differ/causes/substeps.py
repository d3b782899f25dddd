"""Which contacts a step with several substeps had: `getContactPoints` reports those of the last one alone.

Bodies that are thrown apart in the first substep, because they are deep in each other, have no contact any
more when `@probe` looks. So a program that differs is performed once more by real PyBullet, with a step for
each substep.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tools.differ.causes.again import Performer
from tools.differ.pair import Outcome
from tools.differ.programs import Call

_TIME_STEP = 1.0 / 240.0
_SETTINGS = "setPhysicsEngineParameter"


def with_contacts_of_substeps(pybullet: Performer, calls: Sequence[Call], theirs: Outcome) -> Outcome:
    """PyBullet's answer, whose `@probe`s count the contacts of all substeps since the probe before.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program.
        theirs: PyBullet's answer; returned as it is where no step has several substeps.
    """
    steps, places = step_by_step(calls)
    if len(steps) == len(calls):
        return theirs
    pybullet.order(steps)
    seen = pybullet.answer()["results"]
    results = list[Any](theirs["results"])
    points, deepest, last = 0, 0.0, -1
    for number, (place, result) in enumerate(zip(places, results, strict=False)):
        for step, made in zip(steps[last + 1 : place], seen[last + 1 : place], strict=False):
            if step["f"] == "@probe" and made[0] == "ok":
                points, deepest = max(points, made[1][1]), min(deepest, made[1][2])
        last = place
        if calls[number]["f"] == "@probe" and result[0] == "ok":
            state, own, least = result[1]
            results[number] = ["ok", [state, own or points, min(least, deepest)]]
            points, deepest = 0, 0.0
    return {"results": results, "died": theirs["died"]}


def step_by_step(calls: Sequence[Call]) -> tuple[list[Call], list[int]]:
    """The program with steps and probes in place of substeps, and where in it each of its calls is."""
    made: list[Call] = []
    places: list[int] = []
    length, parts = _TIME_STEP, 1
    for call in calls:
        keywords = call["k"]
        if call["f"] == _SETTINGS:
            length = keywords.get("fixedTimeStep", length)
            parts = max(keywords.get("numSubSteps", parts), 1)
            others = {name: keywords[name] for name in keywords if name != "numSubSteps"}
            call = Call(f=call["f"], a=call["a"], k=others, id=call["id"])
        elif call["f"] == "setTimeStep":
            length = call["a"][0] if call["a"] else keywords["timeStep"]
        if call["f"] == "stepSimulation" and parts > 1:
            part = _call("setTimeStep", length / parts)
            made += [part, *[_call("stepSimulation"), _call("@probe")] * (parts - 1)]
            places.append(len(made))
            made += [call, _call("@probe"), _call("setTimeStep", length)]
        else:
            places.append(len(made))
            made.append(call)
    return made, places


def _call(function: str, *arguments: Any) -> Call:
    """A call whose result nobody asks for."""
    return {"f": function, "a": list(arguments), "k": {}, "id": -1}
