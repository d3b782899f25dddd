"""Tendons of a body, as handles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.actuator import Range
from carom.native.gates import gated
from carom.scene.named import Named
from carom.scene.named_constraints.named_constraint import NamedConstraint, change_constraints
from carom.scene.named_constraints.owners import handle_of
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.tendons.making import tendons_of
from carom.scene.tendons.measure import forces_of_tendon, measured

if TYPE_CHECKING:
    from carom.scene.body import Body


class BodyTendon(NamedConstraint):
    """A tendon: a spring, a damper, dry friction and a limit along a path."""

    __slots__ = ()

    kind = "tendon"

    def __repr__(self) -> str:
        return f"<Tendon {self.name!r} of {self.body.name!r}: {self.length:.6g} long>"

    @property
    def body(self) -> Body:
        """The body that it moves."""
        return handle_of(self._constraint.parent)

    @property
    def length(self) -> float:
        """Length of its path [m], for the present coordinates; of one over joints their weighted sum."""
        return float(self._measured()[0])

    @property
    def velocity(self) -> float:
        """Rate of its length [m/s]."""
        return float(self._measured()[1])

    @property
    def force(self) -> float:
        """Force of its spring and damper, its friction and its limit in the last substep [N].

        Positive if it makes the tendon longer. Actuators of the tendon are not in it.
        """
        return forces_of_tendon(self._constraint)[0]

    @property
    def limit_force(self) -> float:
        """Force of its limit in the last substep, 0 or more [N]; where both act, what is left of them."""
        return forces_of_tendon(self._constraint)[1]

    @property
    def stiffness(self) -> float:
        """Stiffness of its spring [N/m]; settable."""
        return self._constraint.spring[0]

    @stiffness.setter
    def stiffness(self, value: float) -> None:
        self._set_spring(stiffness=value)

    @property
    def damping(self) -> float:
        """Damping [N s/m]; settable."""
        return self._constraint.spring[1]

    @damping.setter
    def damping(self, value: float) -> None:
        self._set_spring(damping=value)

    @property
    def armature(self) -> float:
        """Inertia along it [kg]; settable."""
        return self._constraint.armature

    @armature.setter
    def armature(self, value: float) -> None:
        change_constraints((self._constraint,), armature=_positive(value, "armature"))

    @property
    def spring_range(self) -> Range:
        """Lengths between which its spring is slack [m]; settable."""
        return self._constraint.spring[2:]

    @spring_range.setter
    def spring_range(self, value: Range) -> None:
        self._set_spring(rest=value)

    @property
    def range(self) -> Range:
        """Least and greatest length [m]; settable."""
        return self._constraint.range[:2]

    @range.setter
    @gated("_constraint.parent.world.call_lock")
    def range(self, value: Range) -> None:
        lower, upper = value
        if not lower <= upper:
            raise ValueError(f"range {lower:g} to {upper:g} is empty")
        self._set(self._constraint.spring, (float(lower), float(upper), *self._constraint.range[2:]))

    @property
    def friction(self) -> float:
        """Greatest force of its dry friction [N]; settable."""
        return self._constraint.range[2]

    @friction.setter
    @gated("_constraint.parent.world.call_lock")
    def friction(self, value: float) -> None:
        lower, upper, _, margin = self._constraint.range
        self._set(self._constraint.spring, (lower, upper, _positive(value, "friction"), margin))

    @gated("_constraint.parent.world.call_lock")
    def _measured(self) -> tuple[float, float]:
        length, velocity = measured(LoneSource(self.body.world), self.body, self._constraint.path)
        return float(length[0]), float(velocity[0])

    @gated("_constraint.parent.world.call_lock")
    def _set_spring(
        self, stiffness: float | None = None, damping: float | None = None, rest: Range | None = None
    ) -> None:
        before = self._constraint.spring
        lower, upper = before[2:] if rest is None else rest
        if not lower <= upper:
            raise ValueError(f"spring_range {lower:g} to {upper:g} is empty")
        k = before[0] if stiffness is None else _positive(stiffness, "stiffness")
        d = before[1] if damping is None else _positive(damping, "damping")
        self._set((k, d, float(lower), float(upper)), self._constraint.range)

    @gated("_constraint.parent.world.call_lock")
    def _set(
        self, spring: tuple[float, float, float, float], bounds: tuple[float, float, float, float]
    ) -> None:
        change_constraints((self._constraint,), spring=spring, range=bounds)


def _positive(value: float, name: str) -> float:
    if not 0.0 <= value < float("inf"):
        raise ValueError(f"{name} must be 0 or more, not {value}")
    return float(value)


class BodyTendons(Named[BodyTendon]):
    """All tendons of a body: `tendons["split"]`, `tendons[0]`."""

    def __init__(self, body: Body) -> None:
        super().__init__("tendon", [BodyTendon(it) for it in tendons_of(body)])
        self._body = body

    def __repr__(self) -> str:
        return f"<Tendons of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"
