"""Room for the rows of several worlds, which are relaxed at once."""

from __future__ import annotations

import numpy as np
import pytest

from carom.engine.lane_arrays import NUMBER
from carom.engine.lane_sweeps import _widened
from carom.layouts.programs import LANES


@pytest.mark.parametrize(
    ("field", "rows"), [("row", 10), ("row_share", 10), ("block_response", 5), ("delta_velocity", 5)]
)
def test_rows_that_worlds_may_have_at_other_places_have_room_beside_each_other(field: str, rows: int) -> None:
    lone = np.zeros((1, 5, 3), NUMBER)
    assert _widened(field, lone).array.shape == (rows, 3, LANES)
