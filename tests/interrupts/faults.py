"""A fault at a chosen instruction of a call: what a signal handler does by chance, decided beforehand."""

from __future__ import annotations

import linecache
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FrameType
from typing import Any

import carom
import pybullet
from carom.native import uninterrupted

# Python 3.13 does not report the instructions of a function's first call that is traced, only its lines.
_LINES = sys.version_info >= (3, 13)
_OURS = tuple(str(Path(package.__path__[0])) for package in (carom, pybullet))


class Fault(BaseException):
    """What is raised."""


class Fuse:
    """Counts the instructions that our code performs within a call, and raises a fault at one.

    Attributes:
        count: How many there have been.
        where: The line at which the fault was raised.

    Args:
        place: Which one; None for none.
    """

    def __init__(self, place: int | None = None) -> None:
        self.count = 0
        self.where = ""
        self._place = place

    def blow(self, call: Callable[[], Any]) -> Any:
        """Make the call; raises the fault, and whatever the call raises."""
        state = uninterrupted._State
        before, state.keeps_tracing = sys.gettrace(), True
        sys.settrace(self._trace)
        try:
            return call()
        finally:
            sys.settrace(before)
            state.keeps_tracing = False

    def _trace(self, frame: FrameType, event: str, _argument: Any) -> Any:
        file = frame.f_code.co_filename
        if not file.startswith(_OURS) or file == uninterrupted.__file__:
            return None
        frame.f_trace_opcodes, frame.f_trace_lines = True, _LINES
        # Instructions without a line are those that end a `with` block or an exception.
        line: int | None = frame.f_lineno
        if event == "call" or not line:
            return self._trace
        if not enters_or_leaves_a_section(file, line):
            self.count += 1
            if self.count == self._place:
                self.where = f"{file}:{line}"
                raise Fault
        return self._trace


@cache
def enters_or_leaves_a_section(file: str, line: int) -> bool:
    """Whether signals cannot come there: Python lets no handler run between a lock and its `with` block."""
    code = linecache.getline(file, line).strip()
    return code.startswith("with ") or code in ("begin()", "end()")
