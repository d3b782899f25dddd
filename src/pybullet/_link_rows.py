"""From rows of the world's arrays to bodies and links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.world import World

Place = tuple[int, int]


def places(world: World, rows: np.ndarray | Sequence[int]) -> list[Place | None]:
    """Body and link, -1 for the base, that each row of link arrays stands for; None for negative rows."""
    if not world.bodies:
        return [None] * len(rows)
    bodies = sorted(world.bodies.values(), key=lambda body: body.first_link)
    first = np.array([body.first_link for body in bodies])
    rows = np.asarray(rows, dtype=int)
    owner = np.searchsorted(first, rows, side="right") - 1
    return [
        (bodies[n].id, link) if row >= 0 else None
        for row, n, link in zip(
            rows.tolist(), owner.tolist(), (rows - first[owner] - 1).tolist(), strict=True
        )
    ]
