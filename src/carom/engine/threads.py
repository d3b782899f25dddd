"""Threads that run native functions in parallel.

`concurrent.futures` would do the same, but forks wait for a lock of its own first, and then for those of
worlds; a call has that of a world while it waits for the threads. So they are threads of ours, and forks need
no lock of theirs.
"""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Sequence
from threading import Thread

from carom.native.uninterrupted import uninterrupted

try:
    # `queue` imports much that is not needed here.
    from _queue import SimpleQueue
except ImportError:
    from queue import SimpleQueue

# To wake up another thread takes about as long as the kinematics of so many worlds.
WORLDS_PER_THREAD = 64

Function = Callable[[], object]


class Threads:
    """Runs functions that release the GIL, each in a thread of its own.

    The threads begin when they are first needed, in each process, and end with this object, or the process.

    Args:
        count: Number of functions.
        name: What the names of the threads begin with.
    """

    def __init__(self, count: int, name: str = "carom-worlds") -> None:
        self._count = count
        self._name = name
        self._process = -1
        self._tasks: SimpleQueue[_Task | None] = SimpleQueue()

    def run(self, functions: Sequence[Function]) -> None:
        """Run all functions, one of them in this thread, and return when all have ended.

        Raises:
            BaseException: What one of the functions has raised.
        """
        first, *others = functions
        if not others:
            first()
            return
        started = [_Task(function) for function in others]
        # A handler of a signal that runs functions, too, must not begin the threads a second time.
        with uninterrupted:
            # A forked process does not have the threads of its parent.
            if self._process != os.getpid():
                self._begin()
            for task in started:
                self._tasks.put(task)
        try:
            first()
        finally:
            for task in started:
                task.wait()

    def _begin(self) -> None:
        self._tasks = tasks = SimpleQueue()
        threads = self._count - 1
        for place in range(threads):
            # They do not know this object, so that it can go.
            Thread(target=_work, args=(tasks,), name=f"{self._name}_{place}", daemon=True).start()
        weakref.finalize(self, _end, tasks, threads).atexit = False
        self._process = os.getpid()


class _Task:
    """A function that a thread runs, and what it has raised."""

    def __init__(self, function: Function) -> None:
        self._function = function
        self._ended: SimpleQueue[BaseException | None] = SimpleQueue()

    def run(self) -> None:
        """Run it."""
        error: BaseException | None = None
        try:
            self._function()
        except BaseException as problem:
            error = problem
        self._ended.put(error)

    def wait(self) -> None:
        """Wait for its end; raises what it has raised."""
        error = self._ended.get()
        if error is not None:
            raise error


def _work(tasks: SimpleQueue[_Task | None]) -> None:
    while (task := tasks.get()) is not None:
        task.run()
        # It may be the last to know a world.
        del task


def _end(tasks: SimpleQueue[_Task | None], threads: int) -> None:
    for _ in range(threads):
        tasks.put(None)
