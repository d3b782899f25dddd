"""Faults in what is asked for: states, looks, contacts, geometry, images, algorithms and maths."""

from __future__ import annotations

from typing import Any

from tools.differ.faults.spoiling import Fault, of_each, of_one, plus, put, result, times

_CONTACT, _QUERY, _IMAGE, _STATE, _LOOK = "contacts", "queries", "images", "getters", "shapes"
_ALGORITHM, _MATHS, _BOOK = "algorithms", "maths", "books"
_AWAY = 0.05
_FEW = "links cover fewer pixels than edges of round shapes may"
_AFTER = "what is said after a contact may differ by that much"
_NEVER = "none of these programs asks for angles"
_STRIDE = 12


def _along_x(more: float) -> Any:
    return lambda point: (point[0] + more, *point[1:])


def _reversed(value: Any, *_: Any, **__: Any) -> Any:
    return tuple(value)[::-1]


def _none(*_: Any, **__: Any) -> None:
    return None


def _without_the_last(value: Any, *_: Any, **__: Any) -> Any:
    return tuple(value)[:-1] or None


def _with_another(value: Any, *_: Any, **__: Any) -> Any:
    return (*value, (0, -1)) if (0, -1) not in value else value


def _both_away(value: Any, *_: Any, **__: Any) -> Any:
    away = _along_x(_AWAY)
    return tuple(put(put(point, 5, away(point[5])), 6, away(point[6])) for point in value)


def _slid(value: Any, *_: Any, **__: Any) -> Any:
    """Both points moved across the normal by a millimetre."""
    found = []
    for point in value:
        x, y, z = point[7]
        across = (y, -x, 0.0) if abs(z) < 0.9 else (0.0, z, -y)
        a, b = (tuple(p + 1e-3 * d for p, d in zip(point[place], across, strict=True)) for place in (5, 6))
        found.append(put(put(point, 5, a), 6, b))
    return tuple(found)


def _turned_a_little(normal: Any) -> Any:
    x, y, z = normal
    return (x + 1e-3 * y, y - 1e-3 * x, z)


def _image(place: int, change: Any) -> Any:
    def changed(value: Any, *_: Any, **__: Any) -> Any:
        pixels = value[place]
        if not hasattr(pixels, "copy"):
            return put(value, place, change(list(pixels)))
        made = pixels.copy()
        made.flat[:] = change(list(pixels.flat))
        return put(value, place, made)

    return changed


def _brighter(values: list[float]) -> list[float]:
    return [min(part + 4, 255) if number % 4 < 3 else part for number, part in enumerate(values)]


def _noisy(values: list[float]) -> list[float]:
    """One pixel in thirteen is of any colour."""
    return [
        (37 * number) % 256 if number // 4 % 13 == 5 and number % 4 < 3 else part
        for number, part in enumerate(values)
    ]


def _label_of_the_base(values: list[int]) -> list[int]:
    return [part % (1 << 24) if part >= 0 else part for part in values]


def _swapped(a: int, b: int) -> Any:
    return lambda value, *_, **__: put(put(value, a, value[b]), b, value[a])


def _named(value: Any, *_: Any, **__: Any) -> Any:
    return (value[0], value[0])


def _vertex(value: Any, *_: Any, **__: Any) -> Any:
    return (value[0], tuple(plus(corner, 1e-4) for corner in value[1]))


def _first_row(value: Any, *_: Any, **__: Any) -> Any:
    return (tuple(times(row, 1 + 1e-6) for row in value[0]), value[1])


def _by(factor: float) -> Any:
    return lambda part: times(part, factor)


def _more(number: float) -> Any:
    return lambda part: plus(part, number)


def _all(change: Any) -> Any:
    return lambda value, *_, **__: change(value)


_NEAREST = "getClosestPoints"
_RAYS = "rayTest rayTestBatch"
FAULTS: tuple[Fault, ...] = (
    result(
        "inverse kinematics 1 mrad off",
        _ALGORITHM,
        "calculateInverseKinematics calculateInverseKinematics2",
        _all(_more(1e-3)),
    ),
    result("no overlaps", _QUERY, "getOverlappingObjects", _none),
    result("contacts in reverse", _CONTACT, "getContactPoints", _reversed),
    result("colours + 4", _IMAGE, "getCameraImage", _image(2, _brighter)),
    result("8 % of the pixels anything", _IMAGE, "getCameraImage", _image(2, _noisy)),
    result("fractions of rays + 1e-5", _QUERY, _RAYS, of_each(2, _more(1e-5))),
    result("nearest points 5 cm off", _QUERY, _NEAREST, _both_away),
    result("nearest points slid by 1 mm", _QUERY, _NEAREST, _slid),
    result("point on B 1 mm off", _QUERY, _NEAREST, of_each(6, _along_x(1e-3))),
    result("distances + 1e-4", _QUERY, _NEAREST, of_each(8, _more(1e-4))),
    result("normals the other way", _QUERY, _NEAREST, of_each(7, _by(-1.0))),
    result("nearest without the last", _QUERY, _NEAREST, _without_the_last),
    result("overlaps without the last", _QUERY, "getOverlappingObjects", _without_the_last),
    result("one overlap more", _QUERY, "getOverlappingObjects", _with_another),
    result("hits 0.1 mm off", _QUERY, _RAYS, of_each(3, _along_x(1e-4))),
    result("normals of rays turned by 1 mrad", _QUERY, _RAYS, of_each(4, _turned_a_little)),
    result("rays hit bases", _QUERY, _RAYS, of_each(1, lambda _: -1)),
    result("bounds 0.1 mm larger", _QUERY, "getAABB", of_one(1, _more(1e-4))),
    result("places of contacts 0.1 mm off", _CONTACT, "getContactPoints", of_each(5, _along_x(1e-4))),
    result("forces of contacts + 0.1 %", _CONTACT, "getContactPoints", of_each(9, _by(1.001))),
    result("distances of contacts + 1e-6", _CONTACT, "getContactPoints", of_each(8, _more(1e-6)), _AFTER),
    result("contacts without the last", _CONTACT, "getContactPoints", _without_the_last),
    result("depths + 0.001", _IMAGE, "getCameraImage", _image(3, _more(1e-3))),
    result("labels of links lost", _IMAGE, "getCameraImage", _image(4, _label_of_the_base), _FEW),
    result("views 1e-5 off", _IMAGE, "computeViewMatrix", _all(_by(1 + 1e-5))),
    result("lenses 1e-5 off", _IMAGE, "computeProjectionMatrixFOV", _all(_by(1 + 1e-5))),
    result("Jacobians + 1e-6", _ALGORITHM, "calculateJacobian", _first_row),
    result("mass matrices + 1e-6", _ALGORITHM, "calculateMassMatrix", _all(_by(1 + 1e-6))),
    result(
        "inverse dynamics + 1e-6",
        _ALGORITHM,
        "calculateInverseDynamics",
        _all(_by(1 + 1e-6)),
    ),
    result("one degree more", _ALGORITHM, "computeDofCount", _all(lambda value: value + 1)),
    result("links at their frames", _STATE, "getLinkState", _swapped(0, 4)),
    result(
        "velocities of links + 1e-5",
        _STATE,
        "getLinkState",
        _all(lambda value: put(value, 6, times(value[6], 1 + 1e-5)) if len(value) > 6 else value),
    ),
    result("reactions + 1e-4", _STATE, "getJointState", of_one(2, _by(1 + 1e-4))),
    result("torques of motors + 1e-4", _STATE, "getJointState", of_one(3, _by(1 + 1e-4))),
    result("damping as friction", _STATE, "getJointInfo", _swapped(6, 7)),
    result("axes the other way", _STATE, "getJointInfo", of_one(13, _by(-1.0))),
    result("moments of links + 1e-6", _STATE, "getDynamicsInfo", of_one(2, _by(1 + 1e-6))),
    result("names of bodies", _STATE, "getBodyInfo", _named),
    result("friction of links + 1e-6", _STATE, "getDynamicsInfo", of_one(1, _by(1 + 1e-6))),
    result("opaque bodies", _LOOK, "getVisualShapeData", of_each(7, lambda part: (*part[:3], 1.0))),
    result("sizes + 1e-5", _LOOK, "getCollisionShapeData", of_each(3, _by(1 + 1e-5))),
    result("corners 0.1 mm off", _LOOK, "getMeshData", _vertex),
    result("pivots + 1e-5", "constraints", "getConstraintInfo", of_one(7, _by(1 + 1e-5))),
    result(
        "forces of constraints + 0.1 %",
        "constraints",
        "getConstraintState",
        _all(_by(1.001)),
    ),
    result("angles + 1e-6", _MATHS, "getEulerFromQuaternion", _all(_more(1e-6)), _NEVER),
    result("turns + 1e-6", _MATHS, "getQuaternionFromEuler", _all(_more(1e-6))),
    result("transforms + 1e-5", _MATHS, "multiplyTransforms", of_one(0, _more(1e-5))),
    result("texts of data", _BOOK, "getUserData", _all(lambda value: value[:-1])),
    result("one text more", _BOOK, "getNumUserData", _all(lambda value: value + 1)),
    result("numbers of items", _BOOK, "addUserDebugLine", _all(lambda value: value + 1)),
)
"""By name."""
