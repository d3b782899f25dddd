"""The memory of sensors in the flat arrays: making room for one more sensor of a body."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.model.body_rows import TreeRows
    from carom.model.builder import WorldArrays

_AXIS = "sensor"


def insert_memory(arrays: WorldArrays, rows: TreeRows, others: Sequence[TreeRows], count: int) -> None:
    """Make room for `count` numbers of a body, after those it has; those of other bodies move down."""
    used, row = arrays.used[_AXIS], rows.first[_AXIS] + rows.count[_AXIS]
    arrays.reserve(sensor=count)
    memory = arrays.state.numpy["sensor_memory"]
    memory[:, row + count : used + count] = memory[:, row:used].copy()
    memory[:, row : row + count] = 0.0
    rows.count = {**rows.count, _AXIS: rows.count[_AXIS] + count}
    for other in others:
        if other is not rows and other.tree > rows.tree:
            other.first = {**other.first, _AXIS: other.first[_AXIS] + count}
    arrays.used[_AXIS] = used + count
