"""What may cause a difference between nearest points: which shapes were asked for."""

from __future__ import annotations

import math

from tools.differ.assets import FINE, SWEPT, THIN
from tools.differ.causes.calls import Seen, made_for
from tools.differ.compare import DEEP
from tools.differ.programs import Call, all_references, references

_EXCHANGED, _AS_NEAR = 1e-4, 1e-4
_TOO_FAR, ROUNDED = 2e-4, 1e-9
# Sizes of files pass through single precision.
_AS_IN_FILES = 1e-8
_OF_SIMPLIFIED_HULLS = 4e-3
MARGIN, _MARGIN_OF_SWEPT = 1e-3, 0.04
_SEARCHED_DEPTH = 0.02


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


def has_the_margin_of_a_body(seen: Seen) -> bool:
    """Whether a shape that is asked about made a body whose margin was changed, and how far explains it."""
    theirs, ours = seen.difference.place[1:3]
    most = 0.0
    for name in ("collisionShapeA", "collisionShapeB"):
        shapes = references(seen.call["k"].get(name))
        bodies = {
            call["id"]
            for call in seen.before
            if call["f"] == "createMultiBody" and shapes & all_references(call)
        }
        changes = [
            abs(call["k"]["collisionMargin"] - MARGIN)
            for call in seen.before
            if call["f"] == "changeDynamics"
            and "collisionMargin" in call["k"]
            and references(call["a"][0]) & bodies
        ]
        most += max(changes, default=0.0)
    return 0.0 < abs(theirs[8] - ours[8]) < most + ROUNDED
