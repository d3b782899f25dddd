"""Beginning a change of the scene, which is then made completely or not at all."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING

from carom.native.uninterrupted import uninterrupted

if TYPE_CHECKING:
    from carom.native.undo import Undo
    from carom.world.world import World


class begin:
    """A change of a world as a context manager, which gives its `Undo`; nothing of the user interrupts it.

    It first completes an earlier change that was interrupted.
    """

    __slots__ = ("_world",)

    def __init__(self, world: World) -> None:
        self._world = world

    def __enter__(self) -> Undo:
        world = self._world
        with uninterrupted:
            world.undo.__enter__()
            try:
                world.undo.settle()
                # Derived data of the old world must not be used before the change is complete.
                world.undo.note(world.scene_changed)
                world.scene_changed()
            except BaseException as problem:
                world.undo.__exit__(type(problem), problem, None)
                raise
        return world.undo

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._world.undo.__exit__(kind, error, traceback)
