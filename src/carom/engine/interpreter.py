"""Performs programs of launches, world after world, without Python in between.

The launches are called by a native function, `carom_perform` in `native/source/perform.cpp`.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from functools import partial
from typing import Protocol

import numpy as np

from carom.engine.lane_work import LaneWork
from carom.engine.program import Program, write_program
from carom.layouts.programs import Program as ProgramRecord
from carom.layouts.programs import Run
from carom.native.library import library

ALL_SUBSTEPS = 2**31 - 1


class Stepper(Protocol):
    """Executes programs.

    Attributes:
        run: Runs the requested steps.
        program: The program loaded last.
        address: Address of the arguments with which `run` calls `carom_perform`; 0 if it does not.
    """

    run: Callable[[], None]
    program: Program
    address: int = 0

    def load(self, program: Program) -> None:
        """Use another program from now on."""
        ...

    def ask(self, **asked: float | None) -> None:
        """Set numbers of `Run` for all later runs."""
        ...


class Interpreter(Stepper):
    """Performs a program on worlds, in one thread.

    Args:
        status: `State.status_entry`.
        worlds: Indices of the worlds; changed in place.
        due: Number of substeps of each step; changed in place.
        counters: `Run.counters`, which all threads share; None for a single thread.
        thread: Which of the threads runs it.

    Attributes:
        lane_work: What steps of several worlds at once need; None if worlds take their steps one at a time.
    """

    def __init__(
        self,
        status: np.ndarray,
        worlds: np.ndarray,
        due: np.ndarray,
        counters: np.ndarray | None,
        thread: int = 0,
    ) -> None:
        self._record = ProgramRecord(status=status.ctypes.data, status_stride=status.strides[0])
        self.program = Program([], [], [], [], [])
        # The memory that a run points to has to be kept alive.
        self._kept = (status, worlds, due, counters)
        self.lane_work: LaneWork | None = None
        self._earlier_in_lanes = 0
        self._asked = Run(
            ctypes.addressof(self._record),
            worlds.ctypes.data,
            due.ctypes.data,
            None if counters is None else counters.ctypes.data,
            None,
            world_count=len(worlds),
            step_count=1,
            chunk=len(worlds),
            thread=thread,
            end_substep=ALL_SUBSTEPS,
        )
        # The arguments are changed in place, so the function itself never changes.
        self.run: Callable[[], None] = partial(library().perform, ctypes.byref(self._asked))
        self.address = ctypes.addressof(self._asked)

    def load(self, program: Program) -> None:  # noqa: D102
        # Launches are updated in place when arrays move, so they usually stay the same.
        if program == self.program:
            return
        write_program(self._record, program)
        self.program = program

    def share(self, shares: Mapping[int, int]) -> None:
        """Let threads perform shares of some launches in all later runs: addresses of `Shares` by place.

        Programs that are loaded later need a call of their own.
        """
        for place in range(sum(map(len, self.program))):
            self._record.launches[place].shares = shares.get(place)

    def move_together(self, work: LaneWork | None) -> None:
        """Take steps of several worlds at once in all later runs, or of one at a time."""
        self._earlier_in_lanes = self.steps_in_lanes
        self.lane_work = work
        self._asked.lanes = None if work is None else ctypes.addressof(work.record)

    @property
    def steps_in_lanes(self) -> int:
        """How many steps of several worlds have begun together so far."""
        return self._earlier_in_lanes + (0 if self.lane_work is None else self.lane_work.steps_begun)

    def ask(self, **asked: float | None) -> None:  # noqa: D102
        for name, value in asked.items():
            setattr(self._asked, name, value)
