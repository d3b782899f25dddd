"""User constraints between two links, or a link and the world."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.engine.contact_arrays import ContactArrays
from carom.layouts.codes import UserConstraintKind
from carom.native.tables import ArrayTable
from carom.record import record

if TYPE_CHECKING:
    from carom.scene.body import Body

# An impulse per substep, as in Bullet, until a force is set.
DEFAULT_MAX_IMPULSE = 500.0
ROWS = {
    UserConstraintKind.POINT_TO_POINT: 3,
    UserConstraintKind.FIXED: 6,
    UserConstraintKind.PRISMATIC: 5,
    UserConstraintKind.GEAR: 1,
}


@record(frozen=False, eq=False, hot=True)
class UserConstraint:
    """A user constraint.

    Attributes:
        id: Number of the constraint in its world.
        kind: Its type.
        parent: First body.
        parent_link: Its link; -1 is the base.
        child: Second body; None for the world.
        child_link: Its link; -1 is the base.
        axis: Axis of a prismatic constraint in the inertial frame of the parent's link.
        parent_frame: Pivot and axes in the inertial frame of the parent's link.
        child_frame: The same for the child; in world axes without a child.
        max_impulse: Maximum impulse of each row per substep.
        max_force: Maximum force as last set by users [N or N m].
        gear_ratio: The joint velocity of the parent is minus this times that of the child; 0 stands for 1.
        gear_auxiliary_link: Link of the parent whose joint's motion is subtracted; -1 for none.
        relative_position_target: Target of the sum of the gear's joint positions [rad].
        erp: Share of a gear's position error corrected per substep; 0 corrects velocities only.
        enabled: Whether it is active.
    """

    id: int
    kind: UserConstraintKind
    parent: Body
    parent_link: int
    child: Body | None
    child_link: int
    axis: Vector3 = (0.0, 0.0, 0.0)
    parent_frame: Pose = IDENTITY
    child_frame: Pose = IDENTITY
    max_impulse: float = DEFAULT_MAX_IMPULSE
    max_force: float = DEFAULT_MAX_IMPULSE
    gear_ratio: float = 0.0
    gear_auxiliary_link: int = -1
    relative_position_target: float = 0.0
    erp: float = 0.0
    enabled: bool = True


class UserConstraints:
    """The user constraints of a world, by number.

    Attributes:
        next_id: Number of the next one.
    """

    def __init__(self) -> None:
        self._by_id: dict[int, UserConstraint] = {}
        self.next_id: int = 1
        self._next_hidden_id = -1

    def __len__(self) -> int:
        return len(self.all)

    @property
    def all(self) -> list[UserConstraint]:
        """All constraints that are not hidden, in order of creation."""
        return [constraint for number, constraint in self._by_id.items() if number > 0]

    def get(self, constraint_id: int) -> UserConstraint | None:
        """The constraint with a number, or None."""
        return self._by_id.get(constraint_id)

    def add(
        self,
        kind: UserConstraintKind,
        parent: Body,
        parent_link: int,
        child: Body | None,
        child_link: int,
        axis: Vector3,
        parent_frame: Pose,
        child_frame: Pose,
        *,
        hidden: bool = False,
    ) -> UserConstraint:
        """Create a constraint; see `UserConstraint` for the arguments.

        A hidden constraint, such as that of the mouse in the viewer, has a negative number, so that the
        numbers of other constraints do not change.
        """
        number = self._next_hidden_id if hidden else self.next_id
        if hidden:
            self._next_hidden_id -= 1
        else:
            self.next_id += 1
        constraint = UserConstraint(
            number, kind, parent, parent_link, child, child_link, axis, parent_frame, child_frame
        )
        self._by_id[number] = constraint
        return constraint

    def take_id(self) -> int:
        """Reserve the next number for the anchor of a soft body, which is not a constraint between links."""
        self.next_id += 1
        return self.next_id - 1

    def put(self, constraint: UserConstraint) -> None:
        """Add a constraint with its own number; later ones get higher numbers."""
        self._by_id[constraint.id] = constraint
        self.next_id = max(self.next_id, constraint.id + 1)

    def discard(self, constraint_id: int) -> None:
        """Remove the constraint with a number, if it exists."""
        self._by_id.pop(constraint_id, None)

    def way_back(self) -> Callable[[], None]:
        """A function that removes everything that is added from now on."""
        count, numbers = len(self._by_id), (self.next_id, self._next_hidden_id)

        def go_back() -> None:
            while len(self._by_id) > count:
                self._by_id.popitem()
            self.next_id, self._next_hidden_id = numbers

        return go_back

    def removal(self, body: Body) -> Callable[[], None]:
        """Prepare to remove every constraint of a body.

        Returns:
            A function that removes them; it can be called again if it was interrupted.
        """
        kept = {
            number: constraint
            for number, constraint in self._by_id.items()
            if body is not constraint.parent and body is not constraint.child
        }

        def remove() -> None:
            self._by_id = kept

        return remove

    @property
    def rows(self) -> dict[int, int]:
        """Row of each constraint in the arrays of the engine, by number."""
        # The numbers are copied at once, because the viewer's thread may add a constraint in the meantime.
        return {number: row for row, number in enumerate(tuple(self._by_id))}

    def write(self, contact_arrays: ContactArrays) -> None:
        """Write all constraints to the arrays of the engine."""
        contact_arrays.user_count = len(self._by_id)
        contact_arrays.users.reserve({"user": contact_arrays.user_count})
        users = contact_arrays.users.numpy
        for row, constraint in enumerate(self._by_id.values()):
            child = constraint.child
            users["user_kind"][row] = constraint.kind
            users["user_tree_a"][row] = constraint.parent.rows.tree
            users["user_link_a"][row] = constraint.parent.first_link + 1 + constraint.parent_link
            users["user_tree_b"][row] = -1 if child is None else child.rows.tree
            users["user_link_b"][row] = -1 if child is None else child.first_link + 1 + constraint.child_link
            users["user_pivot_a"][row] = constraint.parent_frame.position
            users["user_pivot_b"][row] = constraint.child_frame.position
            users["user_frame_a"][row] = constraint.parent_frame.orientation
            users["user_frame_b"][row] = constraint.child_frame.orientation
            users["user_axis"][row] = constraint.axis
            users["user_max_impulse"][row] = constraint.max_impulse
            users["user_gear_ratio"][row] = constraint.gear_ratio or 1.0
            auxiliary = constraint.gear_auxiliary_link
            users["user_gear_auxiliary"][row] = (
                constraint.parent.first_link + 1 + auxiliary if auxiliary >= 0 else -1
            )
            users["user_relative_target"][row] = constraint.relative_position_target
            users["user_erp"][row] = constraint.erp
            users["user_enabled"][:, row] = constraint.enabled
        contact_arrays.forget_order()

    def impulses(self, constraint: UserConstraint, state: ArrayTable) -> np.ndarray:
        """Impulses of a constraint's rows in the last substep, shape (rows,)."""
        row = self.rows[constraint.id]
        return state.numpy["user_impulse"][0, row, : ROWS[constraint.kind]].copy()
