"""What may cause a difference: what differs, and what the program has done before."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tools.differ.assets import (
    AT_LIMITS,
    BARE,
    CHILDREN_FIRST,
    FILES,
    FIXED,
    PRISMATIC,
    SPHERICAL,
)
from tools.differ.compare import Difference
from tools.differ.programs import Call, all_references, references


@dataclass(frozen=True)
class Seen:
    """A difference, and the calls before it."""

    difference: Difference
    before: Sequence[Call]

    @property
    def call(self) -> Call:
        """The call whose result differs."""
        return self.before[-1]

    def differs(self, *beginnings: str) -> bool:
        """Whether the signature begins with one of some texts."""
        return self.difference.signature.startswith(beginnings)

    def has(self, function: str, keyword: str = "") -> bool:
        """Whether a function was called before, with a keyword."""
        return any(call["f"] == function and (not keyword or keyword in call["k"]) for call in self.before)

    def loads(self, ending: str) -> bool:
        """Whether a file of some kind was loaded."""
        return any(
            call["f"].startswith("load") and str(call["a"][:1]).endswith(f"{ending}']")
            for call in self.before
        )


MASSES = (
    "calculateMassMatrix",
    "calculateInverseDynamics",
    "calculateJacobian",
    "calculateInverseKinematics",
)
_INERTIAL = frozenset({"mass", "localInertiaDiagonal"})
_LABELS_OF_A_LINK = 1 << 24
TOUCHES_ITSELF = 8
MAKE = ("load", "createMultiBody")
_SEVERAL_BODIES = frozenset({"loadSDF", "loadMJCF"})
_HALF_A_TURN = 1e-6
_NO_ROTATION = 1e-6
LEFT_OVER = 1e-4
SEEN_TO_BE_NEARER = 1e-6
MAINTAIN_LINK_ORDER = 131072
_QUATERNION = 4
OTHER_SHAPES_ID = re.compile(r"getCollisionShapeData \.[1-9]\d*\.([01]) ")
NOT_THE_SAME_BODY = re.compile(r"Body \d+ has .*; it had ")
NOT_A_GEAR, NO_SUCH_LINK = "of a gear has to be", "has no link"
_POSITION_CONTROL = 2
_MOTORS = ("setJointMotorControl2", "setJointMotorControlArray")


def error(seen: Seen) -> str:
    """The text of Carom's error, where only Carom raises one."""
    ours = seen.difference.place.ours
    return str(ours[1]) if seen.difference.place.field == "ok/error" else ""


def pybullet_raises(seen: Seen) -> bool:
    return seen.difference.place.field == "error/ok"


def joint_types(seen: Seen) -> dict[int, list[int]]:
    """The types of the joints of bodies, by the call that made the body."""
    types = {call["id"]: types_in_order(call) for call in seen.before}
    for call in seen.before:
        if call["f"] == "loadURDF":
            types[call["id"]] = [joint.type for joint in FILES.get(call["a"][0], ((),))[0]]
    return types


def types_in_order(call: Call) -> list[int]:
    """The types of the joints that `createMultiBody` makes, as it numbers them."""
    given = list(call["k"].get("linkJointTypes", ()))
    order = order_of_links(call)
    return [given[link] for link in order] if len(order) == len(given) else given


def order_of_links(call: Call) -> list[int]:
    """The given links of a body that `createMultiBody` makes, as it numbers them: children after parents."""
    parents = list(call["k"].get("linkParentIndices", ()))
    if call["k"].get("flags", 0) & MAINTAIN_LINK_ORDER:
        return list(range(len(parents)))
    order: list[int] = []
    waiting = [0]
    while waiting:
        parent = waiting.pop()
        order += [parent - 1] if parent else []
        # 0 is the base, and 1 the first link.
        waiting += [link + 1 for link in reversed(range(len(parents))) if parents[link] == parent]
    return order


def has_joints(seen: Seen, call: Call) -> bool:
    """Whether the body that a call makes has joints that move."""
    return any(kind != FIXED for kind in joint_types(seen).get(call["id"], ()))


def balls(seen: Seen) -> set[tuple[int, int]]:
    """The spherical joints of bodies: the call that made the body, and the joint."""
    return {
        (body, joint)
        for body, joints in joint_types(seen).items()
        for joint, kind in enumerate(joints)
        if kind == SPHERICAL
    }


def aims_a_ball_joint_by_a_number(seen: Seen) -> bool:
    """Whether position control of one number drives a spherical joint."""
    joints = balls(seen)
    return disturbs(
        seen,
        [
            call["a"][0]
            for call in seen.before
            if call["f"] in _MOTORS
            and call["a"][2] == _POSITION_CONTROL
            and any((call["a"][0]["$"], joint) in joints for joint in _listed(call["a"][1]))
        ],
    )


def _listed(joints: int | list[int]) -> list[int]:
    return joints if isinstance(joints, list) else [joints]


def starts_with_a_ball_joint(seen: Seen) -> bool:
    """Whether inverse kinematics of a body with a spherical joint is given `currentPositions`."""
    asks = seen.call["f"].startswith("calculateInverseKinematics") and "currentPositions" in seen.call["k"]
    return asks and any(body == seen.call["a"][0].get("$") for body, _ in balls(seen))


def reaches_with_a_ball_joint(seen: Seen) -> bool:
    """Whether inverse kinematics of a body with a spherical joint has another answer."""
    asks = seen.call["f"].startswith("calculateInverseKinematics")
    return asks and any(body == seen.call["a"][0].get("$") for body, _ in balls(seen))


def _poses(seen: Seen) -> Iterator[Call]:
    """The constraints made before that hold poses: not gears, nor points alone."""
    for call in seen.before:
        if call["f"] == "createConstraint" and call["a"][4] in (PRISMATIC, FIXED):
            yield call


def disturbs(seen: Seen, causes: Iterable[Any]) -> bool:
    """Whether calls about some bodies may be why others differ: all that do are these, or tied to them.

    Args:
        seen: A difference of states.
        causes: What the calls name as their bodies, or the numbers of the calls that made them.

    After a contact any body may have touched them.
    """
    made = {cause.get("$") if isinstance(cause, dict) else cause for cause in causes}
    if not made or seen.difference.phase == "contact":
        return bool(made)
    before = set[Any]()
    while made != before:
        before = set(made)
        for call in seen.before:
            if call["f"] == "createConstraint":
                ends = {end.get("$") for end in call["a"][0:3:2] if isinstance(end, dict)}
                made |= ends if ends & made else set()
    makers = [maker_of(seen, body) for body in seen.difference.bodies]
    return all(maker is None or maker["id"] in made for maker in makers)


def limits_what_has_none(seen: Seen) -> bool:
    """Whether `changeDynamics` gave limits to a fixed or spherical joint."""
    types = joint_types(seen)
    return disturbs(
        seen,
        [
            call["a"][0]
            for call in seen.before
            if call["f"] == "changeDynamics"
            and {"jointLowerLimit", "jointUpperLimit"} <= call["k"].keys()
            and call["k"]["jointLowerLimit"] <= call["k"]["jointUpperLimit"]
            and _type_of(types, call["a"]) in (FIXED, SPHERICAL)
        ],
    )


def _type_of(types: dict[int, list[int]], arguments: list[Any]) -> int | None:
    """The type of the joint that the first two arguments name."""
    joints = types.get(arguments[0]["$"], []) if isinstance(arguments[0], dict) else []
    return joints[arguments[1]] if 0 <= arguments[1] < len(joints) else None


def starts_at_a_limit(seen: Seen) -> bool:
    """Whether a body has a joint that was loaded exactly at its limit, and states hardly differ."""
    return seen.difference.place.error < LEFT_OVER and disturbs(
        seen,
        [
            call["id"]
            for call in seen.before
            if call["a"] and call["f"].startswith("load") and str(call["a"][0]) in AT_LIMITS
        ],
    )


def turns_by_no_rotation(seen: Seen, steps: int) -> bool:
    """Whether a base was reset to a quaternion whose length is not 1, at most so many steps ago."""
    return any(True for _ in _turned_by_no_rotation(seen, steps))


def is_near_what_no_rotation_turned(seen: Seen) -> bool:
    """Whether a body asked about was reset to a quaternion whose length is not 1, since the last step."""
    return any(body in seen.call["a"] for body in _turned_by_no_rotation(seen, 0))


def holds_a_ball_joint_by_no_rotation(seen: Seen) -> bool:
    """Whether a fixed base with a spherical joint was reset so, at any time: no step makes it a rotation."""
    fixed = {
        call["id"]
        for call in seen.before
        if (call["f"] == "createMultiBody" and call["a"][:1] == [0]) or call["k"].get("useFixedBase")
    }
    turned = {body["$"] for body in _turned_by_no_rotation(seen, len(seen.before)) if isinstance(body, dict)}
    return any(body in fixed & turned for body, _ in balls(seen))


def _turned_by_no_rotation(seen: Seen, steps: int) -> Iterator[Any]:
    """The bodies that were reset to a quaternion whose length is not 1, at most so many steps ago."""
    for call in reversed(seen.before):
        if call["f"] == "stepSimulation":
            steps -= 1
            if steps < 0:
                return
        if call["f"] == "resetBasePositionAndOrientation":
            turn = call["a"][2]
            if isinstance(turn, list) and abs(sum(part * part for part in turn) - 1.0) > _NO_ROTATION:
                yield call["a"][0]


def _half_turned(value: Any) -> bool:
    """Whether there is half a turn among quaternions."""
    if not isinstance(value, list):
        return False
    if len(value) == 4 and all(isinstance(part, (int, float)) for part in value):
        return abs(value[3]) < _HALF_A_TURN and any(value[:3])
    return any(map(_half_turned, value))


def holds_half_a_turn(seen: Seen) -> bool:
    """Whether a constraint of poses, or the motor of a spherical joint, turns back exactly 180 degrees."""
    if any(
        call["f"] == "resetJointStateMultiDof"
        and (call["a"][0].get("$"), call["a"][1]) in balls(seen)
        and _half_turned(call["a"][2])
        for call in seen.before
    ):
        return True
    return any(_poses(seen)) and any(
        _half_turned([*call["a"], *call["k"].values()])
        for call in seen.before
        if call["f"].startswith(("create", "load", "resetBase"))
    )


def aims_half_a_turn_away(seen: Seen) -> bool:
    """Whether the motor of a spherical joint was given half a turn as its target."""
    return disturbs(
        seen,
        [
            call["a"][0]
            for call in seen.before
            if call["f"] == "setJointMotorControlMultiDof"
            and (call["a"][0].get("$"), call["a"][1]) in balls(seen)
            and _half_turned(call["k"].get("targetPosition"))
        ],
    )


def made_for(seen: Seen, argument: Any) -> list[Call]:
    """The calls that an argument refers to, and those that these refer to."""
    made = {call["id"]: call for call in seen.before[:-1]}
    waiting, found = references(argument), list[Call]()
    while waiting:
        call = made.get(waiting.pop())
        if call is not None:
            found.append(call)
            waiting |= all_references(call)
    return found


def is_the_same_rotation(seen: Seen) -> bool:
    """Whether a pose's quaternion is that of PyBullet with the other sign."""
    theirs, ours = seen.difference.place[1:3]
    if not (isinstance(theirs, list) and isinstance(ours, list) and len(theirs) == len(ours) == _QUATERNION):
        return False
    return all(abs(a + b) < _NO_ROTATION for a, b in zip(theirs, ours, strict=True))


def forgets_forces(seen: Seen) -> bool:
    """Whether forces were applied for a step before which a state was restored."""
    applied, forgotten = list[Any](), list[Any]()
    for call in seen.before:
        if call["f"] == "restoreState":
            forgotten += applied
        if call["f"] in ("stepSimulation", "resetSimulation"):
            applied = []
        if call["f"].startswith("applyExternal"):
            applied.append(call["a"][0])
    return disturbs(seen, forgotten)


def restores_after_a_removal(seen: Seen) -> bool:
    """Whether a state was restored from before a body was removed."""
    saved = removed = False
    for call in seen.before:
        if call["f"] == "restoreState" and removed:
            return True
        removed |= saved and call["f"] == "removeBody"
        saved |= call["f"] in ("saveState", "saveBullet")
    return False


def spells_a_path_shorter(seen: Seen) -> bool:
    """Whether paths are the same but for slashes that follow slashes."""
    theirs, ours = map(str, seen.difference.place[1:3])
    return theirs != ours == re.sub("//+", "/", theirs)


def numbers_a_child_first(seen: Seen) -> bool:
    """Whether a file that lists a link before its parent was loaded in the order of its links."""
    return any(
        call["f"] == "loadURDF"
        and call["a"][0] in CHILDREN_FIRST
        and call["k"].get("flags", 0) & MAINTAIN_LINK_ORDER
        for call in seen.before
    )


def maker_of(seen: Seen, label: int) -> Call | None:
    """The call that made the body with a label in images."""
    number = label % _LABELS_OF_A_LINK
    for call in seen.before if label >= 0 else ():
        if call["f"].startswith(MAKE):
            number -= len(FILES.get(call["a"][0], ((),))) if call["f"] in _SEVERAL_BODIES else 1
            if number < 0:
                return call
    return None


def moved_since_the_last_step(seen: Seen) -> bool:
    """Whether bodies were made, set or loaded since the last step: PyBullet's bounds are those of before."""
    for call in reversed(seen.before):
        if call["f"] == "stepSimulation":
            return False
        if call["f"].startswith(("reset", "restore", "load", "createMultiBody")):
            return True
    return False


def comes_near_bare_links(seen: Seen) -> bool:
    """Whether two bodies that move may be one island by links without shapes, and states hardly differ."""
    if seen.difference.phase != "free" or seen.difference.place.error > LEFT_OVER:
        return False
    types = joint_types(seen)
    bare, moving = False, 0
    for call in seen.before:
        name = call["a"][0] if call["f"].startswith("load") and call["a"] else None
        if isinstance(name, str):
            bare |= name in BARE
            bodies = FILES.get(name, ())
            moving += sum(any(joint.type != FIXED for joint in joints) for joints in bodies)
        elif call["f"] == "createMultiBody":
            links = call["k"].get("linkCollisionShapeIndices", ())
            joints = types.get(call["id"], [])
            bare |= any(shape == -1 and joint != FIXED for shape, joint in zip(links, joints, strict=False))
            moving += has_joints(seen, call) or call["a"][:1] > [0]
    return bare and moving > 1


def goes_on_with_masses(seen: Seen) -> bool:
    """Whether masses of a body were changed after an algorithm had asked for them the first time."""
    if seen.call["f"] not in MASSES or error(seen):
        return False
    asked = False
    for call in seen.before[:-1]:
        if call["a"][:1] == seen.call["a"][:1]:
            asked |= call["f"] in MASSES
            if asked and call["f"] == "changeDynamics" and not _INERTIAL.isdisjoint(call["k"]):
                return True
    return False


def names_its_links(seen: Seen) -> bool:
    """Whether a later shape of a link has ids here that are those of the first one."""
    said = OTHER_SHAPES_ID.match(seen.difference.signature)
    whole = seen.difference.whole[1]
    return said is not None and bool(whole) and seen.difference.place.ours == whole[0][int(said[1])]


def frames_are_rotations(seen: Seen) -> bool:
    """Whether frames of a constraint are PyBullet's, but of length 1, or what it does not have is 0."""
    field, theirs, ours = seen.difference.place[:3]
    if field in (".8", ".9"):
        length = math.hypot(*theirs)
        return abs(length - 1.0) > _NO_ROTATION and all(
            abs(a - length * b) < _NO_ROTATION for a, b in zip(theirs, ours, strict=True)
        )
    return field in (".11", ".12", ".13", ".14") and ours in (0, -1)
