"""Which rows of the flat arrays a body has, and what is kept of them for the next body that is equal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from carom.description.shapes.bounds import Bounds


@dataclass(slots=True)
class TreeRows:
    """The rows of a body in the flat arrays."""

    tree: int
    first: dict[str, int] = field(default_factory=dict)
    count: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True, eq=False, slots=True)
class BodyRows:
    """The rows of a body, with row numbers as if it were alone; its base is at the origin.

    Attributes:
        count: Rows on each axis of model and state; `packed_count` is the same for `RowChanges.put`.
        shape_count: Rows on each axis of shapes, that of links included; `packed_shape_count` likewise.
        rows: Its rows in all arrays of model and state, as `RowChanges.first_rows` returns them.
        shape_rows: Its rows in all arrays of shapes.
        bounds: Bounds of each link; see `BodyShapeRows`.
        margins: See `BodyShapeRows`.
        widening: See `BodyShapeRows`.
        collisions: See `BodyShapeRows`.
        breaking_fraction: See `ShapeArrays`; breaking distances are for this one.
    """

    count: dict[str, int]
    shape_count: dict[str, int]
    packed_count: bytes
    packed_shape_count: bytes
    rows: bytes
    shape_rows: bytes
    bounds: tuple[Bounds, ...]
    margins: tuple[float, ...]
    widening: tuple[bool, ...]
    collisions: tuple[int, ...]
    breaking_fraction: float


class BodyShapeRows:
    """The rows of a body's shapes.

    Attributes:
        rows: Rows of its tree, which are updated elsewhere.
        first: First row on each axis of shapes.
        count: Rows on each axis of shapes.
        bounds: Bounds of each link, the base first, along the axes of its inertial frame.
        margins: The margin of each link [m].
        widening: For each link, whether its margin widens its bounds.
        collisions: For each row of a shape, which collision shape of its link it is, or is a part of.
        resizes: How often the sizes of its shapes have been set.
    """

    __slots__ = ("bounds", "collisions", "count", "first", "margins", "resizes", "rows", "widening")

    def __init__(
        self,
        rows: TreeRows,
        first: dict[str, int],
        count: dict[str, int],
        bounds: Sequence[Bounds] = (),
        margins: Sequence[float] = (),
        widening: Sequence[bool] = (),
        collisions: Sequence[int] = (),
    ) -> None:
        self.rows = rows
        self.first = first
        self.count = count
        self.bounds = list(bounds)
        self.margins = list(margins)
        self.widening = list(widening)
        self.collisions = tuple(collisions)
        self.resizes = 0
