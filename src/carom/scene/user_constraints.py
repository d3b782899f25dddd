"""User constraints between two links, or a link and the world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description.pose import IDENTITY, Pose, Vector3
from carom.engine.contact_arrays import ContactArrays
from carom.layouts.codes import UserConstraintKind
from carom.native.change import Change
from carom.native.tables import ArrayTable

if TYPE_CHECKING:
    from carom.description.tendon import Path, TendonLook
    from carom.scene.core.body_core import BodyCore

# An impulse per substep, as in Bullet, until a force is set.
DEFAULT_MAX_IMPULSE = 500.0
# Of tendons the last one is of a second limit, if both act at once.
ROWS = {
    UserConstraintKind.POINT_TO_POINT: 3,
    UserConstraintKind.FIXED: 6,
    UserConstraintKind.PRISMATIC: 5,
    UserConstraintKind.GEAR: 1,
    UserConstraintKind.COUPLING: 1,
    UserConstraintKind.TENDON: 4,
    UserConstraintKind.TENDON_COUPLING: 1,
    UserConstraintKind.TRANSMISSION: 1,
    UserConstraintKind.BASE_FRICTION: 6,
}
_MAX_ROWS = 6
_ROW_BYTES = 8 * _MAX_ROWS
_NO_IMPULSES = (0.0,) * _MAX_ROWS
# Fields of `carom.layouts.pair_rows.UserConstraints`, without the one that each world has for itself.
_FIELDS = (
    "user_kind",
    "user_tree_a",
    "user_link_a",
    "user_tree_b",
    "user_link_b",
    "user_max_impulse",
    "user_gear_ratio",
    "user_gear_auxiliary",
    "user_relative_target",
    "user_polynomial",
    "user_erp",
    "user_reference",
    "user_impedance",
    "user_inverse_inertia",
    "user_pivot_a",
    "user_pivot_b",
    "user_frame_a",
    "user_frame_b",
    "user_axis",
    "user_first_path",
    "user_path_count",
    "user_second_path",
    "user_actuator",
    "user_is_wrench",
    "user_spring",
    "user_armature",
    "user_range",
)
_KINDS_BY_NAME = {
    "fixed": UserConstraintKind.FIXED,
    "point": UserConstraintKind.POINT_TO_POINT,
    "slide": UserConstraintKind.PRISMATIC,
    "gear": UserConstraintKind.GEAR,
}
# The places in a row of attributes that are numbers.
_PLACES = {
    "max_impulse": _FIELDS.index("user_max_impulse"),
    "gear_ratio": _FIELDS.index("user_gear_ratio"),
    "relative_position_target": _FIELDS.index("user_relative_target"),
    "erp": _FIELDS.index("user_erp"),
}
_PIVOT, _FRAME = _FIELDS.index("user_pivot_b"), _FIELDS.index("user_frame_b")
# All places of numbers in a row, which can change while what a step consists of stays.
_NUMBERS = {
    *_PLACES.values(),
    *map(_FIELDS.index, ("user_pivot_a", "user_pivot_b", "user_frame_a", "user_frame_b", "user_axis")),
}
_FIRST_PATH = _FIELDS.index("user_first_path")
# Those that are not in a row.
_NOT_IN_ROWS = {"max_force"}
# Those that can change in a row by themselves.
_CHANGES = {*_PLACES, *_NOT_IN_ROWS, "child_frame"}
# Those of parts of paths.
_PATH_FIELDS = (
    "path_kind",
    "path_link",
    "path_point",
    "path_turn",
    "path_size",
    "path_has_side",
    "path_side_link",
    "path_side_point",
)
# Terms of a row whose contents are not known.
_UNKNOWN = (None,) * (1 + len(_FIELDS))


def user_constraint_kind(kind: UserConstraintKind | str) -> UserConstraintKind:
    """A kind of constraint that users make, from its name or PyBullet's number.

    Raises:
        ValueError: There is no such kind.
    """
    for name, known in _KINDS_BY_NAME.items():
        if kind in (name, known):
            return known
    raise ValueError(f"there is no kind of constraint {kind!r}; expected one of {', '.join(_KINDS_BY_NAME)}")


@dataclass(eq=False, slots=True)
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
            Of a weld that yields: what an angle counts beside a distance, see
            `kernels.solver.user_constraints.length_of_turn`.
        gear_auxiliary_link: Link of the parent whose joint's motion is subtracted; -1 for none.
        relative_position_target: Target of the sum of the gear's joint positions [rad]; of a coupling, the
            position of the parent's joint if that of the child's is 0.
        polynomial: Of a coupling: factors of the position of the child's joint, its square, cube and fourth
            power, in the position of the parent's joint. Of a tendon: stiffness per stretch, and per its
            square.
        erp: Share of a gear's position error corrected per substep; 0 corrects velocities only.
        enabled: Whether it is active.
        name: Name in the file it comes from.
        path: Of tendons, and of actuators of tendons and sites: parts of a path, with poses in the inertial
            frames of links of the parent.
        second_path: The path of the leader of two coupled tendons; the site in whose axes an actuator acts.
        actuator: Number of the actuator of a transmission among those of the parent.
        is_wrench: Whether a transmission is to a site.
        spring: Of a tendon: stiffness, damping, and the lengths between which it is slack. Of a transmission
            to a site: force along its axes, per force of the actuator.
        armature: Of a tendon: inertia along it.
        range: Of a tendon: least and greatest length, friction, margin. Of coupled ones: the lengths from
            which both are counted. Of a transmission to a site: torque about its axes. Of friction of a base:
            its greatest force and torque, in the place of that of a tendon.
        reference: Of a compliant constraint: time constant and damping ratio, or minus stiffness and damping;
            midpoint and power of the impedance's curve.
        impedance: Of a compliant constraint: least and greatest impedance, width, and the inverse mass for
            which it yields, 0 for that at the time; 0 for a rigid one.
        inverse_inertia: Likewise, of its rows about axes.
        look: Of a tendon: how it is drawn; None as windows like it.
    """

    id: int
    kind: UserConstraintKind
    parent: BodyCore
    parent_link: int
    child: BodyCore | None
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
    polynomial: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    name: str = ""
    path: Path = ()
    second_path: Path = ()
    actuator: int = -1
    is_wrench: bool = False
    spring: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    range: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    reference: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    impedance: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    inverse_inertia: float = 0.0
    armature: float = 0.0
    look: TendonLook | None = None

    @property
    def both_paths(self) -> Path:
        """The parts of its path and of the second one."""
        return (*self.path, *self.second_path)

    def path_terms(self) -> list[tuple[Any, ...]]:
        """The values of the rows of its path's parts, of `_PATH_FIELDS`."""
        if not (parts := self.both_paths):
            return []
        from carom.description.tendon import WORLD

        base = self.parent.first_link + 1
        return [
            (
                part.kind,
                -1 if part.link == WORLD else base + part.link,
                part.pose.position,
                part.pose.orientation,
                part.size,
                part.side is not None,
                -1 if part.side_link == WORLD else base + part.side_link,
                part.side or (0.0, 0.0, 0.0),
            )
            for part in parts
        ]

    def terms(self, first_path: int) -> tuple[Any, ...]:
        """The values of its row in the engine's arrays: of `_FIELDS`, and whether it is enabled.

        Its path begins in row `first_path`.
        """
        parent, child, auxiliary = self.parent, self.child, self.gear_auxiliary_link
        return (
            self.kind,
            parent.rows.tree,
            parent.first_link + 1 + self.parent_link,
            -1 if child is None else child.rows.tree,
            -1 if child is None else child.first_link + 1 + self.child_link,
            self.max_impulse,
            self.gear_ratio or 1.0,
            parent.first_link + 1 + auxiliary if auxiliary >= 0 else -1,
            self.relative_position_target,
            self.polynomial,
            self.erp,
            self.reference,
            self.impedance,
            self.inverse_inertia,
            self.parent_frame.position,
            self.child_frame.position,
            self.parent_frame.orientation,
            self.child_frame.orientation,
            self.axis,
            first_path,
            len(self.both_paths),
            first_path + len(self.path),
            parent.rows.first["actuator"] + self.actuator if self.actuator >= 0 else -1,
            self.is_wrench,
            self.spring,
            self.armature,
            self.range,
            self.enabled,
        )


class UserConstraints:
    """The user constraints of a world, by number.

    Attributes:
        next_id: Number of the next one.
    """

    def __init__(self) -> None:
        self._by_id: dict[int, UserConstraint] = {}
        self.next_id: int = 1
        self._next_hidden_id = -1
        # What the rows of the engine's arrays are known to contain.
        self._written: list[tuple[Any, ...]] = []
        # The constraints whose impulses `State.user_impulse` has, row by row.
        self._solved: list[int] = []

    def __len__(self) -> int:
        return len(self.all)

    @property
    def all(self) -> list[UserConstraint]:
        """All constraints that are not hidden, in order of creation."""
        return [constraint for number, constraint in self._by_id.items() if number > 0]

    @property
    def everything(self) -> list[UserConstraint]:
        """All constraints, also hidden ones."""
        return list(self._by_id.values())

    def get(self, constraint_id: int) -> UserConstraint | None:
        """The constraint with a number, or None."""
        return self._by_id.get(constraint_id)

    def new(
        self,
        kind: UserConstraintKind,
        parent: BodyCore,
        parent_link: int,
        child: BodyCore | None,
        child_link: int,
        axis: Vector3,
        parent_frame: Pose,
        child_frame: Pose,
        *,
        hidden: bool = False,
    ) -> UserConstraint:
        """A constraint with the next number, for `put`; see `UserConstraint` for the arguments.

        A hidden constraint, such as that of the mouse in the viewer, has a negative number, so that the
        numbers of other constraints do not change.
        """
        number = self._next_hidden_id if hidden else self.next_id
        return UserConstraint(
            number, kind, parent, parent_link, child, child_link, axis, parent_frame, child_frame
        )

    def take_id(self, change: Change) -> int:
        """Reserve the next number for the anchor of a soft body, which is not a constraint between links."""
        number = change.get(self, "next_id")
        change.set(self, "next_id", number + 1)
        return number

    def put(self, change: Change, constraint: UserConstraint) -> None:
        """Add a constraint with its own number with a change; later ones get higher numbers."""
        change.put(self._by_id, constraint.id, constraint)
        number = constraint.id
        if number > 0:
            if number >= change.get(self, "next_id"):
                change.set(self, "next_id", number + 1)
        elif number <= change.get(self, "_next_hidden_id"):
            change.set(self, "_next_hidden_id", number - 1)

    def discard(self, change: Change, constraint_id: int) -> None:
        """Remove the constraint with a number, if it exists, with a change."""
        change.drop(self._by_id, constraint_id)

    def remove(self, change: Change, body: BodyCore) -> None:
        """Remove every constraint of a body with a change."""
        for number, constraint in self._by_id.items():
            if body is constraint.parent or body is constraint.child:
                change.drop(self._by_id, number)

    @property
    def rows(self) -> dict[int, int]:
        """Row of each constraint in the arrays of the engine, by number."""
        # The numbers are copied at once, because the viewer's thread may add a constraint in the meantime.
        return {number: row for row, number in enumerate(tuple(self._by_id))}

    def forget_written(self, change: Change) -> None:
        """Write all rows the next time: with a change the arrays may get other contents."""
        if self._written:
            change.set(self, "_written", [])

    def note_values(
        self, change: Change, constraint: UserConstraint, values: Mapping[str, Any], arrays: ContactArrays
    ) -> bool:
        """Change attributes of a constraint, and their numbers in its row, with a change.

        Returns:
            Whether its row is up to date then; else `write` has to write it.
        """
        change.set_all(constraint, **values)
        numbers = list(self._by_id)
        if numbers != self._solved or len(self._written) != len(numbers) or not values.keys() <= _CHANGES:
            return False
        row, written = numbers.index(constraint.id), self._written.copy()
        terms = list(written[row])
        for name, value in values.items():
            if name == "child_frame":
                _note_term(change, arrays, row, terms, _PIVOT, value.position)
                _note_term(change, arrays, row, terms, _FRAME, value.orientation)
            elif name not in _NOT_IN_ROWS:
                _note_term(change, arrays, row, terms, _PLACES[name], value)
        written[row] = tuple(terms)
        change.set(self, "_written", written)
        # The order of rows depends on the links that are tied, and stays.
        return True

    def note_successor(
        self,
        change: Change,
        removed: UserConstraint,
        constraint: UserConstraint,
        arrays: ContactArrays,
        state: ArrayTable,
    ) -> bool:
        """Let a new constraint take the row of the last one, which was removed since, with a change.

        Returns:
            Whether it takes it: then all rows will be up to date. Else nothing is noted.
        """
        numbers, rows = list(self._by_id), self._written
        row = len(numbers)
        if self._solved != [*numbers, removed.id] or len(rows) != row + 1 or constraint.path:
            return False
        known = rows[row]
        terms = constraint.terms(known[_FIRST_PATH])
        if terms != known:
            others = [place for place, value in enumerate(terms) if value != known[place]]
            if not _NUMBERS.issuperset(others):
                return False
            for place in others:
                _note_number(change, arrays, row, place, terms[place])
            change.set(self, "_written", [*rows[:row], terms])
        numbers.append(constraint.id)
        change.set(self, "_solved", numbers)
        place = row * _ROW_BYTES
        change.write_numbers(state.bytes_of("user_impulse")[place : place + _ROW_BYTES], _NO_IMPULSES)
        # The order of rows depends on the links that are tied, and stays.
        return True

    def write(self, contact_arrays: ContactArrays, state: ArrayTable) -> None:
        """Write all constraints that have changed to the arrays of the engine; impulses follow their rows."""
        now, parts = [], []
        for constraint in self._by_id.values():
            now.append(constraint.terms(len(parts)))
            if constraint.path:
                parts += constraint.path_terms()
        contact_arrays.user_count = len(now)
        if parts:
            _write_paths(contact_arrays, parts)
        if now != self._written:
            self._write_rows(contact_arrays, now)
        if self._solved != list(self._by_id):
            self._write_impulses(state, self._rows_of(tuple(self._by_id), state))
        contact_arrays.forget_order()

    def _write_rows(self, contact_arrays: ContactArrays, now: list[tuple[Any, ...]]) -> None:
        contact_arrays.users.reserve({"user": len(now)})
        users = contact_arrays.users.numpy
        # Until all rows have been written, none is known.
        written, self._written = self._written, []
        for row, terms in enumerate(now):
            known = written[row] if row < len(written) else _UNKNOWN
            if terms != known:
                *shared, users["user_enabled"][:, row] = terms
                for field, value, old in zip(_FIELDS, shared, known, strict=False):
                    if value != old:
                        users[field][row] = value
        self._written = now

    def impulses(self, constraint: UserConstraint, state: ArrayTable) -> np.ndarray:
        """Impulses of a constraint's rows in the last substep, shape (rows,); 0 for a new constraint."""
        return np.frombuffer(self._rows_of([constraint.id], state))[: ROWS[constraint.kind]]

    def all_impulses(self, state: ArrayTable) -> np.ndarray:
        """Impulses of all constraints in the last substep, in order of creation, shape (constraints, 6)."""
        return np.frombuffer(self._rows_of(tuple(self._by_id), state)).reshape(-1, _MAX_ROWS)

    def set_impulses(self, change: Change, state: ArrayTable, impulses: np.ndarray) -> None:
        """Replace the impulses of all constraints with a change; they are as `all_impulses` gives them.

        `state` has room for them.
        """
        change.write(state.numpy["user_impulse"][0, : len(impulses)].reshape(-1, _MAX_ROWS), impulses)
        change.set(self, "_solved", list(self._by_id))

    def _write_impulses(self, state: ArrayTable, rows: bytes) -> None:
        numbers = list(self._by_id)
        state.reserve({"user": len(numbers)})
        # Until the rows have been moved, none is known.
        self._solved = []
        state.bytes_of("user_impulse")[: len(rows)] = rows
        self._solved = numbers

    def _rows_of(self, numbers: Sequence[int], state: ArrayTable) -> bytes:
        """The rows of `State.user_impulse` of some constraints, one after the other."""
        # Another thread may replace the list in the meantime.
        solved, memory = self._solved, state.bytes_of("user_impulse")
        return b"".join(
            memory[_ROW_BYTES * solved.index(number) :][:_ROW_BYTES]
            if number in solved
            else bytes(_ROW_BYTES)
            for number in numbers
        )


def _note_term(
    change: Change, arrays: ContactArrays, row: int, terms: list[Any], place: int, value: Any
) -> None:
    """Write a number, or several, of a row of `_FIELDS` with a change, if it is another."""
    if terms[place] != value:
        terms[place] = value
        _note_number(change, arrays, row, place, value)


def _note_number(change: Change, arrays: ContactArrays, row: int, place: int, value: Any) -> None:
    target = arrays.users.numpy[_FIELDS[place]][row : row + 1]
    change.write_numbers(target, value if isinstance(value, tuple) else (value,))


def _write_paths(contact_arrays: ContactArrays, parts: Sequence[tuple[Any, ...]]) -> None:
    """Write the parts of all paths."""
    contact_arrays.users.reserve({"path": len(parts)})
    users = contact_arrays.users.numpy
    for field, values in zip(_PATH_FIELDS, zip(*parts, strict=True), strict=True):
        users[field][: len(parts)] = values
