"""Changes of several parts that an exception may break off at any line.

Ctrl-C and timers raise exceptions between any two lines of the main thread, and memory may be short anywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType

# An impatient user may break off what mends a broken change, too: so often it is begun again.
_PATIENCE = 100


class Undo:
    """What leads back to a whole, noted before each part is changed.

    A step *sets* a part to its old value, or, if the new value is known already, to the new one. It
    can be taken again. As a context it takes all steps that are left at the end, the last noted first:

        with undo:
            undo.note(step)
            ...  # change the part
            undo.done()
    """

    def __init__(self) -> None:
        self._steps: list[Callable[[], None]] = []

    def __enter__(self) -> Undo:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if error is None:
            self.settle()
        else:
            self._settle_patiently()

    def at_once(self, change: Callable[[], None]) -> None:
        """Make a change that can be made again, to its end even if it is interrupted."""
        # A context would do it as well, but scripts change parameters at every step.
        try:
            self._steps.append(change)
            change()
            self._steps.clear()
        except BaseException:
            self._settle_patiently()
            raise

    def note(self, step: Callable[[], None]) -> None:
        """Take this step, unless the change is done."""
        self._steps.append(step)

    def settle(self) -> None:
        """Take the steps that are left. Nothing may be left of an earlier change when another begins."""
        while self._steps:
            self._steps[-1]()
            self._steps.pop()

    def _settle_patiently(self) -> None:
        """Take the steps that are left while an exception is on its way already."""
        for _ in range(_PATIENCE):
            try:
                self.settle()
                return
            except BaseException:
                continue

    def done(self) -> None:
        """The change has been made: forget the steps."""
        self._steps.clear()
