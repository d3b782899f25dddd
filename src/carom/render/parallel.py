"""Running the kernels of one image in parallel threads; kernels release the GIL while they run."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import cache
from typing import TYPE_CHECKING

from carom.native.cpu import core_count
from carom.native.uninterrupted import uninterrupted

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor

Task = Callable[[], None]

MAX_WORKERS = 8
"""Most threads used: more threads do not speed up images of usual size."""


def worker_count() -> int:
    """Number of threads: one for each CPU core that this process may use, up to `MAX_WORKERS`."""
    return min(core_count(), MAX_WORKERS)


def run_all(tasks: Sequence[Task]) -> None:
    """Run all tasks in parallel, in any order, and return when the last one is done."""
    if len(tasks) == 1 or worker_count() == 1:
        run_in_turn(tasks)
        return
    pool = _pool()
    # This thread runs tasks, too: it often finishes them before a sleeping thread has woken up.
    pending = iter(tasks)
    # The pool has a lock, which a signal handler that draws, too, would wait for in vain.
    with uninterrupted:
        others = [pool.submit(_work, pending) for _ in range(min(worker_count(), len(tasks)) - 1)]
    _work(pending)
    for other in others:
        other.result()


def run_in_turn(tasks: Sequence[Task]) -> None:
    """Run all tasks in this thread."""
    for task in tasks:
        task()


def _work(pending: object) -> None:
    # Taking the next item of a list iterator is an atomic operation.
    for task in pending:  # type: ignore[attr-defined]
        task()


@cache
def _pool() -> ThreadPoolExecutor:
    # It brings in all of `logging`; a single core does without.
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(MAX_WORKERS, thread_name_prefix="carom-render")


# The threads of a process do not exist in its forked children.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)
