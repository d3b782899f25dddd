"""Performs programs of launches, world after world, without Python in between.

The launches are called by a native function, `carom_perform` in `native/source/perform.cpp`.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar, Protocol

import numpy as np

from carom.engine.program import Program
from carom.native.library import library

# Count of numbers before the launches of a program: address of the first world's status, bytes from one
# status to the next, and the ends of the five parts.
_HEADER = 7
# Count of numbers of a launch: addresses of the function, of the bounds, of the arguments, and of two of
# these arguments: the world and the number of substeps, 0 if it has none.
_PER_LAUNCH = 5
# More launches than in any program.
_MOST_LAUNCHES = 32

ALL_SUBSTEPS = 2**31 - 1


class _Run(ctypes.Structure):
    """The arguments of a run."""

    _fields_: ClassVar[Any] = [
        ("program", ctypes.c_void_p),  # the launches, as `Interpreter` writes them
        ("worlds", ctypes.c_void_p),  # indices of the worlds
        # Substeps of each step; if it is 0, contacts are found and nothing moves.
        ("due", ctypes.c_void_p),
        ("counter", ctypes.c_void_p),  # index in `worlds` of the next chunk, if threads share them
        ("world_count", ctypes.c_int32),
        ("step_count", ctypes.c_int32),
        ("chunk", ctypes.c_int32),  # number of worlds in a chunk
        ("resumed", ctypes.c_int32),  # 1: continue after the steps that each world has already done
        ("first_substep", ctypes.c_int32),  # if it is not 0, the step has already begun
        ("end_substep", ctypes.c_int32),  # the step is ended only after its last substep
        # 1: a step that fails is undone completely, whatever the reason, for another attempt.
        ("repeatable", ctypes.c_int32),
    ]


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

    def ask(self, **asked: int) -> None:
        """Set numbers of `_Run` for all later runs."""
        ...


class Interpreter(Stepper):
    """Performs a program on worlds, in one thread.

    Args:
        status: `State.status_entry`.
        worlds: Indices of the worlds; changed in place.
        due: Number of substeps of each step; changed in place.
        counter: An array of one number that all threads share; None for a single thread.
    """

    def __init__(
        self, status: np.ndarray, worlds: np.ndarray, due: np.ndarray, counter: np.ndarray | None
    ) -> None:
        self._status = status
        self._numbers = np.zeros(_HEADER + _PER_LAUNCH * _MOST_LAUNCHES, dtype=np.int64)
        self.program = Program([], [], [], [], [])
        # The memory that a run points to has to be kept alive.
        self._kept = (worlds, due, counter)
        self._asked = _Run(
            self._numbers.ctypes.data,
            worlds.ctypes.data,
            due.ctypes.data,
            None if counter is None else counter.ctypes.data,
            world_count=len(worlds),
            step_count=1,
            chunk=len(worlds),
            end_substep=ALL_SUBSTEPS,
        )
        # The arguments are changed in place, so the function itself never changes.
        self.run: Callable[[], None] = partial(library().perform, ctypes.byref(self._asked))
        self.address = ctypes.addressof(self._asked)

    def load(self, program: Program) -> None:  # noqa: D102
        # Launches are updated in place when arrays move, so they usually stay the same.
        if program == self.program:
            return
        ends = np.cumsum([len(part) for part in program])
        numbers: list[int] = [self._status.ctypes.data, self._status.strides[0], *ends.tolist()]
        for part in program:
            for launch in part:
                numbers.extend(launch.addresses("first_world", "substeps"))
        self._numbers[: len(numbers)] = numbers
        self.program = program

    def ask(self, **asked: int) -> None:  # noqa: D102
        for name, value in asked.items():
            setattr(self._asked, name, value)
