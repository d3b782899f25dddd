"""Observers of the steps of a world."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


class Observer(Protocol):
    """Interface of the objects in `World.observers`, which are called at every step."""

    def before_step(self) -> None:
        """Called before a step."""
        ...

    def after_step(self) -> None:
        """Called after a step."""
        ...


@runtime_checkable
class SubstepObserver(Protocol):
    """Interface of the argument of `World.watch_substeps`, which is called at every substep."""

    def after_substep(self) -> None:
        """Called after a substep, or after a step without substeps."""
        ...

    def step_repeated(self) -> None:
        """Called when a step is repeated because arrays were too short."""
        ...
