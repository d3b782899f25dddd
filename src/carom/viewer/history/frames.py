"""Making the frames of a viewer from the present state of its world, and keeping them."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any, Protocol

from carom.viewer.details import DetailRequest, Details
from carom.viewer.history.recorder import HistoryRecorder
from carom.viewer.lenses import Lenses
from carom.viewer.scene_feed import SceneFeed

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.scene_feed import Blocks


class Feed(Protocol):
    """Tells of bodies and their poses; see `SceneFeed`.

    Attributes:
        collisions: Whether to describe collision shapes as well.
        moved: Whether the last frame differs from the one before it.
    """

    collisions: bool
    moved: bool

    def follow(self) -> None:
        """Puts what has changed among the latest messages."""
        ...

    def frame(
        self,
        extras: dict[str, Any],
        blocks: Blocks = (),
        number: int | None = None,
        time: float | None = None,
    ) -> bytes | None:
        """The present poses as a message; None if nothing has changed."""
        ...


class Frames:
    """Makes frames. For use by one thread, except `plot`.

    Args:
        world: The world.
        feed: Tells of its bodies.
        details: Tells what pages want to know besides poses.
        lock: Held while cameras are read.
        latest: Messages of its viewer.
        history: Memory for the past [bytes]; with 0 nothing is kept.

    Attributes:
        details: What pages want to know besides poses.
        lenses: The views of the script's cameras.
        past: The frames that are kept.
    """

    def __init__(
        self,
        world: WorldCore,
        feed: Feed,
        details: Details,
        lock: Any,
        latest: LatestMessages,
        history: int,
    ) -> None:
        self._world = world
        self._feed = feed
        self.past: HistoryRecorder = HistoryRecorder(latest, history)
        self.lenses: Lenses = Lenses(latest, lock)
        self.details: Details = details
        self._values: dict[str, float] = {}

    @classmethod
    def of_world(cls, world: WorldCore, lock: Any, latest: LatestMessages, history: int) -> Frames:
        """Those of a single world, by the lock of its steps."""
        feed, details = SceneFeed(world, lock, latest), Details(world, lock, latest, always=history > 0)
        return cls(world, feed, details, lock, latest, history)

    def plot(self, name: str, value: float) -> None:
        """Sets a value of the script, which frames tell from now on.

        Raises:
            ValueError: The value is not a finite number.
        """
        number = float(value)
        if not isfinite(number):
            raise ValueError(f"plot {name!r} is given {value!r}; it has to be a finite number")
        self._values[str(name)] = number

    def want(self, page: int, wish: DetailRequest) -> None:
        """Sets what a page wants to know."""
        self.details.want(page, wish)
        self._feed.collisions = self.details.wish.collisions

    def take(self, picture: int) -> bytes | None:
        """Makes a frame of the present state and keeps it; None if it is as the last one.

        Args:
            picture: Number of the picture that the script waits for.
        """
        # Steps may end meanwhile: what is read then is later than the time of the frame, and never earlier.
        time = float(self._world.time)
        # This may take long.
        self._feed.follow()
        self.lenses.update()
        blocks = self.details.blocks()
        extras: dict[str, Any] = {"picture": picture}
        if self._values:
            extras["values"] = self._values.copy()
        number = self.past.next_number if self.past.is_on else None
        frame = self._feed.frame(extras, blocks, number, time)
        self.past.take(frame if self._feed.moved else None)
        return frame
