"""Keeping bodies awake, as the key d does in PyBullet's window."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.layouts.flags import ActivationChange
from carom.model.body_spec import BASE
from carom.scene.dynamics.changes import change_dynamics

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore


class Sleeping:
    """Whether bodies may fall asleep. Its method is called between steps."""

    def __init__(self, world: WorldCore) -> None:
        self._world = world
        self._kept_awake: list[BodyCore] | None = None

    def toggle(self) -> None:
        """Wakes all bodies and keeps them awake, or restores which of them may sleep."""
        if self._kept_awake is None:
            can_sleep = self._world.arrays.model.numpy["tree_can_sleep"]
            self._kept_awake = [body for body in self._world.bodies.values() if can_sleep[body.rows.tree]]
            for body in self._kept_awake:
                _change(body, ActivationChange.WAKE_UP | ActivationChange.DISABLE_SLEEPING)
            return
        for body in self._kept_awake:
            if self._world.bodies.get(body.id) is body:
                _change(body, ActivationChange.ENABLE_SLEEPING)
        self._kept_awake = None


def _change(body: BodyCore, change: ActivationChange) -> None:
    change_dynamics(body, BASE, {"activation_state": change})
