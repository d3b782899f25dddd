"""What named constraints of a world have in common: their name, whether they hold, and their impulses."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.codes import UserConstraintKind
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.description.compliance import Compliance
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

UNBOUNDED = 1e30
"""Greatest impulse of each row of a named constraint per substep [N s or N m s]; no solver gets there."""


class NamedConstraint:
    """A constraint of a file, or of the modern API, that can be switched off and on."""

    __slots__ = ("_constraint",)

    kind = ""
    """What it is, as `World.constrain` names it."""

    def __init__(self, constraint: UserConstraint) -> None:
        self._constraint = constraint

    def __eq__(self, other: object) -> bool:
        return isinstance(other, NamedConstraint) and other._constraint is self._constraint

    def __hash__(self) -> int:
        return hash(self._constraint)

    @property
    def name(self) -> str:
        """Its name, or that in the file; in URDF files of `<mimic>` that of the joint."""
        return self._constraint.name

    @property
    def enabled(self) -> bool:
        """Whether it holds; settable. Where it is switched on again, it pulls what it constrains back."""
        return self._constraint.enabled

    @enabled.setter
    def enabled(self, value: bool) -> None:
        if any(each.enabled != bool(value) for each in self._parts):
            change_constraints(self._parts, enabled=bool(value))

    @property
    def max_force(self) -> float:
        """Greatest force along, and torque about, each axis [N or N m]; settable, inf without a bound.

        It is kept as an impulse of a substep: after a change of the time step, set it again.

        Raises:
            ValueError: The value set is negative or not a number.
        """
        force = self._constraint.max_force
        return inf if force >= UNBOUNDED else force

    @max_force.setter
    def max_force(self, value: float) -> None:
        force = bound_of(value)
        impulse = UNBOUNDED if force >= UNBOUNDED else force * self._world.parameters.substep_time
        self._change_numbers(max_force=force, max_impulse=impulse)

    def remove(self) -> None:
        """Remove it from its world, as `world.remove(constraint)`.

        Raises:
            ValueError: It was removed before.
        """
        world = self._world
        with world.call_lock, uninterrupted:
            for each in self._parts:
                if world.user_constraints.get(each.id) is not each:
                    raise ValueError(f"the constraint {self.name!r} is no longer in its world")
                world.remove_constraint(each)

    @property
    def _parts(self) -> tuple[UserConstraint, ...]:
        """The constraints of the solver that it consists of."""
        return (self._constraint,)

    @property
    def _world(self) -> WorldCore:
        return self._constraint.parent.world

    def _change_numbers(self, **values: Any) -> None:
        """Change numbers of all parts; all at once."""
        change_constraints(self._parts, **values)

    def _forces(self, rows: int) -> np.ndarray:
        return forces_of(self._constraint, rows)


def bound_of(force: float) -> float:
    """A greatest force that users state, `UNBOUNDED` if it is infinite.

    Raises:
        ValueError: It is negative or not a number.
    """
    number = float(force)
    if not number >= 0.0:
        raise ValueError(f"max_force must be at least 0, not {force!r}")
    return min(number, UNBOUNDED)


@gated("parent.world.call_lock")
def forces_of(constraint: UserConstraint, rows: int) -> np.ndarray:
    """Impulse of each row of the last substep per its duration [N or N m]; 0 while disabled."""
    world, result = constraint.parent.world, np.zeros(rows)
    if constraint.enabled:
        impulses = world.user_constraints.impulses(constraint, world.arrays.state)
        result[: len(impulses)] = impulses
    return result / (world.parameters.time_step / max(1, world.parameters.substeps))


def change_constraints(constraints: Sequence[UserConstraint], **values: Any) -> None:
    """Change attributes of constraints of a world, all at once."""
    world = constraints[0].parent.world
    with world.call_lock, uninterrupted:
        change = Change()
        for each in constraints:
            change.set_all(each, **values)
        world.change_constraints(change)
        change.commit()


def yield_as(constraint: UserConstraint, compliance: Compliance) -> None:
    """Let a constraint yield instead of being rigid; before it is put into its world."""
    constraint.reference, constraint.impedance = compliance.reference, compliance.impedance
    constraint.inverse_inertia = compliance.inverse_inertia


def constraints_of(
    world: WorldCore, bodies: Sequence[BodyCore], kinds: Sequence[UserConstraintKind]
) -> list[UserConstraint]:
    """The constraints of some kinds of some bodies of a world."""
    return [
        constraint
        for constraint in (world.user_constraints.all if len(world.user_constraints) else ())
        if constraint.kind in kinds and any(constraint.parent is body for body in bodies)
    ]
