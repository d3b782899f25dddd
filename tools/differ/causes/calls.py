"""What may cause a difference: what differs, and what the program has done before."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tools.differ.assets import (
    AT_LIMITS,
    BARE,
    CHILDREN_FIRST,
    FILES,
    FINE,
    FIXED,
    LONG_AND_ROUND,
    PRISMATIC,
    SPHERICAL,
    SWEPT,
    THIN,
)
from tools.differ.compare import DEEP, Difference
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
# Balls, cylinders and capsules.
_ROUND = frozenset({2, 4, 7})
_LONG_AND_ROUND = frozenset({4, 7})
_LABELS_OF_A_LINK = 1 << 24
_NO_LABELS = 4
TOUCHES_ITSELF = 8
MAKE = ("load", "createMultiBody")
_SEVERAL_BODIES = frozenset({"loadSDF", "loadMJCF"})
_SAME_SHADE = 12.0
_NEAR_PLANE_OF_SHADOWS = 0.05
_HALF_A_TURN = 1e-6
_NO_ROTATION = 1e-6
LEFT_OVER = 1e-4
_EXCHANGED, _AS_NEAR = 1e-4, 1e-4
_TOO_FAR, ROUNDED = 2e-4, 1e-9
# Sizes of files pass through single precision.
_AS_IN_FILES = 1e-8
SEEN_TO_BE_NEARER = 1e-6
_OF_SIMPLIFIED_HULLS = 4e-3
MARGIN, _MARGIN_OF_SWEPT = 1e-3, 0.04
_SEARCHED_DEPTH = 0.02
_SHARE_OF_ROUND_EDGES, _SHARE_FROM_CLOSE_BY, _SHARE_OF_NEARER = 0.12, 0.2, 0.9
MAINTAIN_LINK_ORDER = 131072
_QUATERNION = 4
OTHER_SHAPES_ID = re.compile(r"getCollisionShapeData \.[1-9]\d*\.[01] ")
NOT_THE_SAME_BODY = re.compile(r"Body \d+ has .*; it had ")
NOT_A_GEAR, NO_SUCH_LINK = "of a gear has to be", "has no link"
GLOBAL_VELOCITIES = 256
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
    return any(
        call["f"] in _MOTORS
        and call["a"][2] == _POSITION_CONTROL
        and any((call["a"][0]["$"], joint) in joints for joint in _listed(call["a"][1]))
        for call in seen.before
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


def limits_what_has_none(seen: Seen) -> bool:
    """Whether `changeDynamics` gave limits to a fixed or spherical joint."""
    types = joint_types(seen)
    return any(
        call["f"] == "changeDynamics"
        and {"jointLowerLimit", "jointUpperLimit"} <= call["k"].keys()
        and call["k"]["jointLowerLimit"] <= call["k"]["jointUpperLimit"]
        and _type_of(types, call["a"]) in (FIXED, SPHERICAL)
        for call in seen.before
    )


def _type_of(types: dict[int, list[int]], arguments: list[Any]) -> int | None:
    """The type of the joint that the first two arguments name."""
    joints = types.get(arguments[0]["$"], []) if isinstance(arguments[0], dict) else []
    return joints[arguments[1]] if 0 <= arguments[1] < len(joints) else None


def starts_at_a_limit(seen: Seen) -> bool:
    """Whether a body has a joint that was loaded exactly at its limit, and states hardly differ."""
    return seen.difference.place.error < LEFT_OVER and any(
        call["f"].startswith("load") and str(call["a"][0]) in AT_LIMITS for call in seen.before if call["a"]
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
    return any(
        call["f"] == "setJointMotorControlMultiDof"
        and (call["a"][0].get("$"), call["a"][1]) in balls(seen)
        and _half_turned(call["k"].get("targetPosition"))
        for call in seen.before
    )


def names_others(seen: Seen) -> bool:
    """Whether nearest points are as near as PyBullet's, but others, or the normal is."""
    return seen.differs("getClosestPoints normal", "getClosestPoints points")


def exchanges_points(seen: Seen) -> bool:
    """Whether the points of two links of one body are exchanged."""
    theirs, ours = seen.difference.place[1:3]
    exchanged = all(
        abs(a - b) < _EXCHANGED for a, b in zip(theirs[5] + theirs[6], ours[6] + ours[5], strict=True)
    )
    return theirs[1] == theirs[2] and exchanged


def names_another_face(seen: Seen) -> bool:
    """Whether shapes are deep in each other, equally so in both."""
    theirs, ours = seen.difference.place[1:3]
    return theirs[8] < DEEP and abs(theirs[8] - ours[8]) < _AS_NEAR


def is_a_little_nearer(seen: Seen, least: float = 0.0) -> bool:
    """Whether the points are nearer than PyBullet's, by little, and as far from each other as they say."""
    theirs, ours = seen.difference.place[1:3]
    return least < theirs[8] - ours[8] < _TOO_FAR and abs(math.dist(ours[5], ours[6]) - ours[8]) < ROUNDED


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


def is_farther_from_a_fine_hull(seen: Seen) -> bool:
    """Whether points are a little farther or less deep, and one shape is a hull of very many corners."""
    theirs, ours = seen.difference.place[1:3]
    if not 0.0 < ours[8] - theirs[8] < _OF_SIMPLIFIED_HULLS:
        return False
    asked = [*seen.call["a"], *seen.call["k"].values()]
    return abs(math.dist(ours[5], ours[6]) - abs(ours[8])) < ROUNDED and any(
        map(_is_fine, made_for(seen, asked))
    )


def is_thinner_than_its_margins(seen: Seen) -> bool:
    """Whether a box of a body is thinner than twice its margin, and distances differ by less."""
    theirs, ours = seen.difference.place[1:3]
    for body in seen.call["a"][:2]:
        made = [call for call in made_for(seen, body) if call["f"] == "loadURDF" and call["a"][0] in THIN]
        thickness = [THIN[call["a"][0]] * call["k"].get("globalScaling", 1.0) for call in made]
        margins = [
            call["k"]["collisionMargin"]
            for call in seen.before
            if call["f"] == "changeDynamics" and "collisionMargin" in call["k"] and call["a"][0] == body
        ]
        twice = 2.0 * max([MARGIN, *margins])
        if thickness and min(thickness) < twice and abs(theirs[8] - ours[8]) < twice:
            return True
    return False


def _is_fine(call: Call) -> bool:
    """Whether a call makes a hull of very many corners, or loads a file that has one."""
    name = call["a"][0] if call["f"].startswith("load") and call["a"] else call["k"].get("fileName")
    return name in FINE


def _swept(seen: Seen) -> list[tuple[float, float]]:
    """Of bodies with capsules given by two points their least radius, and the greatest of round shapes."""
    loaded = [call["a"][0] for body in seen.call["a"][:2] for call in made_for(seen, body) if call["a"]]
    return [SWEPT[name] for name in loaded if isinstance(name, str) and name in SWEPT]


def crosses_capsules(seen: Seen) -> bool:
    """Whether round shapes, as capsules given by two points, are deeper, at most by the sum of radii."""
    theirs, ours = seen.difference.place[1:3]
    radii = [greatest for _, greatest in _swept(seen)]
    return len(radii) == 2 and -sum(radii) - _AS_IN_FILES < ours[8] < theirs[8] < 0.0


def is_the_shorter_way_out(seen: Seen) -> bool:
    """Whether bodies are less deep in each other than PyBullet's search says, and one has such capsules."""
    theirs, ours = seen.difference.place[1:3]
    apart = abs(math.dist(ours[5], ours[6]) + ours[8])
    return bool(_swept(seen)) and 0.0 < ours[8] - theirs[8] < _SEARCHED_DEPTH and apart < ROUNDED


def is_as_thick_as_a_margin(seen: Seen) -> bool:
    """Whether PyBullet's points are nearer, by twice what a capsule given by two points lacks of a margin."""
    theirs, ours = seen.difference.place[1:3]
    least = min((least for least, _ in _swept(seen)), default=_MARGIN_OF_SWEPT)
    return 0.0 < ours[8] - theirs[8] < 2.0 * (_MARGIN_OF_SWEPT - least)


def is_the_same_rotation(seen: Seen) -> bool:
    """Whether a pose's quaternion is that of PyBullet with the other sign."""
    theirs, ours = seen.difference.place[1:3]
    if not (isinstance(theirs, list) and isinstance(ours, list) and len(theirs) == len(ours) == _QUATERNION):
        return False
    return all(abs(a + b) < _NO_ROTATION for a, b in zip(theirs, ours, strict=True))


def forgets_forces(seen: Seen) -> bool:
    """Whether forces were applied for a step before which a state was restored."""
    applied = False
    for call in seen.before:
        if call["f"] == "restoreState" and applied:
            return True
        if call["f"] in ("stepSimulation", "resetSimulation"):
            applied = False
        applied |= call["f"].startswith("applyExternal")
    return False


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


def rounder(seen: Seen) -> bool:
    """Whether depths of an image are less than PyBullet's, whose balls are polyhedra inside of ours."""
    said, ours = seen.difference.place[1:3]
    if not any(_is_round(call) for call in seen.before):
        return False
    return float(str(said).split("differ: ")[1].split(" of ")[0]) > ours


def stands_out_round(seen: Seen) -> bool:
    """Whether what an image shows elsewhere than PyBullet's is mostly nearer, and some shape is round."""
    if not any(_is_round(call) for call in seen.before):
        return False
    said = re.match(r"(\d+) of (\d+) differ, (\d+) are nearer", str(seen.difference.place.theirs))
    assert said
    wrong, count, nearer = map(int, said.groups())
    # From close by more of an image is an edge; then nothing else may differ.
    from_close_by = nearer == wrong and shows_something_round(seen, seen.difference.place.ours)
    share = _SHARE_FROM_CLOSE_BY if from_close_by else _SHARE_OF_ROUND_EDGES
    return wrong < share * count and nearer > _SHARE_OF_NEARER * wrong


def shows_something_round(seen: Seen, label: int) -> bool:
    """Whether the body with a label in images has round shapes, or may have some."""
    body = maker_of(seen, label)
    return body is not None and any(map(_is_round, [body, *made_for(seen, [body["a"], body["k"]])]))


def shades_as_a_ball(seen: Seen) -> bool:
    """Whether a pixel that is lighter or darker shows a body with cylinders or capsules."""
    said, ours = seen.difference.place[1:3]
    theirs = [float(part) for part in str(said).split("differ: [")[1].split("]")[0].split(",")]
    changes = [b - a for a, b in zip(theirs, ours, strict=True)]
    if min(changes) < -_SAME_SHADE and max(changes) > _SAME_SHADE:
        return False
    return any(shows_something_long_and_round(seen, body) for body in makers_at(seen))


def makers_at(seen: Seen) -> list[Call]:
    """The calls that may have made the body at the pixel of an image that differs."""
    if seen.call["k"].get("flags", 0) & _NO_LABELS:
        # Nothing says which body it is.
        return [call for call in seen.before if call["f"].startswith(MAKE)]
    body = maker_of(seen, int(str(seen.difference.place.theirs).rsplit(" of ", 1)[1]))
    return [] if body is None else [body]


def shows_something_long_and_round(seen: Seen, body: Call) -> bool:
    """Whether the body that a call makes has cylinders or capsules."""
    if body["f"].startswith("load"):
        return body["a"][:1] != [] and body["a"][0] in LONG_AND_ROUND
    return any(map(_is_long_and_round, made_for(seen, [body["a"], body["k"]])))


def draws_given_vertices(seen: Seen) -> bool:
    """Whether an image shows a body that PyBullet's does not: collision shapes made of vertices."""
    said = re.match(r"(\d+) of \d+ differ, (\d+) are nearer", str(seen.difference.place.theirs))
    assert said
    wrong, nearer = map(int, said.groups())
    body = maker_of(seen, seen.difference.place.ours)
    if nearer <= _SHARE_OF_NEARER * wrong or body is None or body["f"] != "createMultiBody":
        return False
    shapes, visuals = (
        [*body["a"][place : place + 1], *body["k"].get(name, ())]
        for place, name in ((1, "linkCollisionShapeIndices"), (2, "linkVisualShapeIndices"))
    )
    bare = [shape for shape, visual in zip(shapes, visuals, strict=False) if visual == -1]
    return any("vertices" in call["k"] for call in made_for(seen, bare))


def maker_of(seen: Seen, label: int) -> Call | None:
    """The call that made the body with a label in images."""
    number = label % _LABELS_OF_A_LINK
    for call in seen.before if label >= 0 else ():
        if call["f"].startswith(MAKE):
            number -= len(FILES.get(call["a"][0], ((),))) if call["f"] in _SEVERAL_BODIES else 1
            if number < 0:
                return call
    return None


def _is_long_and_round(call: Call) -> bool:
    kinds = call["k"].get("shapeTypes", call["a"][:1]) if "Shape" in call["f"] else ()
    return not _LONG_AND_ROUND.isdisjoint(kinds)


def _is_round(call: Call) -> bool:
    """Whether a call makes a round shape, or loads a file that may have some."""
    if call["f"] in ("createCollisionShape", "createVisualShape"):
        return call["a"][0] in _ROUND
    if call["f"] in ("createCollisionShapeArray", "createVisualShapeArray"):
        return not _ROUND.isdisjoint(call["k"]["shapeTypes"])
    return call["f"].startswith("load")


def moved_since_the_last_step(seen: Seen) -> bool:
    """Whether bodies were made, set or loaded since the last step: PyBullet's bounds are those of before."""
    for call in reversed(seen.before):
        if call["f"] == "stepSimulation":
            return False
        if call["f"].startswith(("reset", "restore", "load", "createMultiBody")):
            return True
    return False


def casts_shadows(seen: Seen) -> bool:
    """Whether an image has shadows that in PyBullet may be everywhere, and PyBullet's pixel is darker."""
    if seen.call["k"].get("shadow") == 0:
        return False
    said, ours = seen.difference.place[1:3]
    theirs = [float(part) for part in str(said).split("differ: [")[1].split("]")[0].split(",")]
    if any(a > b for a, b in zip(theirs, ours, strict=True)):
        return False
    projection = seen.call["a"][3]["whole"]
    made = next(call for call in seen.before if call["id"] == projection)
    near = made["a"][4 if made["f"] == "computeProjectionMatrix" else 2]
    return near == 0.0 or near >= _NEAR_PLANE_OF_SHADOWS


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
