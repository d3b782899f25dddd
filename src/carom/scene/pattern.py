"""What is the same for all bodies with one specification: made when a specification is used again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from carom.model.body_rows import BodyRows, body_rows
from carom.scene.body import Outline

if TYPE_CHECKING:
    from carom.model.body_spec import BodySpec


@dataclass(frozen=True, eq=False, slots=True)
class Pattern:
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
        spec.pattern = Pattern(body_rows(spec, outline.dynamics), outline)
    return spec.pattern
