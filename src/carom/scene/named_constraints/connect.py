"""Named constraints between two links, or a link and the world: connected at a point, or welded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose, conjugate, inverse, multiplied, rotation_matrix
from carom.layouts.codes import UserConstraintKind
from carom.native.gates import gated
from carom.native.products import dots, length
from carom.native.trigonometry import atan2
from carom.pose import Pose as WorldPose
from carom.pose import numbers_of
from carom.scene.handles import present_inertial_frame
from carom.scene.named_constraints.named_constraint import UNBOUNDED, NamedConstraint, constraints_of
from carom.scene.named_constraints.owners import handle_of
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore
    from carom.scene.link import Link


class Connect(NamedConstraint):
    """Holds a point of a link at a point of another one, or of the world, as a ball joint does."""

    __slots__ = ()

    kind = "point"

    def __repr__(self) -> str:
        second = "the world" if self.second is None else repr(self.second.name)
        state = "" if self.enabled else ", disabled"
        return f"<{type(self).__name__} {self.name!r}: {self.first.name!r} to {second}{state}>"

    @property
    def first(self) -> Link:
        """The first link."""
        return handle_of(self._constraint.parent).links[self._constraint.parent_link]

    @property
    def second(self) -> Link | None:
        """The second link; None for the world."""
        return (
            None
            if self._constraint.child is None
            else handle_of(self._constraint.child).links[self._constraint.child_link]
        )

    @property
    def first_frame(self) -> WorldPose:
        """Its frame on the first link, in that link's frame."""
        it = self._constraint
        return as_arrays(compose(it.parent.link_inertial_frame(it.parent_link), it.parent_frame))

    @property
    def second_frame(self) -> WorldPose:
        """The frame that it is held at, in the second link's frame, or in the world; settable.

        Whoever moves it moves what it holds: as a hand does, or a mouse.

        Raises:
            ValueError: What is set is no pose, or a number is not finite.
        """
        it = self._constraint
        if it.child is None:
            return as_arrays(it.child_frame)
        return as_arrays(compose(it.child.link_inertial_frame(it.child_link), it.child_frame))

    @second_frame.setter
    def second_frame(self, value: Any) -> None:
        it, frame = self._constraint, frame_of(value)
        if it.child is not None:
            frame = from_centre(it.child, it.child_link, frame)
        self._change_numbers(child_frame=frame)

    @property
    def error(self) -> np.ndarray:
        """Position of the point of the first link minus that of the second, in the world [m], shape (3,)."""
        first, second = self._frames()
        return np.subtract(first.position, second.position)

    @property
    def force(self) -> np.ndarray:
        """Force on the first link in the last substep, in world axes [N], shape (3,); 0 while disabled."""
        return self._forces(6)[:3].copy()

    @gated("_constraint.parent.world.call_lock")
    def _frames(self) -> tuple[Pose, Pose]:
        """World poses of the frames that coincide where it holds."""
        it = self._constraint
        first = compose(present_inertial_frame(it.parent, it.parent_link), it.parent_frame)
        if it.child is None:
            return first, it.child_frame
        return first, compose(present_inertial_frame(it.child, it.child_link), it.child_frame)


class Weld(Connect):
    """Holds a frame of a link at a frame of another one, or of the world."""

    __slots__ = ()

    kind = "fixed"

    @property
    def angle_error(self) -> float:
        """Angle between the axes of both frames [rad]."""
        first, second = self._frames()
        x, y, z, w = multiplied(conjugate(second.orientation), first.orientation)
        return 2.0 * atan2(length(np.array((x, y, z))), abs(w))

    @property
    def torque(self) -> np.ndarray:
        """Torque on the first link in the last substep, in world axes [N m], shape (3,); 0 while disabled."""
        first, second = self._frames()
        forces = self._forces(6)[3:]
        if not self._constraint.impedance[1] > 0.0:
            return dots(np.array(rotation_matrix(first.orientation)), forces)
        # As `kernels.solver.user_constraints.held_turn`.
        between = multiplied(conjugate(second.orientation), first.orientation)
        x, y, z, w = between if between[3] >= 0.0 else tuple(-it for it in between)
        axes = np.array(((w, -z, y), (z, w, -x), (-y, x, w)))
        return dots(np.array(rotation_matrix(second.orientation)), dots(axes, forces))


def new_connection(
    name: str,
    first: tuple[BodyCore, int, Pose],
    second: tuple[BodyCore, int, Pose] | None,
    fixed_frame: Pose = IDENTITY,
    *,
    is_weld: bool,
) -> UserConstraint:
    """The constraint between two links, to be put into their world.

    Args:
        name: Its name.
        first: A body, its link (-1 is the base), and a frame in that link's frame.
        second: The same of the other one; None for the world.
        fixed_frame: The frame in the world without another link.
        is_weld: Axes coincide as well as origins.
    """
    body, link, frame = first
    kind = UserConstraintKind.FIXED if is_weld else UserConstraintKind.POINT_TO_POINT
    child, child_link, child_frame = (None, -1, fixed_frame)
    if second is not None:
        child, child_link, child_frame = second[0], second[1], from_centre(*second)
    constraint = body.world.user_constraints.new(
        kind, body, link, child, child_link, (0.0, 0.0, 0.0), from_centre(body, link, frame), child_frame
    )
    constraint.name = name
    constraint.max_impulse = constraint.max_force = UNBOUNDED
    return constraint


def from_centre(body: BodyCore, link: int, frame: Pose) -> Pose:
    """A frame in a link's frame as one in its inertial frame."""
    return compose(inverse(body.link_inertial_frame(link)), frame)


def as_arrays(frame: Pose) -> WorldPose:
    """A frame as users get it."""
    return WorldPose(frame.position, frame.orientation)


def frame_of(given: Any) -> Pose:
    """A frame from what users give as a pose.

    Raises:
        ValueError: It is none, or its quaternion is 0.
    """
    place, turn = numbers_of(given)
    if place.shape != (3,) or turn.shape != (4,) or not turn.any():
        raise ValueError(f"a frame is one pose, a position and a quaternion other than 0, not {given!r}")
    x, y, z = place.tolist()
    i, j, k, w = (turn / length(turn)).tolist()
    return Pose((x, y, z), (i, j, k, w))


def connections_of(world: WorldCore, bodies: Sequence[BodyCore]) -> list[Connect]:
    """The named connections of some bodies of a world."""
    kinds = {UserConstraintKind.FIXED: Weld, UserConstraintKind.POINT_TO_POINT: Connect}
    return [
        kinds[constraint.kind](constraint)
        for constraint in constraints_of(world, bodies, tuple(kinds))
        if constraint.name
    ]
