"""The rays that a script has cast recently."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.engine.queries.ray_cast import Points, RayTuple

_MAX_RAYS = 5000


class Rays:
    """Puts cast rays among the latest messages while a page shows rays. Safe to use from all threads.

    Attributes:
        wanted: Whether a page shows rays. Otherwise they need not be recorded.
    """

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self.wanted: bool = False
        self._cast: deque[tuple[float, ...]] = deque(maxlen=_MAX_RAYS)

    def tell(self, starts: Points, ends: Points, hits: Sequence[RayTuple]) -> None:
        """Records rays that a script has cast, from starts to ends in the world [m], and their hits."""
        # All at once: pages are shown those of one call together.
        self._cast.extend(
            [
                (*start, *end, *normal, fraction)
                for start, end, (_, _, fraction, _, normal) in zip(starts, ends, hits, strict=True)
            ]
        )

    def show(self) -> None:
        """Puts the rays cast since the last call there; without new rays the old ones stay."""
        if not self._cast:
            return
        rays = [self._cast.popleft() for _ in range(len(self._cast))]
        payload = np.array(rays, dtype="<f4").tobytes()
        self._latest.put("rays", to_page.RAYS(count=len(rays)), payload)
