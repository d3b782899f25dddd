"""What may cause a difference in the rows of the solver: in which islands they are, and what they share."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from tools.differ.assets import AT_LIMITS, FIXED, TIED
from tools.differ.causes.calls import (
    LEFT_OVER,
    MAINTAIN_LINK_ORDER,
    MAKE,
    TOUCHES_ITSELF,
    Seen,
    disturbs,
    has_joints,
    joint_types,
    maker_of,
    order_of_links,
)
from tools.differ.programs import Call
from tools.differ.values import first_difference

_ROBOTS = 2
_SAME_CONTACT = 1e-6
_STILL = 1e-9
_ONE_OF_ITS_OWN = "mjcf/reacher.xml"
"""A file with two bodies whose first links, without shapes, are in one place."""
_WHEELS_ON_ONE_LINE = "racecar/racecar_differential.urdf"
"""A file with five links on one axis that turn 4e-8 kg m² about it, unless their inertia is from the file."""
# Rounding makes 6e-9 of it: that is how far answers differ if the robot is larger by 1e-15.
_ROUNDED_INERTIA = 1e-8
_MOTORS = ("setJointMotorControl2", "setJointMotorControlArray")
_INERTIA_FROM_FILE = 2
_SLEEP = 8
_RENUMBERS = 131072 | 524288
_TOUCHES_PARENTS = 8192
_MERGES_LINKS = 524288
# Files whose mass matrices lack full rank with this flag: in PyBullet the least eigenvalue is at most 1e-16
# of the greatest. Those of ant, hopper, walker2d, reacher and the pendulums have full rank.
_DEPENDENT = tuple(
    f"mjcf/{name}.xml"
    for name in (
        "half_cheetah",
        "humanoid",
        "humanoid_fixed",
        "humanoid_symmetric",
        "humanoid_symmetric_no_ground",
        "pusher",
        "striker",
        "swimmer",
        "thrower",
    )
)


def shares_with_a_limit(seen: Seen) -> bool:
    """Whether only what motors do differs, and a body has a joint that was loaded exactly at its limit."""
    return seen.difference.place.field.startswith("reactions") and any(
        call["f"].startswith("load") and str(call["a"][0]) in AT_LIMITS for call in seen.before if call["a"]
    )


def renumbers_islands(seen: Seen) -> bool:
    """Whether a body was removed, or a base freed or fixed, beside robots, and states hardly differ.

    After a contact only the robot whose base was freed or fixed counts, and only while nothing overlaps.
    """
    if seen.difference.place.error > LEFT_OVER:
        return False
    if seen.difference.phase != "free" and not _frees_or_fixes_what_differs(seen):
        return False
    robots = sum(call["f"].startswith(MAKE) and has_joints(seen, call) for call in seen.before)
    return robots >= _ROBOTS and any(
        call["f"] == "removeBody" or _may_free_or_fix(call) for call in seen.before
    )


def _frees_or_fixes_what_differs(seen: Seen) -> bool:
    """Whether the base was freed or fixed of the robot that differs, and nothing overlaps."""
    said = re.match(r"[a-z]+\.(\d+)\.", seen.difference.place.field)
    body = maker_of(seen, int(said[1])) if said else None
    return (
        body is not None
        and has_joints(seen, body)
        and seen.difference.deepest == 0.0
        and any(_may_free_or_fix(call) and call["a"][0].get("$") == body["id"] for call in seen.before)
    )


def _may_free_or_fix(call: Call) -> bool:
    """Whether a call may free or fix a base, as also those do that name a link and change the whole body."""
    changes = call["f"] == "changeDynamics" and "mass" in call["k"]
    return changes and (call["a"][1] < 0 or len(call["k"]) > 1)


def ties_a_link_taken_for_still(seen: Seen) -> bool:
    """Whether another body is tied to a link that fixed joints tie to the first one, on a fixed base."""
    made = {call["id"]: call for call in seen.before if call["f"] == "createMultiBody"}
    types = joint_types(seen)
    for call in seen.before:
        if call["f"] != "createConstraint":
            continue
        ends = ((call["a"][0], call["a"][1]), (call["a"][2], call["a"][3]))
        if all(isinstance(body, dict) for body, _ in ends) and ends[0][0] != ends[1][0]:
            for body, link in ends:
                if body["$"] in made and _counts_as_still(made[body["$"]], types[body["$"]], link):
                    return True
    return False


def _counts_as_still(made: Call, types: list[int], link: int) -> bool:
    """Whether a link of a body with a fixed base moves, but with the first link alone."""
    parents: Any = made["k"].get("linkParentIndices", ())
    if not made["a"] or made["a"][0] != 0 or not 0 < link < len(types) or types[0] == FIXED:
        return False
    while link > 0 and types[link] == FIXED:
        # 0 is the base, and 1 the first link.
        link = parents[link] - 1
    return link == 0


def touches_itself_rigidly(seen: Seen) -> bool:
    """Whether what touches in PyBullet only are links of one body each, which fixed joints tie together."""
    field, theirs, ours = seen.difference.place[:3]
    if field == ".len":
        others = [point for point in theirs if not are_tied(seen, point[1:4:2], point[2:5:2])]
        return len(others) == len(ours) < len(theirs)
    return not ours and all(are_tied(seen, a, b) for a, b in theirs)


def are_tied(seen: Seen, a: Sequence[int], b: Sequence[int]) -> bool:
    """Whether fixed joints tie two links (each a body and a link) of a body that may touch itself."""
    body = maker_of(seen, a[0])
    if a[0] != b[0] or body is None or not body["k"].get("flags", 0) & TOUCHES_ITSELF:
        return False
    if not has_joints(seen, body):
        return True
    first = [*_firsts(body), -1]
    return max(a[1], b[1]) < len(first) - 1 and first[a[1]] == first[b[1]]


def _firsts(body: Call) -> list[int]:
    """Of each link of a body the one from which on fixed joints lead to it, as far as that is known."""
    flags = body["k"].get("flags", 0)
    if body["f"] == "loadURDF":
        known = not flags & _MERGES_LINKS and body["a"][0] in TIED
        return TIED[body["a"][0]][bool(flags & MAINTAIN_LINK_ORDER)] if known else []
    if body["f"] != "createMultiBody":
        return []
    order, given = order_of_links(body), body["k"]
    # 0 is the base, and 1 the first link.
    parents = [-1 if parent == 0 else order.index(parent - 1) for parent in given["linkParentIndices"]]
    types = given["linkJointTypes"]
    first = list(range(len(order)))
    for link in first:
        while first[link] >= 0 and types[order[first[link]]] == FIXED:
            first[link] = parents[order[first[link]]]
    return first


def asks_for_the_other_link(seen: Seen) -> bool:
    """Whether PyBullet lacks only contacts of one body whose second link is the one asked for."""
    field, theirs, ours = seen.difference.place[:3]
    asked = seen.call["k"].get("linkIndexA")
    if seen.call["f"] != "getContactPoints" or asked is None:
        return False
    if field == "links":
        return not theirs and all(a[0] == b[0] and asked in (a[1], b[1]) for a, b in ours)
    if field != ".len":
        return False
    others = [point for point in ours if point[1] != point[2] or point[3] == asked or point[4] != asked]
    return len(others) == len(theirs) < len(ours)


def drives_from_a_limit(seen: Seen) -> bool:
    """Whether a joint that a motor drives, of a body loaded at limits, moves off 0 in one of both only."""
    said = re.fullmatch(r"positions\.(\d+)\.(\d+)(\.0)?", seen.difference.place.field)
    if said is None:
        return False
    body, joint = maker_of(seen, int(said[1])), int(said[2])
    theirs, ours = (_number(value) for value in seen.difference.place[1:3])
    return (
        body is not None
        and body["a"][:1] != []
        and str(body["a"][0]) in AT_LIMITS
        and min(abs(theirs), abs(ours)) < _STILL
        and any(
            call["f"] in _MOTORS
            and call["a"][0].get("$") == body["id"]
            and joint in (call["a"][1] if isinstance(call["a"][1], list) else [call["a"][1]])
            for call in seen.before
        )
    )


def _number(value: Any) -> float:
    return value[0] if isinstance(value, list) else value


def lies_in_one_island(seen: Seen) -> bool:
    """Whether a body of a file differs whose links without shapes are in one place, beside others."""
    said = re.match(r"(?:positions|velocities|reactions)\.(\d+)\.", seen.difference.place.field)
    body = maker_of(seen, int(said[1])) if said else None
    return (
        seen.difference.phase == "contact"
        and seen.difference.place.error < LEFT_OVER
        and body is not None
        and body["a"][:1] == [_ONE_OF_ITS_OWN]
        and any(call["f"].startswith(MAKE) and call is not body for call in seen.before)
    )


def fixes_what_touches_itself(seen: Seen) -> bool:
    """Whether the base of a robot that touches itself was fixed."""
    touching = {
        call["id"]
        for call in seen.before
        if call["f"].startswith(MAKE) and call["k"].get("flags", 0) & TOUCHES_ITSELF
    }
    return seen.difference.phase == "contact" and any(
        call["f"] == "changeDynamics" and call["k"].get("mass") == 0 and call["a"][0].get("$") in touching
        for call in seen.before
    )


def touches_its_parents_rigidly(seen: Seen) -> bool:
    """Whether a body with a fixed base and links that may touch their parents moves otherwise."""
    said = re.match(r"[a-z]+\.(\d+)\.", seen.difference.place.field)
    body = None if said is None else maker_of(seen, int(said[1]))
    if seen.difference.phase != "contact" or body is None or not body["f"].startswith(MAKE):
        return False
    flags = body["k"].get("flags", 0)
    fixed = body["k"].get("useFixedBase") or (body["f"] == "createMultiBody" and body["a"][:1] == [0])
    return bool(fixed and flags & TOUCHES_ITSELF and flags & _TOUCHES_PARENTS)


def changes_mass_of_what_sleeps(seen: Seen) -> bool:
    """Whether a body that was told to sleep was given another mass later, with several substeps in a step."""
    several, asleep = False, list[Any]()
    for call in seen.before:
        several |= call["k"].get("numSubSteps", 0) > 1
        if call["f"] == "changeDynamics":
            if "mass" in call["k"] and call["a"][0] in asleep:
                return several
            if call["k"].get("activationState", 0) & _SLEEP:
                asleep.append(call["a"][0])
    return False


def drives_before_restoring(seen: Seen) -> bool:
    """Whether motors were told something after a state was saved, and then the state was restored."""
    saved, driven, restored = False, list[Any](), list[Any]()
    for call in seen.before:
        if call["f"] == "restoreState":
            restored = list(driven)
        if saved and call["f"].startswith("setJointMotorControl"):
            driven.append(call["a"][0])
        saved |= call["f"] in ("saveState", "saveBullet")
    return disturbs(seen, restored)


def turns_next_to_nothing_about_one_line(seen: Seen) -> bool:
    """Whether a joint hardly differs, in free motion, of a tied robot whose links turn next to no inertia."""
    said = re.match(r"(?:positions|velocities)\.(\d+)\.", seen.difference.place.field)
    body = maker_of(seen, int(said[1])) if said else None
    return (
        seen.difference.phase == "free"
        and seen.difference.place.error < _ROUNDED_INERTIA
        and body is not None
        and body["a"][:1] == [_WHEELS_ON_ONE_LINE]
        and not body["k"].get("flags", 0) & _INERTIA_FROM_FILE
        and any(
            call["f"] == "createConstraint" and {"$": body["id"]} in (call["a"][0], call["a"][2])
            for call in seen.before
        )
    )


def leaves_inertia_to_mjcf(seen: Seen) -> bool:
    """Whether a file whose joints move in one direction together was loaded without inertia about centres."""
    return disturbs(
        seen,
        [
            call["id"]
            for call in seen.before
            if call["f"] == "loadMJCF"
            and call["a"][0] in _DEPENDENT
            and call["k"].get("flags", 0) & _INERTIA_FROM_FILE
        ],
    )


def lists_in_another_order(seen: Seen) -> bool:
    """Whether contacts are the same in another order, where pairs are sorted that meet at once."""
    theirs, ours = seen.difference.whole
    sorts = any(call["k"].get("deterministicOverlappingPairs", 0) > 0 for call in seen.before)
    if not sorts or not theirs or not ours or len(theirs) != len(ours):
        return False
    # Which side of a pair comes first is a part of the order of bodies, and stays.
    a, b = (sorted(points, key=lambda point: point[1:7]) for points in (theirs, ours))
    return first_difference(a, b, _SAME_CONTACT) is None


def reports_torques_as_friction(seen: Seen) -> bool:
    """Whether only a friction of a contact differs, which has rolling friction, and friction a pyramid."""
    said = re.fullmatch(r"\.(\d+)\.1[02]", seen.difference.place.field)
    ours = seen.difference.whole[1]
    if said is None or not ours:
        return False
    cone, rolls = 1, False
    for call in seen.before:
        cone = call["k"].get("enableConeFriction", cone)
        rolls |= call["f"] == "changeDynamics" and call["k"].get("rollingFriction", 0) > 0
    return cone == 0 and rolls and abs(seen.difference.place.ours) <= ours[int(said[1])][9]
