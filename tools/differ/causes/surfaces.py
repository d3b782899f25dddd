"""Whether nearest points that are not PyBullet's are as near, and on the surfaces, as PyBullet itself says.

Where faces are parallel there are many nearest points, and searches end at any of them. PyBullet is asked for
the distance of a small ball from each of the two shapes. It stands on the point that Carom has there, and
then on PyBullet's own: where a point is on the surface, and the normal is the right one, the ball is as far
away as it was put.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tools.differ.causes.again import Performer, performed
from tools.differ.causes.nearest import MARGIN
from tools.differ.programs import Call

SURFACES = "or name another face that is about as near"
_RADIUS, _AWAY, _SEARCHED = 0.005, 0.01, 0.1
_BALL, _SPHERE = -2, 2
_OFF, _MOST = 1e-6, 1e-4
Point = Sequence[Any]


def off_surfaces(pybullet: Performer, calls: Sequence[Call], points: Sequence[Point]) -> list[float | None]:
    """How far nearest points are off the surfaces they are said to be on; None if that is not known.

    Args:
        pybullet: Performs programs by real PyBullet.
        calls: The program, up to the call that asked for the points.
        points: Points as it answered.
    """
    ball = Call(f="createCollisionShape", a=[_SPHERE], k={"radius": _RADIUS}, id=_BALL)
    asked = [_beside(calls[-1], point, side) for point in points for side in (0, 1)]
    outcome = performed(pybullet, [*calls[:-1], ball, *asked])
    answers = outcome["results"][len(calls) :]
    answers += [["lost"]] * (len(asked) - len(answers))
    off = [_off(answer) for answer in answers]
    return [None if a is None or b is None else max(a, b) for a, b in zip(off[::2], off[1::2], strict=True)]


def _off(answer: Any) -> float | None:
    """By how much a ball is nearer or farther than it was put; None if it is out of reach."""
    if answer[0] != "ok" or not answer[1]:
        return None
    off = abs(min(near[8] for near in answer[1]) - (_AWAY - _RADIUS))
    # Hulls of links end a margin outside of what is drawn, and are searched so.
    return min(off, abs(off - MARGIN))


def _beside(asked: Call, point: Point, side: int) -> Call:
    """A question for the distance of a ball beside a point from the shape that this is on."""
    letter, way = ("A", -1.0) if side == 0 else ("B", 1.0)
    centre = [part + way * _AWAY * normal for part, normal in zip(point[5 + side], point[7], strict=True)]
    keywords: dict[str, Any] = {"collisionShapeB": {"$": _BALL}, "collisionShapePositionB": centre}
    body = point[1 + side]
    if body >= 0:
        keywords["linkIndexA"] = point[3 + side]
    else:
        for name in ("collisionShape", "collisionShapePosition", "collisionShapeOrientation"):
            if name + letter in asked["k"]:
                keywords[f"{name}A"] = asked["k"][name + letter]
    return Call(f="getClosestPoints", a=[body, -1, _SEARCHED], k=keywords, id=-1)


def is_as_good(theirs: float | None, ours: float | None) -> bool:
    """Whether Carom's points are on the surfaces as PyBullet's are."""
    return ours is not None and ours < _OFF + min(theirs or 0.0, _MOST)
