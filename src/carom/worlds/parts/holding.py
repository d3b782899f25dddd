"""What constraints and tendons of many worlds have in common: where they hold, and their impulses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.closed import Closed
from carom.native.gates import gated
from carom.scene.named_constraints.named_constraint import NamedConstraint
from carom.worlds.chosen import Chosen, Mask, Where

if TYPE_CHECKING:
    from carom.engine.engine import Engine
    from carom.world.world import World


class HoldingBatch(Closed):
    """A constraint or a tendon in all worlds.

    Attributes:
        name: Its name.
        kind: What it is, as `World.constrain` names it; "tendon" of a tendon.
        max_force: Greatest force along, and torque about, each axis [N or N m], the same in all worlds; of
            the original world when this was made.
    """

    def __init__(self, one: NamedConstraint, scene: World, engine: Engine) -> None:
        self.name: str = one.name
        self.kind: str = one.kind
        self.max_force: float = one.max_force
        self._one, self._scene, self._engine = one, scene, engine
        self._close()

    def __repr__(self) -> str:
        kind = f"{type(self).__name__} {self.name!r}, {self.kind}"
        return f"<{kind}, in {self._engine.arrays.world_count} worlds>"

    @property
    def enabled(self) -> Mask:
        """In which worlds it holds, a copy (count,); settable, to one value for all or one for each."""
        with self._scene.call_lock:
            return self._engine.parameter("users", "user_enabled", self._rows()[0]) != 0

    @enabled.setter
    def enabled(self, value: ArrayLike) -> None:
        self.enable(value)

    @gated("_scene.call_lock", section=True)
    def enable(self, enabled: ArrayLike = True, *, where: Where | None = None) -> None:
        """Switch it on or off in each world, or in some.

        Args:
            enabled: Whether it holds: one value, or one for each of the n worlds chosen, (n,).
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: The number of values differs from that of the worlds chosen.
        """
        worlds = Chosen(self._engine.take(where), self._engine.arrays.world_count)
        holds = worlds.values(np.asarray(self._engine.take(enabled), dtype=bool), (), "enabled") != 0.0
        for row in self._rows():
            self._engine.set_parameter("users", "user_enabled", row, holds, worlds.rows)
        self._engine.contact_arrays.forget_order()

    def _rows(self) -> list[int]:
        rows = self._scene.user_constraints.rows
        return [rows[each.id] for each in self._one._parts]

    @gated("_scene.call_lock")
    def _impulses(self, row: int) -> Array:
        """Impulses per substep time [N or N m], (count, 6); 0 where it is disabled."""
        found = np.asarray(self._engine.arrays.state.numpy["user_impulse"])[:, row]
        return np.where(self.enabled[:, np.newaxis], found, 0.0) / self._scene.parameters.substep_time
