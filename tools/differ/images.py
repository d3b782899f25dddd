"""How images are compared: segments, then depths and colours of each body."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from tools.differ.values import Place

_SHARE_OF_SEGMENTS, _SHARE_OF_DEPTHS, _SHARE_OF_COLOURS = 0.06, 0.04, 0.02
_DEPTH, _SAME_COLOUR, _NEAR_COLOUR = 1e-5, 1, 12
_NOTHING = 1 - 1e-6
_LABELS_OF_A_LINK = 1 << 24


def of_images(theirs: Any, ours: Any) -> list[Place]:
    """Colours, depths and segments: some pixels may differ, at edges.

    Where depths are the same, so are colours. Depths and colours have a place for each body with more than
    a few pixels that differ: what makes one body look otherwise says nothing about the others.
    """
    if theirs[:2] != ours[:2]:
        return [Place("size", theirs[:2], ours[:2])]
    (a, b), (da, db), (ca, cb) = ([flat(image[place]) for image in (theirs, ours)] for place in (4, 3, 2))
    count = len(a)
    if count != len(b):
        return [Place("shape", count, len(b))]
    if set(b) == {-1}:
        # Segments that were not asked for, or nothing in sight: PyBullet leaves what was there.
        a, b = ([-1 if depth > _NOTHING else 0 for depth in depths] for depths in (da, db))
    wrong = [pixel for pixel in range(count) if a[pixel] != b[pixel]]
    if len(wrong) > _SHARE_OF_SEGMENTS * count:
        nearer = sum(db[pixel] < da[pixel] for pixel in wrong)
        (other, own), _ = Counter((a[pixel], b[pixel]) for pixel in wrong).most_common(1)[0]
        return [Place("segments", f"{len(wrong)} of {count} differ, {nearer} are nearer: {other}", own)]
    same = [pixel for pixel in range(count) if a[pixel] == b[pixel]]
    found: list[Place] = []
    deep = [pixel for pixel in same if not is_as_deep(da[pixel] - db[pixel])]
    for pixel, differ in _of_bodies(a, deep, _SHARE_OF_DEPTHS * count):
        said = f"{differ} of {count} differ: {da[pixel]} of {a[pixel]}"
        found.append(Place("depth", said, db[pixel], abs(da[pixel] - db[pixel])))
    elsewhere = set(deep)
    odd = [
        pixel
        for pixel in same
        if _apart(ca, cb, pixel) > (_NEAR_COLOUR if pixel in elsewhere else _SAME_COLOUR)
    ]
    for pixel, differ in _of_bodies(a, odd, _SHARE_OF_COLOURS * count):
        said = f"{differ} of {count} differ: {_colour(ca, pixel)} of {a[pixel]}"
        found.append(Place("colour", said, _colour(cb, pixel), _apart(ca, cb, pixel)))
    return found


def is_as_deep(difference: float) -> bool:
    """Whether depths that differ so much count as the same."""
    return abs(difference) <= _DEPTH


def _of_bodies(labels: Sequence[float], pixels: list[int], most: float) -> list[tuple[int, int]]:
    """Of each body with more pixels than that, the one in the middle of them, and how many they are."""
    several: dict[int, list[int]] = {}
    for pixel in pixels:
        label = int(labels[pixel])
        several.setdefault(label % _LABELS_OF_A_LINK if label >= 0 else -1, []).append(pixel)
    return [(some[len(some) // 2], len(some)) for some in several.values() if len(some) > most]


def _apart(theirs: list[float], ours: list[float], pixel: int) -> float:
    return max(abs(x - y) for x, y in zip(_colour(theirs, pixel), _colour(ours, pixel), strict=True))


def _colour(values: list[float], pixel: int) -> list[float]:
    return values[4 * pixel : 4 * pixel + 4]


def flat(value: list[Any]) -> list[float]:
    """The numbers of nested lists."""
    return [number for part in value for number in (flat(part) if isinstance(part, list) else [part])]
