"""The verdict of the loops, and how much memory shapes take that scripts keep."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable, Sequence

import pytest
from tests.memory.loops import growth

import pybullet as p

CYCLES = 200
KEPT = 500
MOST = 550
"""Bytes of a kept shape and its place in the table."""


def _readings(of_cycles: Callable[[int], float]) -> tuple[Callable[[], object], Callable[[], int]]:
    """A cycle that does nothing but count, and memory [KB] as a function of the cycles so far."""
    done: list[None] = []
    return lambda: done.append(None), lambda: int(1024 * of_cycles(len(done)))


@pytest.mark.parametrize(
    ("memory", "rate", "holds"),
    [
        pytest.param(lambda cycles: 5000.0, 0.0, True, id="steady"),
        pytest.param(lambda cycles: min(cycles, 90) * 50.0, 0.0, True, id="caches that fill at first"),
        pytest.param(lambda cycles: 500.0 * (cycles > 150), 0.0, True, id="one chunk"),
        pytest.param(lambda cycles: 0.5 * cycles, 0.5, True, id="half a kilobyte"),
        pytest.param(lambda cycles: 1.5 * cycles, 1.5, False, id="a small leak"),
        pytest.param(lambda cycles: 16.0 * (1.5 * cycles // 16), 1.6, False, id="a small leak, in pools"),
        pytest.param(lambda cycles: 800.0 * (cycles > 150), 0.0, False, id="one large chunk"),
    ],
)
def test_the_verdict_is_a_rate(memory: Callable[[int], float], rate: float, holds: bool) -> None:
    cycle, measured = _readings(memory)
    grown = growth(cycle, CYCLES, measured)
    assert grown.rate == pytest.approx(rate)
    assert grown.holds == holds


def _bytes_of_each(make: Callable[[], int]) -> float:
    for _ in range(KEPT):
        make()
    gc.collect()
    tracemalloc.start()
    try:
        for _ in range(KEPT):
            make()
        gc.collect()
        return tracemalloc.get_traced_memory()[0] / KEPT
    finally:
        tracemalloc.stop()


def _box(sizes: Sequence[float] = (0.1, 0.2, 0.3)) -> int:
    return p.createCollisionShape(p.GEOM_BOX, halfExtents=sizes)


def _ball() -> int:
    return p.createVisualShape(p.GEOM_SPHERE, radius=0.1)


def test_shapes_that_are_kept_take_little() -> None:
    p.connect(p.DIRECT)
    try:
        taken = {make.__name__: _bytes_of_each(make) for make in (_box, _ball)}
    finally:
        p.disconnect()
    assert {name: size for name, size in taken.items() if size > MOST} == {}
