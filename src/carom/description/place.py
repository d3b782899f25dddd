"""Links of a world by numbers, for what is seen."""

from __future__ import annotations

from dataclasses import dataclass

WORLD_BODY = -1
"""Number of the body of what is in the world."""


@dataclass(frozen=True, slots=True)
class Place:
    """A link of a world: the number of its body, -1 for the world, and its index, -1 for the base."""

    body: int = WORLD_BODY
    link: int = -1


IN_WORLD = Place()
"""What is in the world, and on no link."""
