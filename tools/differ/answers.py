"""Answers whose parts are compared each in its own way: images, rays, nearest points, and the like."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterator
from typing import Any

from tools.differ.images import of_images
from tools.differ.values import Place, first_difference, lost

_FRACTION, _HIT, _NORMAL_OF_RAY = 1e-9, 1e-7, 1e-4
_DISTANCE, _DEPTH_OF_HULLS, _NORMAL, _TOUCHING = 2e-5, 1e-4, 1e-2, 1e-3
_BESIDE, _SAME_POINT = 1e-9, 1e-4
_FURTHER, _TURNED = 2e-3, 0.02
_ARRIVED, _ARRIVED_TURNED, _OTHER_POSE = 1e-4, 1e-3, 1e-3
_OTHER_ANSWER = 1e-5
_LIMIT = 2.5
_CORNER, _LARGE_HULL = 1e-5, 32
_DIRECTIONS, _STANDS_OUT = 200, 1e-3


def of_rays(theirs: Any, ours: Any) -> list[Place]:
    """What rays hit, how far away and where, and the normals there: a place for each ray."""
    theirs, ours = theirs or [], ours or []
    if len(theirs) != len(ours):
        return [Place("len", theirs, ours)]
    return [place for a, b in zip(theirs, ours, strict=True) for place in _of_one_ray(a, b)]


def _of_one_ray(a: Any, b: Any) -> Iterator[Place]:
    away = _furthest(a[3], b[3])
    if a[:2] != b[:2]:
        yield Place("hit", a, b)
    elif abs(a[2] - b[2]) > _FRACTION:
        yield Place("fraction", a, b, abs(a[2] - b[2]))
    elif away > _HIT:
        yield Place("position", a, b, away)
    elif _furthest(a[4], b[4]) > _NORMAL_OF_RAY:
        yield Place("normal", a, b)


def of_nearest(theirs: Any, ours: Any) -> list[Place]:
    """The nearest points of links, a place for each pair; PyBullet reports points for each triangle."""
    a, b = _by_links(theirs), _by_links(ours)
    found: list[Place] = []
    if a.keys() != b.keys():
        gone, new = sorted(a.keys() - b.keys()), sorted(b.keys() - a.keys())
        found.append(Place("pairs", [a[links][0] for links in gone], [b[links][0] for links in new]))
    for links in (pair for pair in a if pair in b):
        place = _of_one_pair(a[links], b[links])
        found += [place] if place else []
    return found


def _of_one_pair(theirs: list[Any], ours: list[Any]) -> Place | None:
    """How the points of two links differ: the nearest ones, and how many there are."""
    for point in ours:
        beside = _furthest(point[5], [b + point[8] * n for b, n in zip(*point[6:8], strict=True)])
        if beside > _BESIDE:
            return Place("beside", theirs[0], point, beside)
    v, w = (min(points, key=lambda point: point[8]) for points in (theirs, ours))
    error = abs(v[8] - w[8])
    # PyBullet's search for a depth ends where a tenth of a millimetre is left.
    if error > (_DISTANCE if max(v[8], w[8]) > 0 else _DEPTH_OF_HULLS):
        return Place("distance" if v[8] > 0 else "depth", v, w, error)
    alone = len(theirs) == len(ours) == 1
    if alone and abs(v[8]) > _TOUCHING and _furthest(v[7], w[7]) > _NORMAL:
        return Place("normal", v, w)
    if len(theirs) < len(ours):
        return Place("fewer", theirs, ours)
    away = max(_furthest(v[5], w[5]), _furthest(v[6], w[6]))
    return Place("points", v, w, away) if away > _SAME_POINT else None


def _by_links(points: Any) -> dict[tuple[int, ...], list[Any]]:
    pairs: dict[tuple[int, ...], list[Any]] = {}
    for point in points or []:
        # A link is not asked for its distance from itself.
        if point[1] != point[2] or point[3] != point[4]:
            pairs.setdefault(tuple(point[1:5]), []).append(point)
    return pairs


def of_reach(theirs: Any, ours: Any) -> Place | None:
    """Whether an answer of inverse kinematics is worse than PyBullet's, or another where that arrives."""
    if lost(theirs) or any(abs(position) > _LIMIT for position in theirs[2]):
        return None
    error = math.hypot(*ours[:2]) - math.hypot(*theirs[:2])
    if error > _FURTHER or (ours[0] > theirs[0] - _FURTHER / 2 and ours[1] > theirs[1] + _TURNED):
        return Place("worse", theirs, ours, error)
    arrived = theirs[0] < _ARRIVED and theirs[1] < _ARRIVED_TURNED
    if arrived and _furthest(theirs[2], ours[2]) > _OTHER_POSE:
        return Place("other", theirs, ours)
    return None


def of_kinematics(theirs: Any, ours: Any) -> Place | None:
    """Whether there is an answer, and PyBullet's; `@reach` says how good it is."""
    if lost(ours):
        return Place("nan", theirs, ours)
    if lost(theirs):
        return None
    apart = _furthest(theirs, ours)
    return Place("answer", theirs, ours, apart) if apart > _OTHER_ANSWER else None


def of_meshes(theirs: Any, ours: Any) -> Place | None:
    """Corners of meshes, in whatever order; of large hulls those that hardly stand out may be others."""
    if not theirs or not ours:
        return first_difference(theirs, ours, 0)
    gone, new = _not_among(theirs[1], ours[1]), _not_among(ours[1], theirs[1])
    if not gone and not new:
        return None
    if min(len(theirs[1]), len(ours[1])) < _LARGE_HULL:
        return Place("corners", gone, new)
    error = max(
        abs(_extent(theirs[1], direction) - _extent(ours[1], direction))
        / (_extent(theirs[1], direction) + _extent(theirs[1], [-part for part in direction]))
        for direction in _directions()
    )
    return Place("hull", gone, new, error) if error > _STANDS_OUT else None


def _extent(corners: list[list[float]], direction: list[float]) -> float:
    """How far corners reach in a direction."""
    return max(sum(a * b for a, b in zip(corner, direction, strict=True)) for corner in corners)


def _directions() -> list[list[float]]:
    """Directions all around, on a spiral from pole to pole."""
    heights = [(2 * number + 1) / _DIRECTIONS - 1 for number in range(_DIRECTIONS)]
    turns = [number * math.pi * (3 - math.sqrt(5)) for number in range(_DIRECTIONS)]
    return [
        [math.sqrt(1 - z * z) * math.cos(turn), math.sqrt(1 - z * z) * math.sin(turn), z]
        for z, turn in zip(heights, turns, strict=True)
    ]


def _not_among(corners: list[list[float]], others: list[list[float]]) -> list[list[float]]:
    """The corners that are not in a list of others."""
    ordered = sorted(others)
    gone = []
    for corner in corners:
        first = bisect_left(ordered, [corner[0] - _CORNER])
        last = bisect_left(ordered, [corner[0] + _CORNER])
        if not any(_furthest(corner, other) <= _CORNER for other in ordered[first:last]):
            gone.append(corner)
    return gone


def of_overlaps(theirs: Any, ours: Any) -> Place | None:
    """Links in a box, in whatever order; PyBullet's bounds are wider."""
    missing = [pair for pair in theirs or [] if pair not in (ours or [])]
    new = [pair for pair in ours or [] if pair not in (theirs or [])]
    return Place("new", missing, new) if new else Place("missing", missing, new) if missing else None


def _furthest(a: list[float], b: list[float]) -> float:
    return max((abs(x - y) for x, y in zip(a, b, strict=True)), default=0.0)


COMPARED: dict[str, Callable[[Any, Any], Place | list[Place] | None]] = {
    "@reach": of_reach,
    "calculateInverseKinematics": of_kinematics,
    "calculateInverseKinematics2": of_kinematics,
    "getCameraImage": of_images,
    "getClosestPoints": of_nearest,
    "getMeshData": of_meshes,
    "getOverlappingObjects": of_overlaps,
    "rayTest": of_rays,
    "rayTestBatch": of_rays,
}
"""By function."""
