"""What is told of the steps of a world."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


class Observer(Protocol):
    """What `World.observers` holds: something that is told of every step."""

    def before_step(self) -> None:
        """A step is about to be made."""
        ...

    def after_step(self) -> None:
        """It has been made."""
        ...


@runtime_checkable
class SubstepObserver(Protocol):
    """What `World.watch_substeps` takes: something that is told of every substep."""

    def after_substep(self) -> None:
        """A substep has been made, or a step that has no substeps."""
        ...

    def step_repeated(self) -> None:
        """The step is made again from its beginning, since something did not fit into its arrays."""
        ...
