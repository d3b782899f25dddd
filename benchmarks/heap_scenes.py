"""Heaps as plain data, from which each engine builds its world: nothing of an engine is imported here.

Bodies of 1 kg lie in bins of four walls on a floor, as many in each bin, so that with their number only the
number of heaps grows.
"""

from __future__ import annotations

import math
import random
from dataclasses import asdict, dataclass
from typing import Any

TIME_STEP = 1 / 240
FRICTION = 0.25
"""Of each contact."""
RADIUS = 0.05
_WALL = 0.02
"""Half the thickness of walls [m]."""
_PER_BIN, _ACROSS = 20, 3
"""Bodies of a bin, and how many stand side by side."""
_SPACING = 2.3 * RADIUS
_BALLS = ("sphere",)
_MIXED = ("box", "sphere", "capsule", "cylinder")
_SIZES = {
    "box": [0.05, 0.04, 0.03],
    "sphere": [RADIUS],
    "capsule": [0.03, 0.03],
    "cylinder": [0.04, 0.035],
}
"""Half extents; a radius; radii and half lengths of the straight part along z [m]."""


@dataclass(frozen=True)
class Scene:
    """What one engine builds.

    Attributes:
        walls: Centres and half extents of boxes that do not move [m].
        bodies: Kind of shape, size, position [m] and orientation (x, y, z, w) of each body.
    """

    walls: list[tuple[list[float], list[float]]]
    bodies: list[tuple[str, list[float], list[float], list[float]]]

    def plain(self) -> dict[str, Any]:
        """The scene as JSON has it."""
        return {**asdict(self), "time_step": TIME_STEP, "friction": FRICTION}


def bins(count: int, kinds: tuple[str, ...]) -> Scene:
    """So many bodies, 20 in each bin; each falls onto those below it from a finger's height."""
    chance = random.Random(1)
    half = _ACROSS * _SPACING / 2.0
    high = 1.3 * _SPACING * math.ceil(_PER_BIN / _ACROSS**2) / 2.0
    number_of_bins = math.ceil(count / _PER_BIN)
    side = math.ceil(math.sqrt(number_of_bins))
    pitch = 2.0 * half + 4.0 * _WALL + 0.1
    walls: list[tuple[list[float], list[float]]] = []
    bodies: list[tuple[str, list[float], list[float], list[float]]] = []
    for number in range(number_of_bins):
        x, y = pitch * (number % side), pitch * (number // side)
        out, long = half + _WALL, half + 2.0 * _WALL
        walls += [([x + sign * out, y, high], [_WALL, long, high]) for sign in (-1, 1)]
        walls += [([x, y + sign * out, high], [long, _WALL, high]) for sign in (-1, 1)]
        for place in range(min(_PER_BIN, count - number * _PER_BIN)):
            layer, row, column = place // _ACROSS**2, place // _ACROSS % _ACROSS, place % _ACROSS
            kind = kinds[len(bodies) % len(kinds)]
            position = [
                x + _SPACING * (column - (_ACROSS - 1) / 2.0) + chance.uniform(-0.003, 0.003),
                y + _SPACING * (row - (_ACROSS - 1) / 2.0) + chance.uniform(-0.003, 0.003),
                _SPACING * (0.5 + 1.02 * layer),
            ]
            turn = [chance.gauss(0.0, 1.0) for _ in range(4)]
            length = math.sqrt(sum(part * part for part in turn))
            bodies.append((kind, _SIZES[kind], position, [part / length for part in turn]))
    return Scene(walls, bodies)


SCENES: dict[str, tuple[str, int, tuple[str, ...], int]] = {
    "balls_1000": ("1,000 balls", 1000, _BALLS, 240),
    "balls_5000": ("5,000 balls", 5000, _BALLS, 160),
    "balls_10000": ("10,000 balls", 10000, _BALLS, 160),
    "balls_20000": ("20,000 balls", 20000, _BALLS, 160),
    "mixed_1000": ("1,000 mixed bodies", 1000, _MIXED, 240),
    "mixed_10000": ("10,000 mixed bodies", 10000, _MIXED, 160),
}
"""Title, number and kinds of bodies, and after how many steps most of them rest."""


def mjcf(scene: dict[str, Any]) -> str:
    """A scene as an MJCF file, for those that read such files."""

    def words(numbers: list[float]) -> str:
        return " ".join(repr(number) for number in numbers)

    friction = f'friction="{scene["friction"]}"'
    rows = [f'<geom type="plane" size="50 50 1" {friction}/>']
    for centre, half in scene["walls"]:
        rows.append(f'<geom type="box" pos="{words(centre)}" size="{words(half)}" {friction}/>')
    for kind, size, position, (x, y, z, w) in scene["bodies"]:
        rows.append(
            f'<body pos="{words(position)}" quat="{words([w, x, y, z])}"><freejoint/>'
            f'<geom type="{kind}" size="{words(size)}" mass="1" {friction}/></body>'
        )
    option = f'<option timestep="{scene["time_step"]}"/><size memory="4G"/>'
    return f"<mujoco>{option}<worldbody>{''.join(rows)}</worldbody></mujoco>"
