"""Some of many worlds as what a viewer shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.viewer.details import Details
from carom.viewer.history.frames import Frames
from carom.viewer.many.feed import ManyFeed
from carom.viewer.many.hands import ManyHands
from carom.viewer.many.moments import ManyMoments
from carom.viewer.many.shown import ShownWorlds
from carom.viewer.many.steps import ManySteps

if TYPE_CHECKING:
    from carom.scene.core.restorable import Restorable
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.steps.pause_control import PauseControl
    from carom.viewer.steps.step_lock import Pausing
    from carom.viewer.steps.step_queue import StepQueue
    from carom.viewer.subject import Hands, Times


class ManyWorlds:
    """Some of many worlds."""

    def __init__(
        self, shown: ShownWorlds, latest: LatestMessages, pause: PauseControl, steps: StepQueue, history: int
    ) -> None:
        self.shown: ShownWorlds | None = shown
        self._shown = shown
        self.world: Restorable = shown.lone
        self.lock: Any = shown.worlds.lock
        self._feed = ManyFeed(shown, latest)
        details = Details(shown.lone, shown.lone.lock, latest, always=history > 0)
        self.frames: Frames = Frames(shown.lone, self._feed, details, shown.lone.lock, latest, history)
        self.moments: Times = ManyMoments(shown, latest)
        self._hands = ManyHands(shown, self._feed, latest, pause, steps)
        self.hands: Hands = self._hands
        self._steps: ManySteps | None = None

    @property
    def time(self) -> float:
        """Simulated time of the chosen world [s]."""
        return float(self._shown.worlds.time[self._shown.plan.chosen])

    def observe(self, viewer: Pausing) -> None:
        """Lets the viewer hold up the steps from now on."""
        self._steps = ManySteps(viewer, self._shown, self._feed, self._hands)
        self._shown.worlds.observers.append(self._steps)

    def leave(self) -> None:
        """Lets the steps be."""
        if self._steps in self._shown.worlds.observers:
            self._shown.worlds.observers.remove(self._steps)
        self._steps = None
