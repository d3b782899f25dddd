"""What is closed is freed at once, without a garbage collection."""

from __future__ import annotations

import gc
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from weakref import ref

import pytest
from tests.conformance.memory import resident_bytes
from tests.memory.kinds import KINDS

ROUNDS = 2
MANY = 1000
# The allocators take memory in chunks; a kilobyte that stays of each thing exceeds this.
ALLOWED = MANY << 10


@contextmanager
def _uncollected() -> Iterator[None]:
    gc.collect()
    gc.disable()
    # Of what is logged pytest keeps the text until a test ends.
    logging.disable()
    try:
        yield
    finally:
        logging.disable(logging.NOTSET)
        gc.enable()


def fill_free_lists() -> None:
    """Let Python keep as many freed tuples as it ever does, which collections would let go of.

    It fills them slowly otherwise: tuples that are made of iterators begin larger than they are freed.
    """
    for size in range(1, 21):
        kept = [tuple([None] * size) for _ in range(2000)]
        del kept


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_closed_is_gone(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    make = KINDS[kind]
    make()
    with _uncollected():
        made = [(type(it).__name__, ref(it)) for _ in range(ROUNDS) for it in make()]
        assert [name for name, it in made if it() is not None] == []


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_left_to_collect(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    make = KINDS[kind]
    for _ in range(2):
        make()
    with _uncollected():
        for _ in range(ROUNDS):
            make()
        gc.set_debug(gc.DEBUG_SAVEALL)
        try:
            gc.collect()
        finally:
            gc.set_debug(0)
        left = [type(it).__name__ for it in gc.garbage]
        gc.garbage.clear()
    assert len(left) < ROUNDS, left[:20]


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_a_thousand_take_no_memory(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    make = KINDS[kind]
    with _uncollected():
        fill_free_lists()
        for _ in range(MANY // 4):
            make()
        before = resident_bytes()
        if before is None:
            pytest.skip("this system does not tell how much memory a process holds")
        for _ in range(MANY):
            make()
        assert (resident_bytes() or 0) - before < ALLOWED
