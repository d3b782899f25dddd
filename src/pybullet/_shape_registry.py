"""Shapes that scripts have created and bodies are made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from carom.description import Collision, Visual

Shape = TypeVar("Shape")


@dataclass(slots=True)
class CollisionShape:
    """What `createCollisionShape` made.

    Attributes:
        collisions: The shapes that touch.
        visuals: The same for the eye, for links that have no visual shape.
        used: A body has been made of it.
    """

    collisions: tuple[Collision, ...]
    visuals: tuple[Visual, ...]
    used: bool = False


class ShapeTable(Generic[Shape]):
    """Shapes by id; ids of removed shapes are given out again, the last one first."""

    def __init__(self) -> None:
        self._shapes: dict[int, Shape] = {}
        self._free: list[int] = []

    def add(self, shape: Shape) -> int:
        """Takes in a shape and returns its id."""
        number = self._free.pop() if self._free else len(self._shapes)
        self._shapes[number] = shape
        return number

    def get(self, number: int) -> Shape | None:
        """The shape of an id, or None."""
        return self._shapes.get(number)

    def remove(self, number: int) -> None:
        """Forgets a shape, which must be there."""
        del self._shapes[number]
        self._free.append(number)


class ShapeRegistry:
    """The shapes of one client.

    Attributes:
        collisions: Those that touch.
        visuals: Those that are seen; each is a list of visuals.
    """

    def __init__(self) -> None:
        self.collisions: ShapeTable[CollisionShape] = ShapeTable()
        self.visuals: ShapeTable[tuple[Visual, ...]] = ShapeTable()
