"""What may cause a difference in what is seen or reached from a pose."""

from __future__ import annotations

import math
from typing import Any

from tools.differ.causes.calls import Seen, error, made_for, maker_of
from tools.differ.programs import Call

_ROUND = frozenset({2, 7})
_HALF_A_TURN = 1e-9
_MARGIN = 2e-3
"""PyBullet's flat ends stand out by up to 1 mm; depths [m] are along the camera's axis."""
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_CYLINDER = 4
_USUAL_BREAKING = 0.02
_BOTH_MARGINS, _OF_OTHER_NORMALS = 2e-3, 3e-4
_MOVES = ("reset", "restore", "step")


def looks_nowhere(seen: Seen) -> bool:
    """Whether a view matrix is NaN in PyBullet, and refused here."""
    return (
        seen.call["f"] == "computeViewMatrix"
        and "straight along" in error(seen)
        and any(math.isnan(value) for value in seen.difference.place.theirs[0])
    )


def breaks_contacts_by_rounding(seen: Seen) -> bool:
    """Whether contacts hold only where their points are 0 apart, beside each other, to the last bit."""
    breaking = _USUAL_BREAKING
    for call in seen.before:
        if call["f"] == "setPhysicsEngineParameter":
            breaking = call["k"].get("contactBreakingThreshold", breaking)
    return breaking == 0.0 and seen.difference.phase == "contact"


def is_deep_at_a_cylinder(seen: Seen) -> bool:
    """Whether states differ by as little as normals do at edges of cylinders, deeper than both margins.

    A body whose state differs has a cylinder, or one whose base does not move.
    """
    bodies = [maker_of(seen, number) for number in seen.difference.bodies]
    bodies += [call for call in seen.before if call["f"] == "createMultiBody" and call["a"][:1] == [0]]
    return (
        seen.difference.phase == "contact"
        and seen.difference.deepest < -_BOTH_MARGINS
        and seen.difference.place.error < _OF_OTHER_NORMALS
        and any(body is not None and _has_a_cylinder(seen, body) for body in bodies)
    )


def _has_a_cylinder(seen: Seen, body: Call) -> bool:
    return any(map(_makes_a_cylinder, made_for(seen, [body["a"], body["k"]])))


def _makes_a_cylinder(call: Call) -> bool:
    if call["f"] == "createCollisionShapeArray":
        return _CYLINDER in call["k"]["shapeTypes"]
    return call["f"] == "createCollisionShape" and call["a"][:1] == [_CYLINDER]


def starts_half_a_turn_away(seen: Seen) -> bool:
    """Whether inverse kinematics of a body that stands as it was made turns a link by exactly 180 degrees."""
    asked = next(call for call in seen.before if call["id"] == seen.call["a"][2]["whole"])
    target, body = asked["k"].get("targetOrientation"), asked["a"][0]
    made = next((call for call in seen.before if call["id"] == body.get("$")), None)
    if target is None or made is None or made["f"] != "createMultiBody":
        return False
    moved = any(call["f"].startswith(_MOVES) for call in seen.before[: seen.before.index(asked)])
    return not moved and any(
        abs(sum(a * b for a, b in zip(target, turn, strict=True))) < _HALF_A_TURN for turn in _turns(made)
    )


def _turns(made: Call) -> list[tuple[float, ...]]:
    """Rotations of the inertial frames of the links of a body as it is made."""
    given = made["k"]
    found = []
    frames: list[Any] = given.get("linkInertialFrameOrientations", [])
    for link, own in enumerate(frames):
        turn, parent = _unit(own), link + 1
        while parent > 0:
            turn = _product(_unit(given["linkOrientations"][parent - 1]), turn)
            parent = given["linkParentIndices"][parent - 1]
        found.append(_product(_unit(given.get("baseOrientation", _NO_TURN)), turn))
    return found


def _unit(turn: Any) -> tuple[float, ...]:
    length = math.hypot(*turn)
    return tuple(part / length for part in turn)


def _product(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, ...]:
    """The quaternion (x, y, z, w) of two rotations, the second one first."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
