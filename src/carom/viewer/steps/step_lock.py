"""The viewer's lock on the steps of a world of the modern API."""

from __future__ import annotations

from typing import Any, Protocol


class Pausing(Protocol):
    """What holds steps up: the viewer.

    Attributes:
        lock: Held during each step.
        held: Whether steps have to wait.
    """

    lock: Any
    held: bool

    def wait_for_turn(self) -> object:
        """Wait until a step may begin."""
        ...


class StepLock:
    """Makes each step wait for the viewer and hold its lock; one of `World.observers`.

    So pages can pause, pull bodies and go back in time while a script calls `World.step`.
    """

    def __init__(self, viewer: Pausing) -> None:
        self._viewer = viewer
        self._lock: Any = viewer.lock
        self._held = False

    def before_step(self) -> None:
        """Waits while the simulation is paused, then takes the lock."""
        if self._viewer.held:
            self._viewer.wait_for_turn()
        # A step that failed has not released the lock.
        if not self._held:
            self._lock.acquire()
            self._held = True

    def after_step(self) -> None:
        """Releases the lock."""
        self._held = False
        self._lock.release()
