"""Heaps as plain data, from which each engine builds its world: nothing of an engine is imported here.

Bodies lie in bins of four walls on a floor, as many in each bin, so that with their number only the number of heaps
grows; or all of them in one bin. Each has a mass of 1 kg.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

TIME_STEP = 1 / 240
FRICTION = 0.25
"""Of each contact."""
RADIUS = 0.05
_WALL = 0.02
"""Half the thickness of walls [m]."""
_PER_BIN = 20
_KINDS = ("box", "sphere", "capsule", "cylinder", "prism", "cuboctahedron")
_SIZES = {
    "box": [0.05, 0.04, 0.03],
    "sphere": [RADIUS],
    "capsule": [0.03, 0.03],
    "cylinder": [0.04, 0.035],
}
"""Half extents; a radius; radii and half lengths of the straight part along z [m]."""


def _prism() -> list[list[float]]:
    turns = [math.pi * corner / 3.0 for corner in range(6)]
    return [[0.045 * math.cos(turn), 0.045 * math.sin(turn), z] for z in (-0.03, 0.03) for turn in turns]


def _cuboctahedron() -> list[list[float]]:
    edge = 0.035
    pairs = [(a, b) for a in (-edge, edge) for b in (-edge, edge)]
    return [[*(pair[:hole]), 0.0, *(pair[hole:])] for hole in range(3) for pair in pairs]


HULLS = {"prism": _prism(), "cuboctahedron": _cuboctahedron()}
"""Corners of the hulls [m]."""


@dataclass(frozen=True)
class Scene:
    """What one engine builds.

    Attributes:
        walls: Centres and half extents of boxes that do not move [m].
        bodies: Kind of shape, size, position [m] and orientation (x, y, z, w) of each body.
        hulls: Corners by kind of shape [m].
    """

    walls: list[tuple[list[float], list[float]]]
    bodies: list[tuple[str, list[float], list[float], list[float]]]
    hulls: dict[str, list[list[float]]]

    def plain(self) -> dict[str, Any]:
        """The scene as JSON has it."""
        return {**asdict(self), "time_step": TIME_STEP, "friction": FRICTION}


def _bins(count: int, per_bin: int, kinds: tuple[str, ...]) -> Scene:
    """So many bodies, in bins of so many; each falls onto those below it from a finger's height."""
    chance = random.Random(1)
    spacing = 2.3 * RADIUS
    across = max(3, round((per_bin / 3.0) ** (1.0 / 2.0))) if per_bin < 100 else 12
    half = across * spacing / 2.0
    bins = math.ceil(count / per_bin)
    high = 1.3 * spacing * math.ceil(per_bin / across**2) / 2.0
    side = math.ceil(math.sqrt(bins))
    pitch = 2.0 * half + 4.0 * _WALL + 0.1
    walls: list[tuple[list[float], list[float]]] = []
    bodies: list[tuple[str, list[float], list[float], list[float]]] = []
    for number in range(bins):
        x, y = pitch * (number % side), pitch * (number // side)
        out, long = half + _WALL, half + 2.0 * _WALL
        walls += [([x + sign * out, y, high], [_WALL, long, high]) for sign in (-1, 1)]
        walls += [([x, y + sign * out, high], [long, _WALL, high]) for sign in (-1, 1)]
        for place in range(min(per_bin, count - number * per_bin)):
            layer, row, column = place // across**2, place // across % across, place % across
            kind = kinds[len(bodies) % len(kinds)]
            position = [
                x + spacing * (column - (across - 1) / 2.0) + chance.uniform(-0.003, 0.003),
                y + spacing * (row - (across - 1) / 2.0) + chance.uniform(-0.003, 0.003),
                spacing * (0.5 + 1.02 * layer),
            ]
            turn = [chance.gauss(0.0, 1.0) for _ in range(4)]
            length = math.sqrt(sum(part * part for part in turn))
            bodies.append((kind, _SIZES.get(kind, []), position, [part / length for part in turn]))
    return Scene(walls, bodies, {kind: HULLS[kind] for kind in kinds if kind in HULLS})


SCENES: dict[str, tuple[str, Callable[[], Scene], int]] = {
    "balls_1000": ("1,000 balls in bins of 20", lambda: _bins(1000, _PER_BIN, ("sphere",)), 240),
    "balls_5000": ("5,000 balls in bins of 20", lambda: _bins(5000, _PER_BIN, ("sphere",)), 160),
    "balls_10000": ("10,000 balls in bins of 20", lambda: _bins(10000, _PER_BIN, ("sphere",)), 160),
    "balls_20000": ("20,000 balls in bins of 20", lambda: _bins(20000, _PER_BIN, ("sphere",)), 160),
    "mixed_1000": ("1,000 mixed bodies in bins of 20", lambda: _bins(1000, _PER_BIN, _KINDS), 240),
    "mixed_10000": ("10,000 mixed bodies in bins of 20", lambda: _bins(10000, _PER_BIN, _KINDS), 160),
    "heap_1000": ("1,000 mixed bodies in one bin", lambda: _bins(1000, 1000, _KINDS), 300),
}
"""Title, scene, and after how many steps most bodies rest."""


def mjcf(scene: dict[str, Any]) -> str:
    """A scene as an MJCF file, for those that read such files."""

    def words(numbers: list[float]) -> str:
        return " ".join(repr(number) for number in numbers)

    friction = f'friction="{scene["friction"]}"'
    corners = {name: [part for corner in hull for part in corner] for name, hull in scene["hulls"].items()}
    meshes = "".join(f'<mesh name="{name}" vertex="{words(hull)}"/>' for name, hull in corners.items())
    rows = [f'<geom type="plane" size="50 50 1" {friction}/>']
    for centre, half in scene["walls"]:
        rows.append(f'<geom type="box" pos="{words(centre)}" size="{words(half)}" {friction}/>')
    for kind, size, position, (x, y, z, w) in scene["bodies"]:
        shape = f'type="mesh" mesh="{kind}"' if kind in corners else f'type="{kind}" size="{words(size)}"'
        rows.append(
            f'<body pos="{words(position)}" quat="{words([w, x, y, z])}"><freejoint/>'
            f'<geom {shape} mass="1" {friction}/></body>'
        )
    option = f'<option timestep="{scene["time_step"]}"/><size memory="4G"/>'
    return f"<mujoco>{option}<asset>{meshes}</asset><worldbody>{''.join(rows)}</worldbody></mujoco>"
