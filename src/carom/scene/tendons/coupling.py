"""Couplings of tendons, as handles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from carom.layouts.codes import UserConstraintKind
from carom.native.gates import gated
from carom.scene.named_constraints.named_constraint import NamedConstraint
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.tendons.measure import measured

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


class TendonCoupling(NamedConstraint):
    """Holds the length of a tendon at a polynomial of that of another one, both from where they began."""

    __slots__ = ()

    kind = "tendons"

    def __repr__(self) -> str:
        return f"<TendonCoupling {self.name!r}{'' if self.enabled else ', disabled'}>"

    @property
    def coefficients(self) -> tuple[float, float, float, float, float]:
        """Of the polynomial, from the constant to the fourth power."""
        return (self._constraint.relative_position_target, *self._constraint.polynomial)

    @property
    @gated("_constraint.parent.world.call_lock")
    def error(self) -> float:
        """Length of the tendon minus what it should be [m]."""
        it = self._constraint
        source = LoneSource(it.parent.world)
        wanted, factor = it.relative_position_target, 1.0
        if it.second_path:
            x = float(measured(source, it.parent, it.second_path)[0][0]) - it.range[1]
            for coefficient in it.polynomial:
                factor *= x
                wanted += coefficient * factor
        return float(measured(source, it.parent, it.path)[0][0]) - it.range[0] - wanted

    @property
    def force(self) -> float:
        """Force along the tendon in the last substep [N]; 0 while it is disabled."""
        return float(self._forces(1)[0])


def tendon_couplings_of(bodies: Sequence[BodyCore]) -> list[TendonCoupling]:
    """The couplings of tendons of some bodies of a world."""
    kind = UserConstraintKind.TENDON_COUPLING
    users = bodies[0].world.user_constraints.all if bodies else []
    return [TendonCoupling(it) for it in users if it.kind is kind and it.parent in bodies]
