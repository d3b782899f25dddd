"""From rows of the world's arrays to bodies and links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.world.world import World

Place = tuple[int, int]


def places(world: World, rows: np.ndarray | Sequence[int]) -> list[Place | None]:
    """Body and link, -1 for the base, that each row of link arrays stands for; None for negative rows."""
    table = world.link_places
    numbers = rows if isinstance(rows, list) else np.asarray(rows).tolist()
    return [table[row] if row >= 0 else None for row in numbers]
