"""Tendons of a body in many worlds."""

from __future__ import annotations

from carom.checks import Array
from carom.description.actuator import Range
from carom.native.gates import gated
from carom.scene.sensors.source import Source
from carom.scene.tendons.measure import measured
from carom.scene.tendons.tendon import BodyTendon, BodyTendons
from carom.scene.user_constraints import ROWS
from carom.worlds.batch import Batch
from carom.worlds.parts.holding import HoldingBatch
from carom.worlds.parts.part import Parts

# Spring, damper and friction come first, then the limits.
_BEFORE_LIMITS = 2


class TendonBatch(HoldingBatch):
    """A tendon in all worlds: a spring, a damper, dry friction and a limit along a path.

    Get it from `worlds[body].tendons`. Where it is disabled can differ between worlds; its other parameters
    are those of the original world, where they are set before it is copied.
    """

    def __init__(self, one: BodyTendon, batch: Batch, source: Source) -> None:
        self._tendon, self._batch, self._source = one, batch, source
        super().__init__(one, batch._scene, batch._engine)

    @property
    def length(self) -> Array:
        """Length of its path [m], now, (count,); of one over joints their weighted sum."""
        return self._measured()[0]

    @property
    def velocity(self) -> Array:
        """Rate of its length [m/s], (count,)."""
        return self._measured()[1]

    @property
    def force(self) -> Array:
        """Force of its spring and damper, its friction and its limit in the last substep [N], (count,).

        Positive if it makes the tendon longer. Actuators of the tendon are not in it.
        """
        return self._forces().sum(axis=1)

    @property
    def limit_force(self) -> Array:
        """Force of its limit in the last substep, 0 or more [N], (count,)."""
        return abs(self._forces()[:, _BEFORE_LIMITS:].sum(axis=1))

    @property
    def stiffness(self) -> float:
        """Stiffness of its spring [N/m], the same in all worlds, as all that follow."""
        return self._tendon.stiffness

    @property
    def damping(self) -> float:
        """Damping [N s/m]."""
        return self._tendon.damping

    @property
    def armature(self) -> float:
        """Inertia along it [kg]."""
        return self._tendon.armature

    @property
    def spring_range(self) -> Range:
        """Lengths between which its spring is slack [m]."""
        return self._tendon.spring_range

    @property
    def range(self) -> Range:
        """Least and greatest length [m]."""
        return self._tendon.range

    @property
    def friction(self) -> float:
        """Greatest force of its dry friction [N]."""
        return self._tendon.friction

    @gated("_scene.call_lock")
    def _measured(self) -> tuple[Array, Array]:
        return measured(self._source, self._batch._body, self._tendon._constraint.path)

    def _forces(self) -> Array:
        return self._impulses(self._rows()[0])[:, : ROWS[self._tendon._constraint.kind]]


class TendonBatches(Parts[TendonBatch]):
    """All tendons of a body in all worlds: `tendons["split"].length`."""

    def __init__(self, batch: Batch, source: Source) -> None:
        tendons = BodyTendons(batch._body)
        super().__init__("tendon", [TendonBatch(tendon, batch, source) for tendon in tendons])
        self._batch = batch
