"""Shapes that scripts have created for bodies."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from carom.native.change import Change

if TYPE_CHECKING:
    from carom.description import Collision, Robot, Visual

Shape = TypeVar("Shape")


class CollisionShape:
    """A shape made by `createCollisionShape`; scripts keep thousands of them, so it holds little.

    Attributes:
        collisions: What it consists of.
        shown: The visual shapes for links without any; None if they are those of `collisions`.
        used: Whether a body was made of it.
        lasts: Whether it cannot be removed: in PyBullet height fields and triangle meshes of files keep their
            ids.
    """

    __slots__ = ("collisions", "lasts", "shown", "used")

    def __init__(
        self, collisions: tuple[Collision, ...], shown: tuple[Visual, ...] | None = None, lasts: bool = False
    ) -> None:
        self.collisions = collisions
        self.shown = shown
        self.used = False
        self.lasts = lasts

    @property
    def visuals(self) -> tuple[Visual, ...]:
        """The visual shapes for links without any."""
        from carom.description import Visual

        if self.shown is not None:
            return self.shown
        return tuple(Visual(it.geometry, it.frame, stands_in=True) for it in self.collisions)


class ShapeTable(Generic[Shape]):
    """Shapes by id; ids of removed shapes are reused, the last removed first."""

    def __init__(self) -> None:
        self._shapes: dict[int, Shape] = {}
        self._free: list[int] = []

    def add(self, shape: Shape) -> int:
        """Adds a shape and returns its id."""
        number = self._free[-1] if self._free else len(self._shapes)
        change = Change()
        change.put(self._shapes, number, shape)
        change.set(self, "_free", self._free[:-1])
        change.commit()
        return number

    def get(self, number: int) -> Shape | None:
        """The shape of an id, or None."""
        return self._shapes.get(number)

    def remove(self, number: int) -> None:
        """Removes a shape, which must exist."""
        change = Change()
        change.drop(self._shapes, number)
        change.set(self, "_free", [*self._free, number])
        change.commit()


class KeptDescription(NamedTuple):
    """A description with what it was made from.

    Attributes:
        robot: The description.
        collisions: The contents of the collision shapes in it, by number; None for -1.
        visuals: Those of the visual shapes.
    """

    robot: Robot
    collisions: dict[int, Any]
    visuals: dict[int, Any]


class ShapeRegistry:
    """The shapes of one client: collision shapes, and visual shapes, each a tuple of visuals.

    Attributes:
        described: Descriptions of bodies made by `createMultiBody`, by their arguments; see
            `pybullet._loading.kept_descriptions`.
    """

    def __init__(self) -> None:
        self.collisions: ShapeTable[CollisionShape] = ShapeTable()
        self.visuals: ShapeTable[tuple[Visual, ...]] = ShapeTable()
        self.described: OrderedDict[bytes, KeptDescription] = OrderedDict()
