"""Going back in time in the chosen one of many worlds: to its start, or to a mark."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.many.shown import ShownWorlds
    from carom.worlds.saved import SavedWorlds

_MAX_MARKS = 32


class ManyMoments:
    """Saved states of the chosen world; the others stay as they are. Its methods are called between steps."""

    start_is_known = True
    """The worlds know their start themselves."""

    def __init__(self, shown: ShownWorlds, latest: LatestMessages) -> None:
        self._shown = shown
        self._latest = latest
        self._marks: dict[int, SavedWorlds] = {}
        self._next = 0

    def keep_start(self) -> None:
        """Does nothing: `Worlds.set_start` does."""

    def reset(self) -> None:
        """Puts the chosen world back to its start."""
        self._shown.worlds.reset(where=[self._shown.plan.chosen])

    def mark(self) -> None:
        """Saves the state of the chosen world, and drops the oldest mark if there are too many."""
        if len(self._marks) >= _MAX_MARKS:
            oldest = next(iter(self._marks))
            del self._marks[oldest]
            self._latest.remove(("mark", oldest), to_page.NO_MARK(mark=oldest))
        state = self._shown.worlds.snapshot([self._shown.plan.chosen])
        self._marks[self._next] = state
        header = to_page.MARK(mark=self._next, time=float(state.times[0]))
        self._latest.put(("mark", self._next), header)
        self._next += 1

    def restore(self, number: int) -> None:
        """Puts the world of a mark back to it, and looks at that world."""
        state = self._marks.get(number)
        if state is not None:
            self._shown.worlds.restore(state, state.worlds)
            self._shown.choose(int(state.worlds[0]))
