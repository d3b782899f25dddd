"""The joint constraints of a world, in the order in which the solver visits them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from carom.layouts.codes import LIMIT_KIND, MOTOR_KIND, WITH_FRICTION, ConstraintKind, JointCode
from carom.model.builder import WorldArrays
from carom.model.link_dynamics import DEFAULT_LIMIT_IMPULSE
from carom.model.solver_order import IslandTags, remove_unordered
from carom.native.change import Change
from carom.scene.actuators.actuated_joint import actuated_joint, drives_joint
from carom.scene.constraint_rows import ConstraintRows

if TYPE_CHECKING:
    from carom.description.compliance import Compliance, Four
    from carom.scene.core.body_core import BodyCore
    from carom.scene.user_constraints import UserConstraint

NONE: Four = (0.0, 0.0, 0.0, 0.0)


@dataclass(repr=False, eq=False, slots=True)
class JointConstraint:
    """A motor, a limit, the friction or an actuator of one joint, or a user constraint.

    Attributes:
        body: The body it acts on.
        joint: Index of the joint.
        kind: The type of the constraint.
        lower: Lower limit; swing range about x of a spherical joint [rad or m].
        upper: Upper limit; swing range about y of a spherical joint [rad or m]; greatest force of friction.
        twist: Twist range of a spherical joint [rad].
        user: The user constraint, if it is one.
        max_impulse: Maximum impulse of a limit per substep.
        actuator: Number among the actuators of the body, if it is one.
        reference: Of a limit or friction that yields, see `carom.description.compliance`.
        impedance: Likewise; 0 if it is rigid.
        margin: Distance from a limit at which it begins to act [rad or m].
    """

    body: BodyCore
    joint: int
    kind: ConstraintKind
    lower: float = 0.0
    upper: float = 0.0
    twist: float = 0.0
    user: UserConstraint | None = None
    max_impulse: float = DEFAULT_LIMIT_IMPULSE
    actuator: int = 0
    reference: Four = NONE
    impedance: Four = NONE
    margin: float = 0.0

    def yield_as_described(self) -> None:
        """Let a limit, or friction that the joint had from the start, yield as its description says."""
        if self.user is not None or self.kind not in (ConstraintKind.LIMIT, ConstraintKind.FRICTION):
            return
        link = self.body.spec.links[self.joint]
        compliance: Compliance | None = None
        if self.kind == ConstraintKind.LIMIT:
            compliance, self.margin = link.limit_compliance, link.limit_margin
        elif link.friction > 0.0:
            compliance = link.friction_compliance
        if compliance is not None:
            self.reference, self.impedance = compliance.reference, compliance.impedance

    @property
    def sorted_with(self) -> BodyCore:
        """The body with whose rows it is sorted: `body`, or that at the other end if it ties a still link."""
        other = None if self.user is None else self.user.child
        if self.user is None or other is None or other is self.body:
            return self.body
        return self.body if island_links(self.body)[self.user.parent_link + 1] else other


class JointConstraints:
    """The motors, limits and user constraints of a world.

    Attributes:
        all: All constraints; the solver's order depends on the order of this list.
        tags: The numbers of the islands, which depend on the order of its list of links.
        rows: Their rows in the arrays.
    """

    def __init__(self) -> None:
        self.all: list[JointConstraint] = []
        self.tags: IslandTags = IslandTags()
        self.rows: ConstraintRows = ConstraintRows()

    def add_body(self, change: Change, body: BodyCore) -> None:
        """Append the limits, the motors, the friction, then the actuators, of a new body with a change.

        A body that is read as PyBullet reads it has no friction.
        """
        self.tags.add(change, body.id, island_links(body))
        added: list[JointConstraint] = []
        for joint, (link, code) in enumerate(zip(body.spec.links, body.joint_types, strict=True)):
            if LIMIT_KIND.get(code) == ConstraintKind.SPHERICAL_LIMIT:
                if link.lower > 0.0 and link.upper > 0.0 and link.twist > 0.0 and link.effort > 0.0:
                    added.append(
                        JointConstraint(
                            body,
                            joint,
                            ConstraintKind.SPHERICAL_LIMIT,
                            link.lower,
                            link.upper,
                            link.twist,
                            max_impulse=link.effort,
                        )
                    )
            elif link.limited:
                limit = JointConstraint(body, joint, ConstraintKind.LIMIT, link.lower, link.upper)
                if link.limit_compliance is not None or link.limit_margin != limit.margin:
                    limit.yield_as_described()
                added.append(limit)
        for joint, code in enumerate(body.joint_types):
            if code in MOTOR_KIND:
                added.append(JointConstraint(body, joint, MOTOR_KIND[code]))
        if not body.spec.is_held:
            for joint, (link, code) in enumerate(zip(body.spec.links, body.joint_types, strict=True)):
                if code in WITH_FRICTION and link.friction > 0.0:
                    friction = JointConstraint(body, joint, ConstraintKind.FRICTION, upper=link.friction)
                    friction.yield_as_described()
                    added.append(friction)
        for number, actuator in enumerate(body.spec.actuators):
            if not drives_joint(actuator):
                continue
            joint = actuated_joint(body, actuator)
            added.append(JointConstraint(body, joint, ConstraintKind.ACTUATOR, actuator=number))
        change.extend(self.all, added)

    def remove(self, change: Change, body: BodyCore) -> None:
        """Remove the constraints of a body, the last first, with a change."""
        kept = self.all.copy()
        for constraint in reversed(self.all):
            if constraint.body is body or (constraint.user is not None and constraint.user.child is body):
                remove_unordered(kept, constraint)
        change.set(self, "all", kept)
        self.tags.remove(change, body.id, 1 + body.joint_count)

    def set_limit(
        self, change: Change, body: BodyCore, joint: int, lower: float, upper: float
    ) -> JointConstraint | None:
        """Set, add or (with lower > upper) remove the limit of a joint with a change.

        Of several in one change those that are removed come first.

        Returns:
            The limit that there will be.
        """
        limit = self.limit_of(body, joint)
        known: list[JointConstraint] = change.get(self, "all")
        if lower > upper:
            if limit is not None:
                change.set(self, "all", _all_but(known, limit))
            return None
        if limit is None:
            limit = JointConstraint(body, joint, ConstraintKind.LIMIT, lower, upper)
            if known is self.all:
                change.extend(known, [limit])
            else:
                change.set(self, "all", [*known, limit])
        else:
            change.set(limit, "lower", lower)
            change.set(limit, "upper", upper)
        return limit

    def add_user(self, change: Change, user: UserConstraint) -> None:
        """Append a user constraint with a change."""
        constraint = JointConstraint(user.parent, user.parent_link, ConstraintKind.USER, user=user)
        change.extend(self.all, [constraint])
        self.rows.note(change, constraint, added=True)

    def add_successor(self, change: Change, user: UserConstraint) -> None:
        """The same; it takes the row of the one removed last, see `ConstraintRows.awaits_successor`."""
        constraint = JointConstraint(user.parent, user.parent_link, ConstraintKind.USER, user=user)
        change.extend(self.all, [constraint])
        self.rows.note_successor(change, constraint)

    def remove_user(self, change: Change, user: UserConstraint) -> None:
        """Remove a user constraint with a change."""
        for constraint in reversed(self.all):
            if constraint.user is user:
                change.set(self, "all", _all_but(self.all, constraint))
                self.rows.note(change, constraint, added=False)
                return

    def _is_active(self, constraint: JointConstraint) -> bool:
        """Whether a constraint has a row; user constraints are sorted even if they tie what cannot move."""
        return constraint.user is not None or constraint.body.id in self.tags.tags()

    def _moving_links(self) -> list[tuple[int, int]]:
        """Body and link (the base is 0) of all links that can move, as Bullet numbers them."""
        return cast("list[tuple[int, int]]", self.tags.moving_links)

    def limit_of(self, body: BodyCore, joint: int) -> JointConstraint | None:
        """The limit of a revolute or prismatic joint, if it has one."""
        for constraint in self.all:
            if (
                constraint.body is body
                and constraint.joint == joint
                and constraint.kind == ConstraintKind.LIMIT
            ):
                return constraint
        return None

    def free_base(self, change: Change, body: BodyCore, *, free: bool) -> None:
        """Renumber the islands with a change that frees or fixes the base of a body."""
        self.tags.move_base_to_end(change, body.id, island_links(body, free=free))

    def write(
        self,
        arrays: WorldArrays,
        bodies: Mapping[int, BodyCore],
        user_rows: dict[int, int],
        minimum_island_size: int,
    ) -> None:
        """Bring the rows of the constraints, and the numbers of links, up to date.

        Args:
            arrays: The arrays of the world.
            bodies: All bodies, by number.
            user_rows: Row of each user constraint, by number.
            minimum_island_size: Islands are merged until they have more constraints than this.
        """
        if self.rows.update(arrays, user_rows):
            return
        numbers = [-1] * arrays.used["link"]
        for number, (body, link) in enumerate(self._moving_links()):
            numbers[bodies[body].first_link + link] = number
        arrays.model.numpy["link_number"][: len(numbers)] = numbers
        active = [constraint for constraint in self.all if self._is_active(constraint)]
        self.rows.sort(arrays, active, self.tags.tags(), user_rows, minimum_island_size)


def moving_links(body: BodyCore, *, free: bool | None = None) -> list[bool]:
    """Which links, base first, are not rigidly connected to a fixed base.

    `free` says whether the base is free, if it is not to be as it is now.
    """
    moving = [not body.fixed_base if free is None else free]
    for link, code in zip(body.spec.links, body.joint_types, strict=True):
        moving.append(moving[link.parent + 1] or code != JointCode.FIXED)
    return moving


def island_links(body: BodyCore, *, free: bool | None = None) -> list[bool]:
    """Which links, base first, belong to islands; `free` is as for `moving_links`.

    For bodies that are read as written these are `moving_links`. Bullet decides when it loads a body which
    links are still, and freeing or fixing the base later changes that for the base alone: none if the base
    was free, else those on fixed joints that lead to the base or, as its search ends there, to the first
    link, whether this moves or not. Contacts and constraints of links that count as still with what cannot
    move have no effect.
    """
    if not body.spec.is_held:
        return moving_links(body, free=free)
    base_moves = not body.fixed_base if free is None else free
    if not body.spec.fixed_base:
        return [base_moves, *[True] * body.joint_count]
    moving = moving_links(body, free=False)
    still = [True]
    for link, code in zip(body.spec.links[1:], body.joint_types[1:], strict=True):
        still.append(code == JointCode.FIXED and link.parent >= 0 and still[link.parent])
    # The first link itself moves if its joint does.
    still[0] = False
    links = [moves and not is_still for moves, is_still in zip(moving[1:], still, strict=False)]
    return [base_moves, *links]


def _all_but(known: list[JointConstraint], constraint: JointConstraint) -> list[JointConstraint]:
    kept = known.copy()
    remove_unordered(kept, constraint)
    return kept
