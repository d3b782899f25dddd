"""The viewer's part in the steps of many worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.viewer.many.feed import ManyFeed
    from carom.viewer.many.hands import ManyHands
    from carom.viewer.many.shown import ShownWorlds
    from carom.viewer.steps.step_lock import Pausing


class ManySteps:
    """Makes steps wait for the viewer, pull what users pull, and be seen; one of `Worlds.observers`.

    The worlds are seen when a frame wants it, at the rate of pictures, and not after each step.
    """

    def __init__(self, viewer: Pausing, shown: ShownWorlds, feed: ManyFeed, hands: ManyHands) -> None:
        self._viewer = viewer
        self._shown = shown
        self._feed = feed
        self._hands = hands

    @property
    def each_step(self) -> bool:
        """Whether it has something to do at each step."""
        return self._hands.busy

    def before_steps(self) -> None:
        """Waits while the simulation is paused, then pulls."""
        if self._viewer.held:
            self._viewer.wait_for_turn()
        if self._hands.busy:
            self._hands.push()

    def after_steps(self) -> None:
        """Sees the worlds, if a frame waits for it."""
        if self._feed.wanted and self._shown.look(0.0):
            self._feed.wanted = False
