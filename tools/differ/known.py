"""Differences that docs/differences states: they are counted, and not reported.

Each is recognised by what differs and by what the program has done before. A new one belongs here only
with the words that docs/differences has about it, or with a reason why it is no difference.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tools.differ.assets import SPHERICAL
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
_GEAR, _NO_SUCH_LINK = "of a gear has to be", "has no link"
_GLOBAL_VELOCITIES = 256
_POSITION_CONTROL = 2


def _error(seen: Seen) -> str:
    """The text of Carom's error, where only Carom raises one."""
    ours = seen.difference.place.ours
    return str(ours[1]) if seen.difference.place.field == "ok/error" else ""


def _pybullet_raises(seen: Seen) -> bool:
    return seen.difference.place.field == "error/ok"


def _aims_a_ball_joint_by_a_number(seen: Seen) -> bool:
    """Whether position control of one number drives a spherical joint of a body made of shapes."""
    balls = {
        (call["id"], joint)
        for call in seen.before
        for joint, kind in enumerate(call["k"].get("linkJointTypes", ()))
        if kind == SPHERICAL
    }
    return any(
        call["f"] == "setJointMotorControl2"
        and call["a"][2] == _POSITION_CONTROL
        and (call["a"][0]["$"], call["a"][1]) in balls
        for call in seen.before
    )


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
        "Where PyBullet finds no answer at all for a body, it raises; here there is one.",
        lambda seen: seen.call["f"] in _MASSES and _pybullet_raises(seen),
    ),
    Known(
        "`collisionMargin` of `changeDynamics` widens the bounds (`getAABB`) of a body of several shapes",
        lambda seen: (
            seen.has("changeDynamics", "collisionMargin") and not seen.differs("getDynamicsInfo .11")
        ),
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
