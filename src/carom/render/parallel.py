"""Running the kernels of one image in parallel threads; kernels release the GIL while they run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from carom.engine.threads import Threads
from carom.native.cpu import core_count

Task = Callable[[], None]

MAX_WORKERS = 8
"""Most threads used: more threads do not speed up images of usual size."""


def worker_count() -> int:
    """Number of threads: one for each CPU core that this process may use, up to `MAX_WORKERS`."""
    return min(core_count(), MAX_WORKERS)


def run_all(tasks: Sequence[Task]) -> None:
    """Run all tasks in parallel, in any order, and return when the last one is done."""
    if len(tasks) <= 1 or worker_count() == 1:
        run_in_turn(tasks)
        return
    # This thread runs tasks, too: it often finishes them before a sleeping thread has woken up.
    work = partial(_work, iter(tasks))
    _threads.run([work] * min(worker_count(), len(tasks)))


def run_in_turn(tasks: Sequence[Task]) -> None:
    """Run all tasks in this thread."""
    for task in tasks:
        task()


def _work(pending: Iterator[Task]) -> None:
    # Taking the next item of a list iterator is an atomic operation.
    for task in pending:
        task()


_threads = Threads(MAX_WORKERS + 1, "carom-render")
