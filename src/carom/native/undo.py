"""Changes of several parts that an exception may interrupt at any line.

Signal handlers of the user do not run in the middle of them (`carom.native.uninterrupted`). But Ctrl-C raises
`KeyboardInterrupt` between any two lines of the main thread, and any allocation may fail.
"""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType

from carom.native.uninterrupted import begin, end, uninterrupted

# Ctrl-C may interrupt the repair of an interrupted change as well: maximum number of attempts.
_PATIENCE = 100


class Undo:
    """Steps that make data consistent again after an interrupted change; noted before each part is changed.

    A step *sets* a part to its old value, or, if the new value is known already, to the new one. So it can be
    repeated. As a context manager it performs all remaining steps at the end, the last noted first:

        with undo:
            undo.note(step)
            ...  # change the part
            undo.done()
    """

    def __init__(self) -> None:
        self._steps: list[Callable[[], None]] = []

    def __enter__(self) -> None:
        begin()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        try:
            if error is None:
                self.settle()
            else:
                self._settle_patiently()
        finally:
            end()

    def at_once(self, change: Callable[[], None]) -> None:
        """Make a repeatable change; if it is interrupted, it is completed before the exception goes on."""
        # The context manager would do this as well, but takes longer, and scripts change parameters often.
        begin()
        try:
            self._steps.append(change)
            change()
            self._steps.clear()
        except BaseException:
            self._settle_patiently()
            raise
        finally:
            end()

    def note(self, step: Callable[[], None]) -> None:
        """Add a step, which is performed unless `done` is called."""
        self._steps.append(step)

    def settle(self) -> None:
        """Perform the remaining steps. None may be left of an earlier change when another begins."""
        if not self._steps:
            return
        with uninterrupted:
            while self._steps:
                self._steps[-1]()
                self._steps.pop()

    def _settle_patiently(self) -> None:
        """Perform the remaining steps while an exception is being handled; retry if another one occurs."""
        for _ in range(_PATIENCE):
            try:
                self.settle()
                return
            except BaseException:
                continue

    def done(self) -> None:
        """Discard the steps: the change is complete."""
        self._steps.clear()
