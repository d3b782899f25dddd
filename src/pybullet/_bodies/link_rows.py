"""From rows of the world's arrays to bodies and links."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.world.world import World

Place = tuple[int, int]


def places(world: World, rows: list[int]) -> list[Place | None]:
    """Body and link, -1 for the base, of rows of link arrays; None for negative rows."""
    table = world.link_places
    return [table[row] if row >= 0 else None for row in rows]
