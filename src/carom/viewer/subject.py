"""What a viewer needs of what it shows: a world, or some of many."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from carom.scene.core.restorable import Restorable
    from carom.viewer.history.frames import Frames
    from carom.viewer.input.handles import Handles
    from carom.viewer.input.scene_hands import Answer
    from carom.viewer.many.shown import ShownWorlds
    from carom.viewer.protocol.message import Message
    from carom.viewer.steps.step_lock import Pausing


class Hands(Protocol):
    """What users do to bodies.

    Attributes:
        handles: Frames of scripts that users move.
    """

    handles: Handles

    def answers(self) -> dict[Message, Answer]:
        """What is done for each message about bodies."""
        ...

    def apply(self) -> None:
        """Do what pages have asked for."""
        ...

    def gone(self, page: int) -> None:
        """A page has closed."""
        ...


class Times(Protocol):
    """States to go back to."""

    @property
    def start_is_known(self) -> bool:
        """Whether the start is saved."""
        ...

    def keep_start(self) -> None:
        """Saves the present state as the start, unless there is one."""
        ...

    def reset(self) -> None:
        """Goes back to the start."""
        ...

    def mark(self) -> None:
        """Saves the present state as a mark."""
        ...

    def restore(self, number: int) -> None:
        """Goes back to a mark."""
        ...


class Subject(Protocol):
    """What a viewer shows.

    Attributes:
        world: The world, or the chosen one as a world.
        lock: Held during steps.
        shown: Which of many worlds are shown; None for a single one.
        frames: Makes frames of it.
        moments: States to go back to.
        hands: What users do to bodies.
    """

    world: Restorable
    lock: Any
    shown: ShownWorlds | None
    frames: Frames
    moments: Times
    hands: Hands

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        ...

    def observe(self, viewer: Pausing) -> None:
        """Lets the viewer hold up its steps from now on."""
        ...

    def leave(self) -> None:
        """Lets its steps be."""
        ...
