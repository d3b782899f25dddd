"""The start of a world, to which it can be reset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from carom.native.gates import alone

if TYPE_CHECKING:
    from collections.abc import Callable

    from carom.scene.snapshot import Snapshot
    from carom.world.world import World


class Starting:
    """Resets of a world to its start."""

    # A state, and the bodies that it is of.
    _start: tuple[Snapshot, tuple[int, ...]] | None = None
    # Whether the state before the first step is kept; the drop-in has no use for it.
    _keeps_start: bool = True

    @alone("call_lock")
    def set_start(self) -> None:
        """Let the present state be the one that `reset` returns to, until bodies come or go."""
        world = cast("World", self)
        self._start = world.snapshot(), tuple(world.bodies.keys())

    @alone("call_lock")
    def reset(self, keyframe: str | None = None) -> None:
        """Return to the start, or to a keyframe of the bodies that have one of this name, and to its time.

        The start is what `set_start` has kept, or else the state before the first step, or the first
        keyframe, since a body came or went. Bodies, parameters and constraints stay as they are; `clear`
        removes them.

        Raises:
            KeyError: No body has a keyframe of this name; the message says which there are.
        """
        world = cast("World", self)
        if keyframe is not None:
            from carom.scene.keyframes.keyframe import keyframes_of

            keyframes = keyframes_of(list(world.bodies.values()))
            if keyframe not in keyframes:
                known = ", ".join(map(repr, keyframes)) or "none"
                raise KeyError(f"no body has a keyframe {keyframe!r}; there are {known}")
            # It need not be where worlds begin.
            self._keep_start()
            keyframes[keyframe].reset()
        elif self._start is not None and self._start[1] == tuple(world.bodies.keys()):
            world.restore(self._start[0], update_poses=True)
        # Otherwise it has not been stepped: it is there.

    def _prepared_step(self) -> Callable[[Any], bool]:
        """Keep the state before the first step; see `Stepping`."""
        if self._keeps_start:
            self._keep_start()
        return super()._prepared_step()  # pyright: ignore[reportAttributeAccessIssue]

    def _keep_start(self) -> None:
        world = cast("World", self)
        if self._start is None or self._start[1] != tuple(world.bodies.keys()):
            self._start = world.snapshot(), tuple(world.bodies.keys())
