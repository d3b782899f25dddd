"""What the numbered parts of a body in many worlds have in common."""

from __future__ import annotations

from typing import Any, TypeVar

from carom.scene.named import HasName, Named
from carom.scene.sensors.source import Source
from carom.worlds.batch import Batch

Item = TypeVar("Item", bound=HasName)


class Part:
    """One part of a body in all worlds, by its number.

    Attributes:
        index: Its number among the parts of its kind.
        name: Its name in the file.
    """

    __slots__ = ("_batch", "index", "name")

    def __init__(self, batch: Batch, index: int) -> None:
        self._batch = batch
        self.index: int = index
        self.name: str = self.spec.name

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.index} {self.name!r} in {self._batch._count} worlds>"

    @property
    def spec(self) -> Any:
        """What it was made from."""
        raise AssertionError("each kind of part has its own")


class SensedPart(Part):
    """A part that is measured as sensors measure, through a source of what they show."""

    __slots__ = ("_source",)

    def __init__(self, batch: Batch, source: Source, index: int) -> None:
        super().__init__(batch, index)
        self._source = source


class Parts(Named[Item]):
    """All parts of a kind of a body in all worlds, by index or name."""

    _batch: Batch

    def __repr__(self) -> str:
        names = ", ".join(map(repr, self.names)) or "none"
        return f"<{type(self).__name__} of {self._batch.name!r} in {self._batch._count} worlds: {names}>"
