"""Answers whose parts are compared each in its own way: images, rays, nearest points, and the like."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable
from typing import Any

from tools.differ.values import Place, first_difference, lost

_SIZE_OF_FRACTION, _SAME_FRACTION, _NORMAL_OF_RAY = 2e-3, 1e-7, 1e-4
_DISTANCE, _DEPTH_OF_HULLS, _NORMAL, _TOUCHING = 2e-5, 1e-4, 1e-2, 1e-3
_FURTHER, _TURNED = 2e-3, 0.02
_ARRIVED, _ARRIVED_TURNED, _OTHER_POSE = 1e-4, 1e-3, 1e-3
_OTHER_ANSWER = 1e-5
_LIMIT = 2.5
_SHARE_OF_SEGMENTS, _SHARE_OF_DEPTHS, _SHARE_OF_COLOURS = 0.06, 0.04, 0.08
_DEPTH, _COLOUR = 2e-3, 12
_NOTHING = 1 - 1e-6
_CORNER, _LARGE_HULL = 1e-5, 32
_DIRECTIONS, _STANDS_OUT = 200, 1e-3


def of_rays(theirs: Any, ours: Any) -> Place | None:
    """What rays hit, how far away, and the normals there."""
    theirs, ours = theirs or [], ours or []
    if len(theirs) != len(ours):
        return Place("len", theirs, ours)
    for a, b in zip(theirs, ours, strict=True):
        if a[:2] != b[:2]:
            return Place("hit", a, b)
        error = abs(a[2] - b[2])
        if error > _SIZE_OF_FRACTION:
            return Place("fraction", a, b, error)
        if error < _SAME_FRACTION and _furthest(a[4], b[4]) > _NORMAL_OF_RAY:
            return Place("normal", a, b)
    return None


def of_nearest(theirs: Any, ours: Any) -> Place | None:
    """The distances of links; PyBullet reports points for each triangle of a mesh."""
    a, b = _by_links(theirs), _by_links(ours)
    if a.keys() != b.keys():
        gone, new = sorted(a.keys() - b.keys()), sorted(b.keys() - a.keys())
        return Place("pairs", [a[links][0] for links in gone], [b[links][0] for links in new])
    for links in a:
        v, w = (min(points[links], key=lambda point: point[8]) for points in (a, b))
        error = abs(v[8] - w[8])
        # PyBullet's search for a depth ends where a tenth of a millimetre is left.
        if error > (_DISTANCE if max(v[8], w[8]) > 0 else _DEPTH_OF_HULLS):
            return Place("distance" if v[8] > 0 else "depth", v, w, error)
        alone = len(a[links]) == len(b[links]) == 1
        if alone and abs(v[8]) > _TOUCHING and _furthest(v[7], w[7]) > _NORMAL:
            return Place("normal", v, w)
        if len(a[links]) < len(b[links]):
            return Place("fewer", a[links], b[links])
    return None


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


def of_images(theirs: Any, ours: Any) -> Place | None:
    """Colours, depths and segments: some pixels may differ, by edges and round shapes."""
    if theirs[:2] != ours[:2]:
        return Place("size", theirs[:2], ours[:2])
    (a, b), (da, db), (ca, cb) = ([_flat(image[place]) for image in (theirs, ours)] for place in (4, 3, 2))
    count = len(a)
    if count != len(b):
        return Place("shape", count, len(b))
    if set(b) == {-1}:
        # Segments that were not asked for, or nothing in sight: PyBullet leaves what was there.
        a, b = ([-1 if depth > _NOTHING else 0 for depth in depths] for depths in (da, db))
    wrong = [pixel for pixel in range(count) if a[pixel] != b[pixel]]
    if len(wrong) > _SHARE_OF_SEGMENTS * count:
        nearer = sum(db[pixel] < da[pixel] for pixel in wrong)
        (other, own), _ = Counter((a[pixel], b[pixel]) for pixel in wrong).most_common(1)[0]
        return Place("segments", f"{len(wrong)} of {count} differ, {nearer} are nearer: {other}", own)
    same = [pixel for pixel in range(count) if a[pixel] == b[pixel]]
    deep = [pixel for pixel in same if abs(da[pixel] - db[pixel]) > _DEPTH]
    if len(deep) > _SHARE_OF_DEPTHS * count:
        pixel = deep[len(deep) // 2]
        return Place("depth", f"{len(deep)} of {count} differ: {da[pixel]} of {a[pixel]}", db[pixel])
    odd = [pixel for pixel in same if _furthest(_colour(ca, pixel), _colour(cb, pixel)) > _COLOUR]
    if len(odd) > _SHARE_OF_COLOURS * count:
        pixel = odd[len(odd) // 2]
        said = f"{len(odd)} of {count} differ: {_colour(ca, pixel)} of {a[pixel]}"
        return Place("colour", said, _colour(cb, pixel))
    return None


def _colour(values: list[float], pixel: int) -> list[float]:
    return values[4 * pixel : 4 * pixel + 4]


def _flat(value: list[Any]) -> list[float]:
    return [number for part in value for number in (_flat(part) if isinstance(part, list) else [part])]


def _furthest(a: list[float], b: list[float]) -> float:
    return max((abs(x - y) for x, y in zip(a, b, strict=True)), default=0.0)


COMPARED: dict[str, Callable[[Any, Any], Place | None]] = {
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
