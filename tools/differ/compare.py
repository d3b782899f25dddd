"""Where the results of a program differ between PyBullet and Carom.

Up to the first contact everything has to agree to `STRICT` of the largest number beside it; after it the
first steps to `AFTER_CONTACT`, and what follows not at all, since contacts make rounding grow. After the
first step whose `@probe` differs nothing is compared, as everything else would follow from it; nor is
anything after a step in which bodies are in each other deeper than `DEEP`, which docs/differences has a
paragraph about, or where PyBullet's own state is NaN. Of contacts that are so deep only the links are
compared, whichever comes first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tools.differ.answers import COMPARED
from tools.differ.pair import Outcome
from tools.differ.programs import Call
from tools.differ.values import Place, first_difference, lost

STRICT, AFTER_CONTACT = 1e-9, 1e-6
STEPS_AFTER_CONTACT = 6
DEEP = -0.005
"""Distance of contact points [m] below which PyBullet's own motion is left to rounding."""
_REACTIONS = 100.0
# PyBullet passes through single precision, where Carom does not; or iterates to a bound of its own.
_SINGLE = dict.fromkeys(
    (
        "computeProjectionMatrix",
        "computeProjectionMatrixFOV",
        "computeViewMatrix",
        "computeViewMatrixFromYawPitchRoll",
        "calculateVelocityQuaternion",
        "getAxisAngleFromQuaternion",
        "getAxisDifferenceQuaternion",
        "getCollisionShapeData",
        "getDifferenceQuaternion",
        "getLinkState",
        "getLinkStates",
        "getMatrixFromQuaternion",
        "getQuaternionFromAxisAngle",
        "getQuaternionSlerp",
        "getVisualShapeData",
        "invertTransform",
        "multiplyTransforms",
        "rotateVector",
    ),
    1e-6,
) | {"getContactPoints": 1e-7}
_PARTS = ("base", "positions", "velocities", "reactions")


@dataclass(frozen=True)
class Difference:
    """One difference.

    Attributes:
        call: The place of its call in the program.
        function: What was called.
        place: Which part of the result differs, and how.
        phase: "start" before the first step, "free" before the first contact, "contact" after it.
        deepest: The least distance [m] of contact points of the step, 0 if none are below; of `@probe` only.
        bodies: The ids of the bodies whose states differ; of `@probe` only.
        whole: All that PyBullet's call returned, and Carom's.
    """

    call: int
    function: str
    place: Place
    phase: str
    deepest: float = 0.0
    bodies: tuple[int, ...] = ()
    whole: tuple[Any, Any] = (None, None)

    @property
    def signature(self) -> str:
        """Differences of one signature are probably of one kind."""
        return f"{self.function} {self.place.field} {self.phase}"


class _Lost(Exception):
    """PyBullet's state is NaN."""


def compare(
    calls: Sequence[Call],
    theirs: Outcome,
    ours: Outcome,
    strict: float = STRICT,
    after_contact: float = AFTER_CONTACT,
) -> list[Difference]:
    """All differences between the results of a program, as far as they can be compared.

    Args:
        calls: The program.
        theirs: PyBullet's results.
        ours: Carom's.
        strict: The greatest difference of numbers that agree, before the first contact.
        after_contact: The same after it.
    """
    found: list[Difference] = []
    phase, since = "start", 0
    a, b = theirs["results"], ours["results"]
    for number, (x, y) in enumerate(zip(a, b, strict=False)):
        function = calls[number]["f"]
        if function == "stepSimulation" and phase == "start":
            phase = "free"
        if function == "@probe" and x[0] == y[0] == "ok":
            if phase == "free" and (x[1][1] or y[1][1]):
                phase = "contact"
            since += phase == "contact"
            if since > STEPS_AFTER_CONTACT or min(x[1][2], y[1][2]) < DEEP:
                return found
        bound = after_contact if phase == "contact" else strict
        try:
            places = differences(function, x, y, bound)
        except _Lost:
            return found
        for place in places:
            probed = function == "@probe" and x[0] == y[0] == "ok"
            deepest = min(x[1][2], y[1][2]) if probed else 0.0
            bodies = _bodies_that_differ(x[1][0], y[1][0], bound) if probed else ()
            whole = (x[1], y[1])
            found.append(Difference(number, function, place, phase, deepest, bodies, whole))
        if places and (function == "@probe" or x[0] != y[0]):
            return found
    if ours["died"] and len(b) < len(a):
        place = Place("died", theirs["died"], ours["died"])
        found.append(Difference(len(b), calls[len(b)]["f"], place, phase))
    return found


def difference(function: str, theirs: Any, ours: Any, bound: float) -> Place | None:
    """Where two results of a call differ first, or None."""
    return next(iter(differences(function, theirs, ours, bound)), None)


def differences(function: str, theirs: Any, ours: Any, bound: float) -> list[Place]:
    """Where two results of a call differ: several places where its parts are looked at one by one."""
    found = _difference(function, theirs, ours, bound)
    return found if isinstance(found, list) else [found] if found else []


def _difference(function: str, theirs: Any, ours: Any, bound: float) -> Place | list[Place] | None:
    if theirs[0] != ours[0]:
        return Place(f"{theirs[0]}/{ours[0]}", theirs[1:], ours[1:])
    if theirs[0] == "lost":
        return None
    if theirs[0] == "error":
        # A message of ours begins with PyBullet's, and says more.
        same = ours[2].startswith(theirs[2].rstrip(" .")) or theirs[2].endswith("exception set")
        return None if same else Place("text", theirs[1:], ours[1:])
    if function == "stepSimulation":
        # Reports of the solver are of islands, which are others: docs/differences.
        return None
    if function == "@probe":
        return _of_probes(theirs[1], ours[1], bound)
    if function == "getContactPoints" and _deepest(theirs[1], ours[1]) < DEEP:
        return _of_touching(theirs[1], ours[1])
    if function in COMPARED:
        return COMPARED[function](theirs[1], ours[1])
    return first_difference(theirs[1], ours[1], max(bound, _SINGLE.get(function, 0)))


def _deepest(*lists: Any) -> float:
    """The least distance of any contact in lists of contacts."""
    return min((point[8] for points in lists for point in points or []), default=0.0)


def _of_touching(theirs: Any, ours: Any) -> Place | None:
    """Which links touch."""
    a, b = (
        sorted({tuple(sorted(((point[1], point[3]), (point[2], point[4])))) for point in points or []})
        for points in (theirs, ours)
    )
    return (
        None
        if a == b
        else Place("links", [one for one in a if one not in b], [one for one in b if one not in a])
    )


def _of_probes(theirs: Any, ours: Any, bound: float) -> Place | None:
    if lost(theirs[0]):
        raise _Lost
    for number, part in enumerate(_PARTS, 1):
        a, b = ([body[number] for body in state[0]] for state in (theirs, ours))
        place = first_difference(a, b, bound * (_REACTIONS if part == "reactions" else 1))
        if place:
            return place._replace(field=part + place.field)
    if bound == STRICT and theirs[1] != ours[1]:
        return Place("contacts", theirs[1], ours[1])
    return None


def _bodies_that_differ(theirs: Any, ours: Any, bound: float) -> tuple[int, ...]:
    """The ids of bodies that are elsewhere, or move otherwise."""
    pairs = zip(theirs, ours, strict=False)
    return tuple(int(a[0]) for a, b in pairs if first_difference(a[1:4], b[1:4], bound))
