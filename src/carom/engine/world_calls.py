"""Kernels that each thread runs for one world after the other with a workspace of its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.engine.interpreter import Interpreter
from carom.engine.program import Program
from carom.engine.threads import Threads
from carom.layouts.programs import COUNTER_STRIDE
from carom.layouts.status import STEPS_DONE
from carom.native.launch import Launch

# Chunks of worlds for each thread: enough to balance the load.
_CHUNKS_PER_THREAD = 16


class WorldCalls:
    """Runs launches for many worlds: one native call on each thread.

    Args:
        threads: Number of threads.
    """

    def __init__(self, threads: int) -> None:
        self._threads = Threads(threads)
        self._counters = np.zeros((threads, COUNTER_STRIDE), dtype=np.int32)
        self._nothing_due = np.zeros(1, dtype=np.int32)
        self._count = -1
        self._interpreters: list[Interpreter] = []

    def run(self, count: int, launches: Sequence[Sequence[Launch]], chunk: int | None = None) -> None:
        """Run launches for each of `count` worlds.

        Args:
            count: Number of worlds.
            launches: The launches of each thread, at most as many as there are threads; their argument
                `first_world` is the number of the world.
            chunk: Number of worlds that a thread takes at a time; None for a number that suits short kernels.
        """
        launches = launches[:count]
        if not launches:
            return
        if (count, len(launches)) != (self._count, len(self._interpreters)):
            status = np.zeros((count, STEPS_DONE + 1), dtype=np.int32)
            worlds = np.arange(count, dtype=np.int32)
            self._interpreters = [
                Interpreter(status, worlds, self._nothing_due, self._counters, thread)
                for thread in range(len(launches))
            ]
            self._count = count
        self._counters[:] = 0
        share = chunk or max(1, count // (len(launches) * _CHUNKS_PER_THREAD))
        for interpreter, own in zip(self._interpreters, launches, strict=True):
            interpreter.load(Program([], list(own), [], [], []))
            interpreter.ask(chunk=share, threads=len(launches))
        self._threads.run([interpreter.run for interpreter in self._interpreters])
