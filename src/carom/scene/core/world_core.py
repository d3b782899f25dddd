"""A world as everything below it knows it: its data, time, steps, and questions about it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from weakref import ref

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.layouts.codes import UserConstraintKind
from carom.model.body_spec import BASE
from carom.native.change import Change, first_change
from carom.native.gates import gated
from carom.scene.core.stepping import Stepping
from carom.scene.handles import world_of
from carom.scene.user_constraints import UserConstraint, user_constraint_kind

if TYPE_CHECKING:
    from carom.engine.queries.queries import Queries
    from carom.scene.core.body_core import BodyCore


class WorldCore(Stepping):
    """What a world is without what loads, saves, records and linearises it; `World` describes the attributes.

    Functions that work on worlds and are used by methods of `World` take this class.
    """

    _kept_linearization: dict[Any, Any] | None = None

    @property
    def kept_linearization(self) -> dict[Any, Any]:
        """What is kept for the next call of `linearize`, by its type. It refers to bodies of the world."""
        if self._kept_linearization is None:
            self._kept_linearization = {}
        return self._kept_linearization

    def queries(self) -> Queries:
        """Rays, nearest points and overlaps for the present coordinates."""
        return self._derived.queries or self._new_queries()

    @gated("call_lock")
    def _new_queries(self) -> Queries:
        if self._derived.queries is None:
            from carom.engine.queries.queries import Queries

            self._derived.queries = Queries(
                self.call_lock,
                ref(self),
                self._kernel_structs(),
                self.position_memory,
                self.link_places,
                self.contact_arrays,
                self.engine.workspace.pairs,
                self.arrays,
                self.engine.workspace.soft_work,
                self.quick,
            )
        return self._derived.queries

    # Constraints

    @gated("call_lock", commits=True)
    def constrain_links(
        self,
        kind: UserConstraintKind | str,
        parent: BodyCore,
        parent_link: int | str = BASE,
        child: BodyCore | None = None,
        child_link: int | str = BASE,
        *,
        axis: Vector3 = (0.0, 0.0, 0.0),
        parent_frame: Pose = IDENTITY,
        child_frame: Pose = IDENTITY,
        hidden: bool = False,
    ) -> UserConstraint:
        """Constrain a link to another, or to the world.

        Args:
            kind: "fixed" (no motion between the frames), "point" (their origins stay together), "slide" (they
                move along `axis` only) or "gear" (the joints of both links turn together, as
                `UserConstraint.gear_ratio` says).
            parent: A body.
            parent_link: Its link by index (-1 is the base) or name.
            child: The other body; None for the world.
            child_link: Its link, likewise.
            axis: Of "slide", in the inertial frame of the parent's link.
            parent_frame: Frame in the inertial frame of the parent's link.
            child_frame: Frame in the inertial frame of the child's link, or in the world.
            hidden: It is not among `user_constraints.all`.

        Raises:
            ValueError: There is no such kind, or one of the bodies is no longer in the world.
            IndexError, KeyError: There is no such link.
        """
        kind = user_constraint_kind(kind)
        places = (parent, parent.link_number(parent_link), child, BASE)
        if child is not None:
            places = (*places[:3], child.link_number(child_link))
        frames = (axis, parent_frame, child_frame)
        change = first_change()
        # Its number is the next one until it has been added.
        constraint = self.user_constraints.new(kind, *places, *frames, hidden=hidden)
        self.note_constraint(change, constraint)
        change.commit()
        return constraint

    @gated("call_lock", commits=True)
    def add_constraint(self, constraint: UserConstraint) -> None:
        """Add a constraint that `user_constraints.new` has made for a body of this world.

        Raises:
            ValueError: One of its bodies is no longer in the world.
        """
        change = first_change()
        self.note_constraint(change, constraint)
        change.commit()

    def note_constraint(self, change: Change, constraint: UserConstraint) -> None:
        """The same with a change, in which nothing else has been noted."""
        world_of(constraint.parent)
        if constraint.child is not None:
            world_of(constraint.child)
        self.user_constraints.put(change, constraint)
        removed = self._derived.removed
        if removed is None or not self._note_successor(change, removed, constraint):
            self.joint_constraints.add_user(change, constraint)
            self.change_constraints(change)

    def _note_successor(self, change: Change, removed: UserConstraint, constraint: UserConstraint) -> bool:
        """With a change, let a constraint take the rows of one removed since the last step, if it can.

        Then all is as it was for that step: it is prepared already.
        """
        if (
            constraint.parent is not removed.parent
            or constraint.parent_link != removed.parent_link
            or constraint.child is not removed.child
            or constraint.child_link != removed.child_link
            or not self.joint_constraints.rows.awaits_successor(removed)
            or not self.engine.is_as_before
            or not self.user_constraints.note_successor(
                change, removed, constraint, self.contact_arrays, self.arrays.state
            )
        ):
            return False
        self.joint_constraints.add_successor(change, constraint)
        self.engine.note_as_before(change)
        self.quick.note_resumed_step(change)
        change.set_all(self._derived, step=self._derived.step_before, removed=None)
        return True

    @gated("call_lock", commits=True)
    def remove_constraint(self, constraint: UserConstraint) -> None:
        """Remove a user constraint."""
        change = first_change()
        self.note_no_constraint(change, constraint)
        change.commit()

    def note_no_constraint(self, change: Change, constraint: UserConstraint) -> None:
        """The same with a change."""
        self.user_constraints.discard(change, constraint.id)
        self.joint_constraints.remove_user(change, constraint)
        self.change_constraints(change)
        if self._derived.step is not None:
            change.set(self._derived, "removed", constraint)
