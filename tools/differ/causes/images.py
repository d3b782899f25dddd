"""What may cause a difference between images: what they show, and how."""

from __future__ import annotations

import re

from tools.differ.assets import BALLS, LONG_AND_ROUND
from tools.differ.causes.calls import MAKE, Seen, made_for, maker_of
from tools.differ.programs import Call

# Balls, cylinders and capsules.
_ROUND = frozenset({2, 4, 7})
_LONG_AND_ROUND = frozenset({4, 7})
_NO_LABELS = 4
_SAME_SHADE = 12.0
_NEAR_PLANE_OF_SHADOWS = 0.05
_SHARE_OF_ROUND_EDGES, _SHARE_FROM_CLOSE_BY, _SHARE_OF_NEARER = 0.12, 0.2, 0.9


def rounder(seen: Seen) -> bool:
    """Whether depths of a round body are less than PyBullet's, whose balls are polyhedra inside of ours."""
    said, ours = seen.difference.place[1:3]
    bodies = makers_at(seen)
    bodies += made_for(seen, [part for body in bodies for part in (body["a"], body["k"])])
    if not any(map(_is_round, bodies)):
        return False
    return float(str(said).split("differ: ")[1].split(" of ")[0]) > ours


def stands_out_round(seen: Seen) -> bool:
    """Whether what an image shows elsewhere than PyBullet's is mostly nearer, and some shape is round."""
    if not any(_is_round(call) for call in seen.before):
        return False
    said = re.match(r"(\d+) of (\d+) differ, (\d+) are nearer", str(seen.difference.place.theirs))
    assert said
    wrong, count, nearer = map(int, said.groups())
    # From close by more of an image is an edge; then nothing else may differ.
    from_close_by = nearer == wrong and shows_something_round(seen, seen.difference.place.ours)
    share = _SHARE_FROM_CLOSE_BY if from_close_by else _SHARE_OF_ROUND_EDGES
    return wrong < share * count and nearer > _SHARE_OF_NEARER * wrong


def shows_something_round(seen: Seen, label: int) -> bool:
    """Whether the body with a label in images has round shapes, or may have some."""
    body = maker_of(seen, label)
    return body is not None and any(map(_is_round, [body, *made_for(seen, [body["a"], body["k"]])]))


def shades_as_a_ball(seen: Seen) -> bool:
    """Whether a pixel that is lighter or darker shows a body with cylinders or capsules."""
    said, ours = seen.difference.place[1:3]
    theirs = [float(part) for part in str(said).split("differ: [")[1].split("]")[0].split(",")]
    changes = [b - a for a, b in zip(theirs, ours, strict=True)]
    if min(changes) < -_SAME_SHADE and max(changes) > _SAME_SHADE:
        return False
    return any(shows_something_long_and_round(seen, body) for body in makers_at(seen))


def makers_at(seen: Seen) -> list[Call]:
    """The calls that may have made the body at the pixel of an image that differs."""
    if seen.call["k"].get("flags", 0) & _NO_LABELS:
        # Nothing says which body it is.
        return [call for call in seen.before if call["f"].startswith(MAKE)]
    body = maker_of(seen, int(str(seen.difference.place.theirs).rsplit(" of ", 1)[1]))
    return [] if body is None else [body]


def shows_something_long_and_round(seen: Seen, body: Call) -> bool:
    """Whether the body that a call makes has cylinders or capsules."""
    if body["f"].startswith("load"):
        return body["a"][:1] != [] and body["a"][0] in LONG_AND_ROUND
    return any(map(_is_long_and_round, made_for(seen, [body["a"], body["k"]])))


def draws_given_vertices(seen: Seen) -> bool:
    """Whether an image shows a body that PyBullet's does not: collision shapes made of vertices."""
    said = re.match(r"(\d+) of \d+ differ, (\d+) are nearer", str(seen.difference.place.theirs))
    assert said
    wrong, nearer = map(int, said.groups())
    body = maker_of(seen, seen.difference.place.ours)
    if nearer <= _SHARE_OF_NEARER * wrong or body is None or body["f"] != "createMultiBody":
        return False
    shapes, visuals = (
        [*body["a"][place : place + 1], *body["k"].get(name, ())]
        for place, name in ((1, "linkCollisionShapeIndices"), (2, "linkVisualShapeIndices"))
    )
    bare = [shape for shape, visual in zip(shapes, visuals, strict=False) if visual == -1]
    return any("vertices" in call["k"] for call in made_for(seen, bare))


def _is_long_and_round(call: Call) -> bool:
    kinds = call["k"].get("shapeTypes", call["a"][:1]) if "Shape" in call["f"] else ()
    return not _LONG_AND_ROUND.isdisjoint(kinds)


def _is_round(call: Call) -> bool:
    """Whether a call makes a round shape, or loads a file that shows some."""
    if call["f"] in ("createCollisionShape", "createVisualShape"):
        return call["a"][0] in _ROUND
    if call["f"] in ("createCollisionShapeArray", "createVisualShapeArray"):
        return not _ROUND.isdisjoint(call["k"]["shapeTypes"])
    name = call["a"][0] if call["f"].startswith("load") and call["a"] else None
    return name in BALLS or name in LONG_AND_ROUND


def casts_shadows(seen: Seen) -> bool:
    """Whether an image has shadows that in PyBullet may be everywhere, and PyBullet's pixel is darker."""
    if seen.call["k"].get("shadow") == 0:
        return False
    said, ours = seen.difference.place[1:3]
    theirs = [float(part) for part in str(said).split("differ: [")[1].split("]")[0].split(",")]
    if any(a > b for a, b in zip(theirs, ours, strict=True)):
        return False
    projection = seen.call["a"][3]["whole"]
    made = next(call for call in seen.before if call["id"] == projection)
    near = made["a"][4 if made["f"] == "computeProjectionMatrix" else 2]
    return near == 0.0 or near >= _NEAR_PLANE_OF_SHADOWS
