"""Rows of numbers are read all together where they are plain, and mean the same where they are not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pybullet as p
from pybullet._calls.nested import _Reader, nested

PLAIN: dict[str, Any] = {
    "lists": [[1.0, 2, True], [4.0, 5.0, 6.0]],
    "tuples and lists": ([1.0, 2.0], (3.0, 4.0)),
    "rows of different lengths": [[1.0], [2.0, 3.0], []],
    "no rows": [],
}
OTHERS: dict[str, Any] = {
    "words": [["1", "2", "3"]],
    "deeper rows": [[[1.0], [2.0]], [[3.0], [4.0]]],
    "arrays": [np.arange(3.0), [1.0, 2.0, 3.0]],
    "numbers of NumPy": [[np.float32(1.0), 2.0]],
    "numbers beside rows": [1.0, [2.0]],
    "ranges": [range(3), [1, 2, 3]],
}


@pytest.mark.parametrize("values", [*PLAIN.values(), *OTHERS.values()], ids=[*PLAIN, *OTHERS])
def test_items_are_those_read_one_by_one(values: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    together = nested(values, "It failed.", "values")
    monkeypatch.setattr(_Reader, "_rows", lambda *_: None)
    assert repr(together) == repr(nested(values, "It failed.", "values"))


def test_rows_are_copies() -> None:
    rows = [[1.0, 2.0], [3.0, 4.0]]
    read = nested(rows, "It failed.", "values")
    rows[0][0] = 9.0
    assert read == ((1.0, 2.0), (3.0, 4.0))


@pytest.mark.parametrize("most", [6, 7])
def test_all_items_count(most: int) -> None:
    """Rows count as well as what they hold: 2 and 12 are 14."""
    rows = [[0.0] * 6] * 2
    if 2 * most >= 14:
        assert len(nested(rows, "It failed.", "values", most)) == 2
        return
    with pytest.raises(p.error, match=r"It failed\."):
        nested(rows, "It failed.", "values", most)


def test_rows_that_hold_more_than_fits_are_not_copied() -> None:
    with pytest.raises(p.error, match=r"It failed\."):
        nested([[0.0] * 100_000] * 100_000, "It failed.", "values")
