"""What may cause a difference between images: what they show, and how."""

from __future__ import annotations

import re

from tools.differ.assets import SWEPT
from tools.differ.causes.calls import MAKE, Seen, made_for, maker_of
from tools.differ.programs import Call

_NO_LABELS = 4
_SAME_SHADE = 12.0
_NEAR_PLANE_OF_SHADOWS = 0.05
_SHARE_OF_NEARER = 0.9


def shades_along_the_link(seen: Seen) -> bool:
    """Whether a pixel that is lighter or darker shows a body with capsules that MJCF gives by two points."""
    said, ours = seen.difference.place[1:3]
    theirs = [float(part) for part in str(said).split("differ: [")[1].split("]")[0].split(",")]
    changes = [b - a for a, b in zip(theirs, ours, strict=True)]
    if min(changes) < -_SAME_SHADE and max(changes) > _SAME_SHADE:
        return False
    loaded = [body for body in makers_at(seen) if body["f"] == "loadMJCF"]
    return any(body["a"][:1] != [] and body["a"][0] in SWEPT for body in loaded)


def makers_at(seen: Seen) -> list[Call]:
    """The calls that may have made the body at the pixel of an image that differs."""
    if seen.call["k"].get("flags", 0) & _NO_LABELS:
        # Nothing says which body it is.
        return [call for call in seen.before if call["f"].startswith(MAKE)]
    body = maker_of(seen, int(str(seen.difference.place.theirs).rsplit(" of ", 1)[1]))
    return [] if body is None else [body]


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
