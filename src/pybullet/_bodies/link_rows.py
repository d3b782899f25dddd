"""The body and the link of a row of the world's link arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.world.world import World

Place = tuple[int, int]


def places(world: World, rows: list[int]) -> list[Place | None]:
    """Body id and link index (-1 for the base) of each row of the link arrays; None for a negative row."""
    table = world.link_places
    return [table[row] if row >= 0 else None for row in rows]
