"""Running programs on all worlds or on some, in one thread or in several that share a list of worlds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.engine.interpreter import ALL_SUBSTEPS, Interpreter, Stepper
from carom.engine.lane_work import LaneWork, can_move_together
from carom.engine.parameters import RK4
from carom.engine.program import Plan
from carom.engine.threads import Threads
from carom.engine.workspace import Workspace
from carom.layouts.programs import COUNTER_STRIDE, LANES
from carom.model.builder import WorldArrays

# Chunks of worlds for each thread: enough to balance the load.
_CHUNKS_PER_THREAD = 64


class ProgramRunner:
    """Makes interpreters, one for each thread, and runs their programs.

    Attributes:
        all_worlds: Numbers of all worlds.
        worlds: Those that interpreters run on, first; changed in place.

    Args:
        world_count: Number of worlds.
        threads: Number of threads.
    """

    def __init__(self, world_count: int, threads: int) -> None:
        self.all_worlds: np.ndarray = np.arange(world_count, dtype=np.int32)
        self.worlds: np.ndarray = self.all_worlds.copy()
        self._thread_count = threads
        self._counters = np.zeros((threads, COUNTER_STRIDE), dtype=np.int32) if threads > 1 else None
        self._threads = Threads(threads)

    def interpreters(self, status: np.ndarray, due: np.ndarray) -> list[Stepper]:
        """An interpreter for each thread; the arguments are those of `Interpreter`."""
        threads = self._thread_count
        made: list[Stepper] = [
            Interpreter(status, self.worlds, due, self._counters, thread) for thread in range(threads)
        ]
        if self._counters is not None:
            for interpreter in made:
                interpreter.ask(**_distribution(len(self.all_worlds), threads))
        return made

    def run(self, interpreters: list[Stepper], worlds: np.ndarray | None = None, **scalars: int) -> None:
        """Run programs on some worlds, None for all; then restore the settings of a step of all."""
        if worlds is None and not scalars:
            if self._counters is None:
                interpreters[0].run()
                return
            if len(interpreters) == self._thread_count:
                self._counters[:] = 0
                self._threads.run([interpreter.run for interpreter in interpreters])
                return
        worlds = self.all_worlds if worlds is None else worlds
        count, whole = len(worlds), len(self.all_worlds)
        self.worlds[:count] = worlds
        if self._counters is not None:
            self._counters[:] = 0
            scalars |= _distribution(count, len(interpreters))
        for interpreter in interpreters:
            interpreter.ask(world_count=count, **scalars)
        try:
            self._threads.run([interpreter.run for interpreter in interpreters])
        finally:
            self.worlds[:] = self.all_worlds
            usual = {"step_count": 1, "resumed": 0, "first_substep": 0, "end_substep": ALL_SUBSTEPS}
            if self._counters is not None:
                usual |= _distribution(whole, self._thread_count)
            for interpreter in interpreters:
                interpreter.ask(world_count=whole, **usual)


def _distribution(count: int, threads: int) -> dict[str, int]:
    """What `Run` says of how worlds are distributed among threads."""
    chunk = LANES * max(1, count // (threads * _CHUNKS_PER_THREAD) // LANES)
    return {"chunk": chunk, "threads": threads}


def move_in_lanes(
    steppers: Sequence[Stepper],
    workspaces: Sequence[Workspace],
    arrays: WorldArrays,
    plan: Plan,
    is_usual: bool,
) -> None:
    """Let several worlds move at once, if they can and programs are the usual ones; a stepper is a thread's.

    Where worlds have rows of their own in the workspace, its results are read, which lanes do not leave.
    """
    together = is_usual and plan.coupled and not plan.soft
    together = together and can_move_together(arrays) and plan.integrator != RK4
    together = together and not (plan.late or plan.adhesive)
    for stepper, workspace in zip(steppers, workspaces, strict=False):
        if isinstance(stepper, Interpreter):
            is_able = together and workspace.world_count == 1
            stepper.move_together(LaneWork(arrays, workspace, plan) if is_able else None)
