"""A world whose states can be saved and restored."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.core.world_core import WorldCore

if TYPE_CHECKING:
    from carom.scene.snapshot import Shape, Snapshot


class Restorable(WorldCore):
    """What a world is that goes back to states that it had; `World` describes the attributes."""

    @property
    def _shape(self) -> Shape:
        if self._derived.shape is None:
            from carom.scene.snapshot import Shape, layout

            self._derived.shape = Shape(layout(self))
        return self._derived.shape

    @gated("call_lock")
    def snapshot(self) -> Snapshot:
        """The present state, for `restore`, which can be called any number of times.

        It contains positions and velocities, motors, applied forces, contacts and time; not masses and shapes
        of bodies, constraints, gravity and other parameters.
        """
        from carom.scene.snapshot import take

        return take(self, self._shape)

    def restore(self, state: Snapshot, *, update_poses: bool = False) -> None:
        """Restore a state; `World.restore` describes the arguments, and what is raised."""
        from carom.scene.snapshot import return_to

        with self.call_lock, uninterrupted:
            self.refuse_in_step()
            change = Change()
            return_to(change, self, self._shape, state)
            if update_poses:
                self.note_link_poses(change)
            change.commit()
