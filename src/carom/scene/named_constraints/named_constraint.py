"""What named constraints of a world have in common: their name, whether they hold, and their impulses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description.compliance import Compliance
from carom.layouts.codes import UserConstraintKind
from carom.native.change import Change
from carom.native.gates import alone
from carom.native.uninterrupted import uninterrupted
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

UNBOUNDED = 1e30
"""Greatest impulse of each row of a named constraint per substep [N s or N m s]; no solver gets there."""


class NamedConstraint:
    """A constraint of a file, or of the modern API, that can be switched off and on."""

    __slots__ = ("_constraint",)

    def __init__(self, constraint: UserConstraint) -> None:
        self._constraint = constraint

    @property
    def name(self) -> str:
        """Name in the file; in URDF files of `<mimic>` that of the joint."""
        return self._constraint.name

    @property
    def enabled(self) -> bool:
        """Whether it holds; settable. Where it is switched on again, it pulls what it constrains back."""
        return self._constraint.enabled

    @enabled.setter
    def enabled(self, value: bool) -> None:
        if self._constraint.enabled != bool(value):
            change_constraint(self._constraint, enabled=bool(value))

    def _forces(self, rows: int) -> np.ndarray:
        return forces_of(self._constraint, rows)


@alone("parent.world.call_lock")
def forces_of(constraint: UserConstraint, rows: int) -> np.ndarray:
    """Impulse of each row of the last substep per its duration [N or N m]; 0 while disabled."""
    world, result = constraint.parent.world, np.zeros(rows)
    if constraint.enabled:
        impulses = world.user_constraints.impulses(constraint, world.arrays.state)
        result[: len(impulses)] = impulses
    return result / (world.parameters.time_step / max(1, world.parameters.substeps))


@alone("parent.world.call_lock")
def change_constraint(constraint: UserConstraint, **values: Any) -> None:
    """Change attributes of a constraint, all at once."""
    with constraint.parent.world.call_lock, uninterrupted:
        world, change = constraint.parent.world, Change()
        change.set_all(constraint, **values)
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
