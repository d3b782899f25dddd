"""Memory does not grow with steps or with loading and removing (`soak` does the same for longer)."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from .memory import growth_of, loading, stepping


@pytest.fixture
def p() -> Iterator[Any]:
    pybullet = importlib.import_module("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    yield pybullet
    pybullet.disconnect(client)


@pytest.mark.long
@pytest.mark.parametrize(
    ("prepare", "count", "bytes_each"),
    [(stepping, 50_000, 4), (loading, 200, 2_000)],
)
def test_long_work_leaves_no_memory_behind(
    p: Any, prepare: Callable[[Any], Callable[[int], None]], count: int, bytes_each: int
) -> None:
    work = prepare(p)
    growth = growth_of(work, count)
    assert growth.python < bytes_each * count
    if growth.resident is not None:
        assert growth.resident < 4_000_000


def test_growth_is_seen() -> None:
    kept = []
    growth = growth_of(lambda count: kept.extend(bytearray(100_000) for _ in range(count)), 80)
    assert growth.python > 3_000_000
