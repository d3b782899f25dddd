"""What all kinds of calls are made with: a program in the making, and random values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Any, TypeVar

from tools.differ.assets import FIXED, PLANAR, PRISMATIC, REVOLUTE, SPHERICAL, Joint
from tools.differ.programs import Call

Value = TypeVar("Value")
Vector = list[float]
Reference = dict[str, int]

VELOCITIES_OF = {REVOLUTE: 1, PRISMATIC: 1, SPHERICAL: 3, PLANAR: 3, FIXED: 0}
"""How many velocities a joint of a type has."""
HALF = math.sqrt(0.5)
MERGE_FIXED = 524288
_BITS = (1, 3, 7, 9, 10, 11, 12, 15, 17, 18, 19, 20, 21)
FLAGS = (16 | 8, 32 | 8, 8192 | 8, 16, *(1 << bit for bit in _BITS))
"""Flags of files and bodies."""


@dataclass(frozen=True)
class Theme:
    """What programs are about.

    Attributes:
        kinds: Kinds of calls, and how often each comes.
        bodies: There are so many at most in the beginning.
        space: Between them [m].
        floor: Whether most have a floor.
        plain: Only boxes and balls, whose contacts PyBullet and Carom compute alike to rounding.
        robots: Only robots.
        scenes: Files of whole scenes.
        apart: Nothing collides.
        rests: Bodies touch a level floor, or are just above it.
    """

    kinds: dict[str, int]
    bodies: int
    space: float
    floor: bool = False
    plain: bool = False
    robots: bool = False
    scenes: bool = False
    apart: bool = False
    rests: bool = False


@dataclass(frozen=True)
class Body:
    """A body of a program: how to refer to it, and its joints."""

    reference: Reference
    joints: Sequence[Joint]
    place: Vector = field(default_factory=lambda: [0.0, 0.0, 0.5])

    @property
    def moving(self) -> list[int]:
        """Its joints that can move."""
        return [number for number, joint in enumerate(self.joints) if VELOCITIES_OF[joint.type]]

    def of_type(self, *types: int) -> list[int]:
        """Its joints of some types."""
        return [number for number, joint in enumerate(self.joints) if joint.type in types]

    @property
    def velocities(self) -> int:
        """How many velocities its joints have."""
        return sum(VELOCITIES_OF[joint.type] for joint in self.joints)


class Maker:
    """A program in the making.

    Args:
        seed: Decides about everything.
        name: Of the theme.
        theme: What it is about.
    """

    def __init__(self, seed: int, name: str, theme: Theme) -> None:
        self.random = Random(f"{name} {seed}")
        self.theme = theme
        self.calls: list[Call] = []
        self.bodies: list[Body] = []
        self.shapes: list[Reference] = []
        self.constraints: list[Reference] = []
        self.states: list[Reference] = []
        self.items: list[Reference] = []
        self.data: list[Reference] = []
        self.textures: list[Reference] = []

    def call(self, function: str, *arguments: Any, **keywords: Any) -> Reference:
        """Add a call; what it returns is how later ones refer to it."""
        number = len(self.calls)
        self.calls.append({"f": function, "a": list(arguments), "k": keywords, "id": number})
        return {"$": number}

    def chance(self, share: float) -> bool:
        """True so often."""
        return self.random.random() < share

    def one(self, values: Sequence[Value]) -> Value:
        """One of some values."""
        return self.random.choice(values)

    def some(self, **keywords: Any) -> dict[str, Any]:
        """Part of some keyword arguments: few, half, or most of them."""
        share = self.one((0.15, 0.4, 0.8))
        return {name: value for name, value in keywords.items() if self.chance(share)}

    def share(self) -> float:
        """A number between 0 and 1."""
        return self.random.random()

    def number(self, low: float, high: float) -> float:
        """A number between two, which is often short."""
        value = self.random.uniform(low, high)
        return round(value, 1) if self.chance(1 / 3) else value

    def positive(self, low: float = 1e-3, high: float = 10.0) -> float:
        """A number of any size between two."""
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def vector(self, size: float = 1.0) -> Vector:
        """A vector whose components are not greater than the size; sometimes along an axis, or 0."""
        if self.chance(0.2):
            return self.one(([0.0, 0.0, size], [size, 0, 0], [0, size, 0], [0.0, 0.0, 0.0], [0, 0, -size]))
        return [self.number(-size, size) for _ in range(3)]

    def axis(self) -> Vector:
        """An axis; sometimes not of length 1."""
        axis: Vector = self.one(([1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1], self.vector()))
        length = math.hypot(*axis)
        if not length:
            return [0.0, 0.0, 1.0]
        return axis if self.chance(0.1) else [component / length for component in axis]

    def any_turn(self) -> Vector:
        """A quaternion of length 1, any as often as any other."""
        turn = [self.random.gauss(0, 1) for _ in range(4)]
        return [component / math.hypot(*turn) for component in turn]

    def turn(self) -> Vector:
        """A quaternion; some are simple, and some rounded, so that their length is not 1."""
        if self.chance(0.3):
            return self.one(([0, 0, 0, 1], [1, 0, 0, 0], [0, 0, HALF, HALF], [HALF, 0, 0, HALF]))
        turn = self.any_turn()
        return [round(component, 2) for component in turn] if self.chance(0.1) else turn

    def body(self) -> Body:
        """One of the bodies."""
        return self.one(self.bodies)

    def link(self, body: Body, *, base: bool = True) -> int:
        """A link of a body, which may be its base; seldom one that is not there."""
        count = len(body.joints)
        if self.chance(0.002):
            return count
        return self.random.randrange(-1 if base else 0, count) if count + base else -1

    def place(self) -> Vector:
        """Where another body may be."""
        space, uniform = self.theme.space, self.random.uniform
        if space >= 5:
            return [len(self.bodies) * space, uniform(-1, 1), uniform(0, 2)]
        return [uniform(-space, space), uniform(-space, space), uniform(0.05, 2 * space + 0.3)]
