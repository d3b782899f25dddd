"""Differences that docs/differences states: they are counted, and not reported.

Each is recognised by what differs and by what the program has done before. A new one belongs here only
with the words that docs/differences has about it, or with a reason why it is no difference.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tools.differ.assets import AT_LIMITS, FILES, FIXED, GEAR, PRISMATIC, SPHERICAL
from tools.differ.compare import Difference
from tools.differ.programs import Call


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


@dataclass(frozen=True)
class Known:
    """A known difference.

    Attributes:
        says: Words of docs/differences.
        recognises: Whether a difference is one of this kind.
    """

    says: str
    recognises: Callable[[Seen], bool]


_MASSES = (
    "calculateMassMatrix",
    "calculateInverseDynamics",
    "calculateJacobian",
    "calculateInverseKinematics",
)
_SHAPE_OF_HEIGHTS = 9
_NEAR_PLANE_OF_SHADOWS = 0.05
_HALF_A_TURN = 1e-6
_NO_ROTATION = 1e-6
_LEFT_OVER = 1e-4
_EXCHANGED, _AS_NEAR = 1e-3, 1e-4
_GEAR, _NO_SUCH_LINK = "of a gear has to be", "has no link"
_GLOBAL_VELOCITIES = 256
_POSITION_CONTROL = 2


def _error(seen: Seen) -> str:
    """The text of Carom's error, where only Carom raises one."""
    ours = seen.difference.place.ours
    return str(ours[1]) if seen.difference.place.field == "ok/error" else ""


def _pybullet_raises(seen: Seen) -> bool:
    return seen.difference.place.field == "error/ok"


def _joint_types(seen: Seen) -> dict[int, list[int]]:
    """The types of the joints of bodies, by the call that made the body."""
    types = {call["id"]: list(call["k"].get("linkJointTypes", ())) for call in seen.before}
    for call in seen.before:
        if call["f"] == "loadURDF":
            types[call["id"]] = [joint.type for joint in FILES.get(call["a"][0], ((),))[0]]
    return types


def _balls(seen: Seen) -> set[tuple[int, int]]:
    """The spherical joints of bodies: the call that made the body, and the joint."""
    return {
        (body, joint)
        for body, joints in _joint_types(seen).items()
        for joint, kind in enumerate(joints)
        if kind == SPHERICAL
    }


def _aims_a_ball_joint_by_a_number(seen: Seen) -> bool:
    """Whether position control of one number drives a spherical joint."""
    balls = _balls(seen)
    return any(
        call["f"] == "setJointMotorControl2"
        and call["a"][2] == _POSITION_CONTROL
        and (call["a"][0]["$"], call["a"][1]) in balls
        for call in seen.before
    )


def _starts_with_a_ball_joint(seen: Seen) -> bool:
    """Whether inverse kinematics of a body with a spherical joint is given `currentPositions`."""
    asks = seen.call["f"].startswith("calculateInverseKinematics") and "currentPositions" in seen.call["k"]
    return asks and any(body == seen.call["a"][0].get("$") for body, _ in _balls(seen))


def _poses(seen: Seen) -> Iterator[Call]:
    """The constraints made before that hold poses: not gears, nor points alone."""
    for call in seen.before:
        if call["f"] == "createConstraint" and call["a"][4] in (PRISMATIC, FIXED):
            yield call


def _holds_what_cannot_move(seen: Seen) -> bool:
    """Whether both ends of a constraint are bases that may be fixed, or the world."""
    made = {call["id"]: call for call in seen.before}
    return any(
        call["f"] == "createConstraint"
        and call["a"][4] != GEAR
        and call["a"][1] == -1
        and _may_be_fixed(made, call["a"][0])
        and (call["a"][2] == -1 or (call["a"][3] == -1 and _may_be_fixed(made, call["a"][2])))
        for call in seen.before
    )


def _may_be_fixed(made: dict[int, Call], body: Any) -> bool:
    """Whether a body was made without mass, with a fixed base, or from a file that may say so."""
    call = made[body["$"]] if isinstance(body, dict) and body["$"] in made else None
    if call is None:
        return False
    if call["f"] == "createMultiBody":
        return not (call["a"][:1] or [call["k"].get("baseMass", 0)])[0]
    return True


def _limits_what_has_none(seen: Seen) -> bool:
    """Whether `changeDynamics` gave limits to a fixed or spherical joint."""
    types = _joint_types(seen)
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


def _starts_at_a_limit(seen: Seen) -> bool:
    """Whether a body has a joint that was loaded exactly at its limit, and states hardly differ."""
    return seen.difference.place.error < _LEFT_OVER and any(
        call["f"].startswith("load") and str(call["a"][0]) in AT_LIMITS for call in seen.before if call["a"]
    )


def _turns_by_no_rotation(seen: Seen) -> bool:
    """Whether a base was reset to a quaternion whose length is not 1, and no step came after it."""
    for call in reversed(seen.before):
        if call["f"] == "stepSimulation":
            return False
        if call["f"] == "resetBasePositionAndOrientation":
            turn = call["a"][2]
            if isinstance(turn, list) and abs(sum(part * part for part in turn) - 1.0) > _NO_ROTATION:
                return True
    return False


def _half_turned(value: Any) -> bool:
    """Whether there is half a turn among quaternions."""
    if not isinstance(value, list):
        return False
    if len(value) == 4 and all(isinstance(part, (int, float)) for part in value):
        return abs(value[3]) < _HALF_A_TURN and any(value[:3])
    return any(map(_half_turned, value))


def _holds_half_a_turn(seen: Seen) -> bool:
    """Whether there is a constraint of poses, and a frame that is turned by exactly 180 degrees."""
    return any(_poses(seen)) and any(
        _half_turned([*call["a"], *call["k"].values()])
        for call in seen.before
        if call["f"].startswith(("create", "load", "resetBase"))
    )


def _exchanges_points(seen: Seen) -> bool:
    """Whether the points of two links of one body are exchanged."""
    theirs, ours = seen.difference.place[1:3]
    return theirs[1] == theirs[2] and all(
        abs(a - b) < _EXCHANGED for a, b in zip(theirs[5] + theirs[6], ours[6] + ours[5], strict=True)
    )


def _names_another_face(seen: Seen) -> bool:
    """Whether shapes are in each other, equally deep in both."""
    theirs, ours = seen.difference.place[1:3]
    return theirs[8] < 0 and abs(theirs[8] - ours[8]) < _AS_NEAR


def _nothing_hit_before_the_first_step(seen: Seen) -> bool:
    theirs = seen.difference.place.theirs
    return seen.difference.phase == "start" and seen.differs("rayTest") and theirs[0] == -1


def _rounder(seen: Seen) -> bool:
    """Whether depths of an image are less than PyBullet's, whose balls are polyhedra inside of ours."""
    said, ours = seen.difference.place[1:3]
    return float(str(said).split("differ: ")[1].split(" of ")[0]) > ours


def _reaches_from_positions(seen: Seen) -> bool:
    """Whether an answer of inverse kinematics, for a target in the base's inertial frame, is further off."""
    made = seen.call["a"][2]["whole"]
    return any(call["id"] == made and "currentPositions" in call["k"] for call in seen.before)


def _casts_shadows(seen: Seen) -> bool:
    """Whether an image has shadows that in PyBullet may be everywhere."""
    if seen.call["k"].get("shadow") == 0:
        return False
    projection = seen.call["a"][3]["whole"]
    made = next(call for call in seen.before if call["id"] == projection)
    near = made["a"][4 if made["f"] == "computeProjectionMatrix" else 2]
    return near >= _NEAR_PLANE_OF_SHADOWS


def _makes(seen: Seen, *kinds: int) -> bool:
    return any(call["f"] == "createCollisionShape" and call["a"][0] in kinds for call in seen.before)


KNOWN: tuple[Known, ...] = (
    Known(
        "Every entry of `getCollisionShapeData` has the ids of its body and link",
        lambda seen: seen.differs("getCollisionShapeData .1.0", "getCollisionShapeData .1.1"),
    ),
    Known(
        "`getVisualShapeData` reports the texture that `changeVisualShape` has put on",
        lambda seen: (
            seen.call["f"] == "getVisualShapeData"
            and seen.difference.place.field.endswith(".8")
            and seen.has("changeVisualShape", "textureUniqueId")
        ),
    ),
    Known(
        "`getVisualShapeData` says where a geom given by `fromto` is",
        lambda seen: (
            seen.call["f"] == "getVisualShapeData"
            and seen.difference.place.field.endswith((".5", ".6"))
            and seen.has("loadMJCF")
        ),
    ),
    Known(
        "`getOverlappingObjects` lists links in the order of bodies and links, by their present bounds.",
        lambda seen: seen.call["f"] == "getOverlappingObjects",
    ),
    Known(
        "`createConstraint` refuses a child body or link that does not exist, and gears",
        lambda seen: (
            seen.call["f"] == "createConstraint" and (_GEAR in _error(seen) or _NO_SUCH_LINK in _error(seen))
        ),
    ),
    Known(
        "PyBullet numbers the fixed joints it makes of MJCF bodies",
        lambda seen: seen.differs("getJointInfo .1 ") and "jointfix" in str(seen.difference.place.theirs),
    ),
    Known(
        "`calculateJacobian` refuses links that do not exist",
        lambda seen: seen.call["f"] == "calculateJacobian" and _NO_SUCH_LINK in _error(seen),
    ),
    Known(
        "PyBullet exchanges the points of some pairs of links of one body",
        lambda seen: seen.differs("getClosestPoints normal") and _exchanges_points(seen),
    ),
    Known(
        "or name another face that is about as near",
        lambda seen: seen.differs("getClosestPoints normal") and _names_another_face(seen),
    ),
    Known("PyBullet does not hit what a ray passes outside", _nothing_hit_before_the_first_step),
    Known(
        "**Round shapes are round.**",
        lambda seen: seen.differs("getCameraImage depth") and _rounder(seen),
    ),
    Known(
        "With `currentPositions` the target is in the inertial frame of the base",
        lambda seen: seen.differs("@reach worse") and _reaches_from_positions(seen),
    ),
    Known(
        "Where PyBullet darkens everything in reach of the light",
        lambda seen: seen.differs("getCameraImage colour") and _casts_shadows(seen),
    ),
    Known(
        "Constraints between bodies that cannot move",
        lambda seen: seen.differs("@probe") and _holds_what_cannot_move(seen),
    ),
    Known(
        "So do limits that `changeDynamics` gives to fixed and spherical joints",
        lambda seen: seen.differs("@probe") and _limits_what_has_none(seen),
    ),
    Known(
        "Whether a joint that stands exactly at its limit is beyond it",
        lambda seen: seen.differs("@probe") and _starts_at_a_limit(seen),
    ),
    Known(
        "places links as if the base were larger by the square of that length",
        lambda seen: seen.differs("getLinkState") and _turns_by_no_rotation(seen),
    ),
    Known(
        "In PyBullet motors keep the targets they have",
        lambda seen: (
            seen.has("restoreState")
            and seen.differs("getJointState .3", "getJointState .2", "getJointStates .", "@probe reactions")
        ),
    ),
    Known(
        "PyBullet matches bodies by their order",
        lambda seen: seen.call["f"] == "restoreState" and _pybullet_raises(seen) and seen.has("removeBody"),
    ),
    Known(
        "Which way a constraint turns back what is turned by exactly 180 degrees",
        lambda seen: seen.differs("@probe") and _holds_half_a_turn(seen),
    ),
    Known(
        "`applyExternalForce` and `applyExternalTorque` refuse links that do not exist.",
        lambda seen: seen.call["f"].startswith("applyExternal") and _NO_SUCH_LINK in _error(seen),
    ),
    Known(
        "`getConstraintInfo` reports frames as rotations, of length 1",
        lambda seen: seen.differs(*(f"getConstraintInfo .{place} " for place in (8, 9, 11, 12, 13, 14))),
    ),
    Known(
        "PyBullet **remembers masses and inertias** from the first call",
        lambda seen: seen.call["f"] in _MASSES and not _error(seen) and seen.has("changeDynamics"),
    ),
    Known(
        "PyBullet refuses `currentPositions` of robots with spherical joints",
        _starts_with_a_ball_joint,
    ),
    Known(
        "Where PyBullet finds no answer at all for a body, it raises; here there is one.",
        lambda seen: seen.call["f"] in (*_MASSES, "calculateInverseKinematics2") and _pybullet_raises(seen),
    ),
    Known(
        "`URDF_GLOBAL_VELOCITIES_MB` has no effect.",
        lambda seen: (
            seen.differs("@probe")
            and any(
                call["k"].get("flags", 0) & _GLOBAL_VELOCITIES
                for call in seen.before
                if call["f"] != "rayTest"
            )
        ),
    ),
    Known(
        "**A number as `targetPosition` of a spherical joint**",
        lambda seen: seen.differs("@probe", "getJointState") and _aims_a_ball_joint_by_a_number(seen),
    ),
    Known(
        "**on triangle meshes and height fields** shapes touch with all points at once",
        lambda seen: (
            seen.difference.phase == "contact"
            and seen.differs("@probe", "getContactPoints")
            and _makes(seen, _SHAPE_OF_HEIGHTS)
        ),
    ),
)


def statement(calls: Sequence[Call], difference: Difference) -> str | None:
    """The words of docs/differences about a difference; None if there are none."""
    seen = Seen(difference, calls[: difference.call + 1])
    return next((known.says for known in KNOWN if known.recognises(seen)), None)
