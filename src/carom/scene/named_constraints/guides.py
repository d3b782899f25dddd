"""Constraints that leave one motion: a slide along an axis, and a hinge about one."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.checks import Array
from carom.description.transform import rotate, rotation_matrix
from carom.layouts.codes import UserConstraintKind
from carom.native.gates import gated
from carom.native.products import dots
from carom.pose import Pose
from carom.scene.handles import present_inertial_frame
from carom.scene.named_constraints.connect import Connect, Weld, as_arrays, frame_of
from carom.scene.named_constraints.named_constraint import NamedConstraint
from carom.scene.user_constraints import UserConstraint

SECOND_POINT = "/axis"
"""What the name of a hinge's second point has behind that of the hinge."""
_PARALLEL = 1e-6


class Slide(Weld):
    """Lets a link move along an axis of it, without turning."""

    __slots__ = ()

    kind = "slide"

    @property
    @gated("_constraint.parent.world.call_lock")
    def axis(self) -> Array:
        """Direction of the axis now, a unit vector in world axes, shape (3,)."""
        it = self._constraint
        return np.array(rotate(present_inertial_frame(it.parent, it.parent_link).orientation, it.axis))

    @property
    def position(self) -> float:
        """How far the first link has moved along the axis [m]."""
        return float(dots(super().error, self.axis))

    @property
    def error(self) -> Array:
        """The distance across the axis, in world axes [m], shape (3,)."""
        apart, along = super().error, self.axis
        return apart - dots(apart, along) * along

    @property
    def force(self) -> Array:
        """Force on the first link across the axis in the last substep [N], world axes, shape (3,)."""
        along = self.axis
        # As `kernels.solver.user_constraints.held_directions`.
        columns = np.array(rotation_matrix(self._frames()[0].orientation)).T
        across = np.cross(columns[0], along)
        if np.square(across).sum() <= _PARALLEL**2:
            across = np.cross(columns[1], along)
        across /= np.sqrt(np.square(across).sum())
        forces = self._forces(6)
        return forces[0] * across + forces[1] * np.cross(along, across)

    @property
    def torque(self) -> Array:
        """Torque on the first link in the last substep, in world axes [N m], shape (3,); 0 while disabled."""
        columns = np.array(rotation_matrix(self._frames()[0].orientation))
        forces = self._forces(6)
        return dots(columns, np.array((forces[3], forces[4], forces[2])))


class Hinge(Connect):
    """Lets a link turn about an axis: it holds two points of that."""

    __slots__ = ("_other",)

    kind = "hinge"

    def __init__(self, constraint: UserConstraint, other: UserConstraint) -> None:
        super().__init__(constraint)
        self._other = other

    @property
    def _parts(self) -> tuple[UserConstraint, ...]:
        return self._constraint, self._other

    @property
    @gated("_constraint.parent.world.call_lock")
    def axis(self) -> Array:
        """Direction of the axis now, a unit vector in world axes, shape (3,)."""
        (first, _), (second, _) = self._frames(), Connect(self._other)._frames()
        along = np.subtract(second.position, first.position)
        return along / np.sqrt(np.square(along).sum())

    @property
    def force(self) -> Array:
        """Force on the first link in the last substep, in world axes [N], shape (3,); 0 while disabled."""
        return super().force + Connect(self._other).force

    @property
    def second_frame(self) -> Pose:
        """The frame that its first point is held at, in the second link's frame, or in the world; settable.

        The axis turns with it.
        """
        return super().second_frame

    @second_frame.setter
    def second_frame(self, value: Any) -> None:
        wanted, present, other = frame_of(value), super().second_frame, Connect(self._other)
        along = present.inverse() * other.second_frame
        Connect(self._constraint).second_frame = wanted
        other.second_frame = as_arrays(wanted) * along


def handles_of(constraints: list[UserConstraint]) -> list[NamedConstraint]:
    """The handles of those of a world's constraints that users know, in their order."""
    points = {
        (it.name, it.parent, it.parent_link, it.child, it.child_link): it
        for it in constraints
        if it.kind is UserConstraintKind.POINT_TO_POINT and it.name
    }
    found: list[NamedConstraint] = []
    seconds: set[UserConstraint] = set()
    for it in constraints:
        ends = it.parent, it.parent_link, it.child, it.child_link
        other = points.get((it.name + SECOND_POINT, *ends)) if it.name else None
        if it in seconds:
            continue
        if other is not None and it.kind is UserConstraintKind.POINT_TO_POINT:
            seconds.add(other)
            found.append(Hinge(it, other))
        elif (make := _made(it)) is not None:
            found.append(make)
    return found


def _made(it: UserConstraint) -> NamedConstraint | None:
    """The handle of one constraint; None for those that only the solver, or a script of PyBullet, knows."""
    from carom.scene.named_constraints.joint_coupling import JointCoupling
    from carom.scene.tendons.coupling import TendonCoupling

    kinds: dict[UserConstraintKind, type[NamedConstraint]] = {
        UserConstraintKind.FIXED: Weld,
        UserConstraintKind.POINT_TO_POINT: Connect,
        UserConstraintKind.PRISMATIC: Slide,
        UserConstraintKind.COUPLING: JointCoupling,
        UserConstraintKind.TENDON_COUPLING: TendonCoupling,
    }
    kind = kinds.get(it.kind)
    return None if kind is None else kind(it)
