"""What is the same for all bodies with one specification: made when a specification is used again."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from carom.description.pose import IDENTITY
from carom.model.body_rows import BodyRows
from carom.model.body_spec import BodySpec
from carom.model.builder import WorldArrays
from carom.model.link_dynamics import LinkDynamics
from carom.model.shape_arrays import ShapeArrays
from carom.native.change import Change
from carom.scene.core.body_core import Outline

MAX_BYTES = 1 << 20
"""Bodies with larger rows, those of large triangle meshes, are written anew each time [bytes]."""

MAX_ROWS = 4096
"""Longer tables are not kept to write the next body to."""

_spare: list[tuple[WorldArrays, ShapeArrays]] = []
"""Empty tables, or none while a thread writes to them."""


class Pattern(NamedTuple):
    """What is the same for all bodies with one specification.

    Attributes:
        rows: Their rows in all arrays; None if those are too large to keep.
        outline: What the bodies themselves contain.
    """

    rows: BodyRows | None
    outline: Outline


def pattern_of(spec: BodySpec) -> Pattern | None:
    """The pattern of a specification that was used before; None if there is none."""
    if spec.pattern is None and spec.is_reused and spec.soft is None:
        outline = Outline(spec)
        spec.pattern = Pattern(_body_rows(spec, outline.dynamics), outline)
    return spec.pattern


def _body_rows(spec: BodySpec, surfaces: Sequence[LinkDynamics]) -> BodyRows | None:
    """The rows of a body, made by writing it to empty arrays; None if they are larger than `MAX_BYTES`.

    The body is not soft; `surfaces` are the contact parameters of its links, the base first.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    # Tables are kept for the next body; those of a body that could not be written are not.
    arrays, shapes = _spare.pop() if _spare else (WorldArrays(), ShapeArrays())
    change = Change()
    rows = arrays.append(change, spec, IDENTITY)
    # The change is not made: the tables stay empty, and the rows are written.
    body = shapes.append(change, spec, rows, surfaces)
    used: dict[str, int] = change.get(shapes, "used")
    # A longer table would hold its memory for ever.
    is_small = max(*shapes.capacity.values(), *arrays.model.capacity.values()) <= MAX_ROWS
    written = BodyRows(
        rows.count,
        dict(used),
        arrays.row_changes.packed(rows.count),
        shapes.table.row_changes.packed(used),
        arrays.row_changes.first_rows(rows.count),
        shapes.table.row_changes.first_rows(used),
        tuple(body.bounds),
        tuple(body.margins),
        tuple(body.widening),
        body.collisions,
        shapes.breaking_fraction,
    )
    if is_small and not _spare:
        arrays.clear_unused()
        shapes.clear_unused()
        _spare.append((arrays, shapes))
    return written if len(written.rows) + len(written.shape_rows) <= MAX_BYTES else None
