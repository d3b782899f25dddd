"""Pairs of shapes deeper in each other than their margins, for PyBullet and for Carom.

Their cores, which are the shapes without their margins of 1 mm, overlap then, as they do where something
lands faster than about half a metre per second.
"""

from __future__ import annotations

from math import copysign, hypot, sqrt
from random import Random
from typing import Any

Numbers = list[float]
DEPTHS = (0.0022, 0.0045)
"""Least and greatest depth along the direction that shapes are placed by [m]."""
EACH = 12
CORNERS = [
    [-0.2, -0.24, -0.15],
    [0.0, 0.0, 0.3],
    [0.06, 0.16, -0.28],
    [-0.06, -0.18, -0.28],
    [0.14, 0.3, -0.1],
]
"""Of a hull [m]."""
BOX, CYLINDER, MESH, CAPSULE = 3, 4, 5, 7
KINDS = {"table": BOX, "box": BOX, "cylinder": CYLINDER, "hull": MESH, "capsule": CAPSULE}
ON_TABLES = ("cylinder on table", "hull on table", "capsule on table")
PAIRS = (
    *ON_TABLES,
    "cylinder on box",
    "cylinder on cylinder",
    "cylinder on hull",
    "cylinder on capsule",
    "capsule on box",
    "capsule on hull",
    "hull on box",
    "hull on hull",
)
_SIZES: dict[str, dict[str, Any]] = {
    "table": {"halfExtents": [1.0, 1.0, 0.5]},
    "box": {"halfExtents": [0.15, 0.1, 0.2]},
    "cylinder": {"radius": 0.09, "height": 0.17},
    "hull": {"vertices": CORNERS},
    "capsule": {"radius": 0.05, "height": 0.2},
}


def _turn(random: Random) -> Numbers:
    parts = [random.gauss(0, 1) for _ in range(4)]
    return [part / hypot(*parts) for part in parts]


def _turned(turn: Numbers, vector: Numbers, sign: float = 1.0) -> Numbers:
    """A vector rotated, or rotated back by a sign of -1."""
    x, y, z, w = sign * turn[0], sign * turn[1], sign * turn[2], turn[3]
    a, b, c = vector
    u, v, t = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return [a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u]


def _farthest(name: str, way: Numbers) -> Numbers:
    """The point of a shape farthest in a direction of its own frame."""
    x, y, z = way
    if name == "table":
        return [0.0, 0.0, 0.5]
    if name == "box":
        return [copysign(half, part) for half, part in zip(_SIZES[name]["halfExtents"], way, strict=True)]
    if name == "hull":
        return max(CORNERS, key=lambda corner: sum(a * b for a, b in zip(corner, way, strict=True)))
    radius, half = _SIZES[name]["radius"], 0.5 * _SIZES[name]["height"]
    across = hypot(x, y) if name == "cylinder" else sqrt(x * x + y * y + z * z)
    up = copysign(half, z) + (radius * z / across if name == "capsule" else 0.0)
    return [radius * x / across, radius * y / across, up]


def contacts(p: Any, pair: str) -> list[list[float]]:
    """Points on both, normals and distances of the contacts of pairs of shapes: the deepest of each."""
    random = Random(pair)
    above, below = pair.split(" on ")
    rows: list[list[float]] = []
    for _ in range(EACH):
        p.resetSimulation()
        turns = [_turn(random), _turn(random)]
        way = [random.gauss(0, 1) for _ in range(3)]
        way = [part / hypot(*way) for part in way]
        if below == "table":
            turns[1], way = [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0]
        depth = random.uniform(*DEPTHS)
        upper, lower = (
            _turned(turn, _farthest(name, _turned(turn, [sign * part for part in way], -1.0)))
            for name, turn, sign in zip((above, below), turns, (-1.0, 1.0), strict=True)
        )
        place = [a - b - depth * along for a, b, along in zip(lower, upper, way, strict=True)]
        for name, mass, position, turn in (
            (below, 0, [0.0] * 3, turns[1]),
            (above, 1, place, turns[0]),
        ):
            p.createMultiBody(mass, p.createCollisionShape(KINDS[name], **_SIZES[name]), -1, position, turn)
        p.performCollisionDetection()
        for point in p.getContactPoints():
            rows.append([*point[5], *point[6], *point[7], point[8]])
    return rows
