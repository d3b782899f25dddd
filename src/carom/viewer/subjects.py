"""What a viewer shows: a world, or some of many; with the parts of the viewer that know which."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from carom.scene.core.stepping import Stepping
from carom.viewer.history.frames import Frames
from carom.viewer.input.scene_hands import SceneHands
from carom.viewer.steps.moments import Moments
from carom.viewer.steps.step_lock import StepLock

if TYPE_CHECKING:
    from carom.scene.core.restorable import Restorable
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.many.shown import ShownWorlds
    from carom.viewer.many.subject import ManyWorlds
    from carom.viewer.steps.pause_control import PauseControl
    from carom.viewer.steps.step_lock import Pausing
    from carom.viewer.steps.step_queue import StepQueue
    from carom.viewer.subject import Hands, Times


class OneWorld:
    """A single world. `lock` is that of its owner, None for its own."""

    def __init__(
        self,
        world: Restorable,
        lock: Any,
        latest: LatestMessages,
        pause: PauseControl,
        steps: StepQueue,
        history: int,
    ) -> None:
        self.world: Restorable = world
        self.lock: Any = lock
        self.shown: ShownWorlds | None = None
        self.frames: Frames = Frames.of_world(world, lock, latest, history)
        self.moments: Times = Moments(world, latest)
        self.hands: Hands = SceneHands(world, lock, latest, pause, steps)
        self._step_lock: StepLock | None = None

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return float(self.world.time)

    def observe(self, viewer: Pausing) -> None:
        """Lets the viewer hold up its steps from now on."""
        self._step_lock = StepLock(viewer)
        self.world.observers.append(self._step_lock)

    def leave(self) -> None:
        """Lets its steps be."""
        if self._step_lock in self.world.observers:
            self.world.observers.remove(self._step_lock)
        self._step_lock = None


def many_worlds(
    shown: ShownWorlds, latest: LatestMessages, pause: PauseControl, steps: StepQueue, history: int
) -> ManyWorlds:
    """Many worlds as the subject of a viewer; only they need what is loaded here."""
    from carom.viewer.many.subject import ManyWorlds

    return ManyWorlds(shown, latest, pause, steps, history)


def lock_of(world: Any) -> Any:
    """The lock of what is to be shown.

    Raises:
        TypeError: It is neither a world nor many worlds.
    """
    if isinstance(world, Stepping):
        return world.lock
    # A module of a higher layer; whoever has some has loaded it.
    loaded = sys.modules.get("carom.worlds.worlds")
    if loaded is None or not isinstance(world, loaded.Worlds):
        raise TypeError(f"a viewer shows a World or Worlds, not {type(world).__name__}")
    return world.lock


def shown_of(world: Any, choice: dict[str, Any]) -> ShownWorlds | None:
    """Which of many worlds are shown; None for a single world.

    Raises:
        ValueError: There are no such worlds, or a single world is to be shown as several.
        NotImplementedError: They have soft bodies.
    """
    if not isinstance(world, Stepping):
        from carom.viewer.many.shown import ShownWorlds

        return ShownWorlds(world, **choice)
    if choice:
        raise ValueError(f"{', '.join(sorted(choice))}: only for Worlds; this is a single World")
    return None
