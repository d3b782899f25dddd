"""The rows of motors, limits and user constraints in the arrays of an engine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from carom.layouts.codes import MAX_ROWS_PER_CONSTRAINT
from carom.model.builder import WorldArrays
from carom.model.solver_order import batch_islands, quicksort_order
from carom.native.change import Change

if TYPE_CHECKING:
    from carom.scene.joint_constraints import JointConstraint
    from carom.scene.user_constraints import UserConstraint

# Fields of a row in `carom.layouts.model.Model`, and where their values are in `_terms`.
_FIELDS = (
    "constraint_kind",
    "constraint_tree",
    "constraint_link",
    "constraint_place",
    "constraint_lower",
    "constraint_upper",
    "constraint_twist",
    "constraint_max_impulse",
    "constraint_actuator",
    "constraint_reference",
    "constraint_impedance",
    "constraint_margin",
)


Terms = tuple[Any, ...]
# Terms of a row whose contents are not known.
_UNKNOWN: Terms = (None,) * len(_FIELDS)


class ConstraintRows:
    """The rows of a world's constraints, brought up to date before a step.

    Motors and limits are sorted by island, and user constraints follow. While there are any, each step sorts
    all constraints by itself, and the order of rows does not matter. Therefore a user constraint that comes
    or goes changes few rows; after all other changes all rows are made anew.
    """

    def __init__(self) -> None:
        # The constraints by row; none if all rows have to be made anew.
        self._rows: list[JointConstraint] | None = None
        # By row: the place in Bullet's list.
        self._places: list[int] = []
        # Whether motors and limits are sorted as they would be without user constraints.
        self._is_sorted = True
        # What the rows are known to contain, also some that are no longer used.
        self._written: list[Terms] = []
        # User constraints that have come (or gone) since the rows were written.
        self._changes: list[tuple[JointConstraint, bool]] = []

    def forget(self, change: Change) -> None:
        """Make all rows anew the next time: with a change they, or the arrays, become others."""
        if self._rows is not None:
            change.set_all(self, _rows=None, _changes=[])

    def note(self, change: Change, constraint: JointConstraint, *, added: bool) -> None:
        """With a change, a user constraint is added at the end of Bullet's list, or removed from it."""
        rows = change.get(self, "_rows")
        if rows is None:
            # All rows are made anew anyway.
            return
        if len(self._changes) > len(rows):
            self.forget(change)
        else:
            change.extend(self._changes, [(constraint, added)])

    def awaits_successor(self, removed: UserConstraint) -> bool:
        """Whether the only change is that a constraint was removed, which was last here and in Bullet's list.

        One that is added then takes its row and its place.
        """
        rows, changes = self._rows, self._changes
        if not rows or len(changes) != 1:
            return False
        constraint, added = changes[0]
        last = len(rows) - 1
        return (
            not added
            and constraint.user is removed
            and rows[last] is constraint
            and self._places[last] == last
        )

    def note_successor(self, change: Change, constraint: JointConstraint) -> None:
        """Give a constraint that row with a change; it acts on the same links as the one removed."""
        change.set_all(self, _rows=[*(self._rows or [])[:-1], constraint], _changes=[])

    def update(self, arrays: WorldArrays, user_rows: Mapping[int, int]) -> bool:
        """Write the rows that have changed; false if all have to be made anew by `sort`.

        `user_rows` are the rows of user constraints in `UserConstraints`, by number.
        """
        rows, self._rows = self._rows, None
        changes, self._changes = self._changes, []
        if rows is None:
            return False
        changed: set[int] = set()
        for constraint, added in changes:
            if added:
                self._append(rows, constraint, changed)
            else:
                self._drop(rows, constraint, changed)
        _count(arrays, changes)
        if changes and not self._is_sorted and all(constraint.user is None for constraint in rows):
            return False
        _use(arrays, len(rows))
        self._written += [_UNKNOWN] * (len(rows) - len(self._written))
        for row in changed:
            if row < len(rows):
                self._write(arrays, row, self._terms(rows, row, user_rows))
        self._rows = rows
        return True

    def sort(
        self,
        arrays: WorldArrays,
        active: Sequence[JointConstraint],
        tags: Mapping[Any, int],
        user_rows: Mapping[int, int],
        minimum_island_size: int,
    ) -> None:
        """Make all rows anew.

        Args:
            arrays: The arrays of the world.
            active: The constraints that have rows, as in Bullet's list.
            tags: Island of each body that can move, by number.
            user_rows: Row of each user constraint in `UserConstraints`, by number.
            minimum_island_size: Islands are merged until they have more constraints than this.
        """
        own = [constraint for constraint in active if constraint.user is None]
        keys = [tags[constraint.body.id] for constraint in own]
        order = quicksort_order(keys)
        rows = [own[i] for i in order]
        rows += [constraint for constraint in active if constraint.user is not None]
        places = {constraint: place for place, constraint in enumerate(active)}
        self._places = [places[constraint] for constraint in rows]
        _use(arrays, len(rows))
        self._written = [self._terms(rows, row, user_rows) for row in range(len(rows))]
        for field, values in zip(_FIELDS, zip(*self._written, strict=True), strict=False):
            arrays.model.numpy[field][_at(arrays, field, slice(len(rows)))] = values
        tree_count = arrays.used["tree"]
        counts = [0] * tree_count
        for constraint in rows:
            for tree in _trees_of(constraint):
                counts[tree] += 1
        arrays.model.numpy["tree_constraint_count"][:tree_count] = counts
        islands = batch_islands([keys[i] for i in order], minimum_island_size)
        _write_batches(arrays, rows, islands)
        self._is_sorted = True
        self._rows = rows

    def _append(self, rows: list[JointConstraint], constraint: JointConstraint, changed: set[int]) -> None:
        """Append a user constraint, and add the rows that have to be written to `changed`."""
        changed.add(len(rows))
        self._places.append(len(rows))
        rows.append(constraint)

    def _drop(self, rows: list[JointConstraint], constraint: JointConstraint, changed: set[int]) -> None:
        """Drop a user constraint, and add the rows that have to be written to `changed`.

        The last row, which is that of a user constraint, takes its row. In Bullet's list the last constraint
        takes its place.
        """
        places, row, last = self._places, rows.index(constraint), len(rows) - 1
        after = places.index(last)
        if rows[after].user is None:
            self._is_sorted = False
        places[after] = places[row]
        rows[row], places[row] = rows[last], places[last]
        rows.pop()
        places.pop()
        changed.add(after)
        # The later ones among the user constraints have other rows in `UserConstraints` now.
        changed.update([row for row, other in enumerate(rows) if other.user is not None])

    def _write(self, arrays: WorldArrays, row: int, terms: Terms) -> None:
        """Write what has changed of a row."""
        if terms != self._written[row]:
            for field, value, old in zip(_FIELDS, terms, self._written[row], strict=True):
                if value != old:
                    arrays.model.numpy[field][_at(arrays, field, row)] = value
            self._written[row] = terms

    def _terms(self, rows: Sequence[JointConstraint], row: int, user_rows: Mapping[int, int]) -> Terms:
        """The values of a row, of `_FIELDS`."""
        it = rows[row]
        link = it.body.first_link + 1 + it.joint if it.user is None else user_rows[it.user.id]
        tree, place = it.sorted_with.rows.tree, self._places[row]
        actuator = it.body.rows.first["actuator"] + it.actuator
        bounds = (it.lower, it.upper, it.twist, it.max_impulse)
        return it.kind, tree, link, place, *bounds, actuator, it.reference, it.impedance, it.margin


def _at(arrays: WorldArrays, field: str, rows: int | slice) -> Any:
    """Index of rows of a field of the model; of those of all worlds, if worlds have their own."""
    return (slice(None), rows) if arrays.model.numpy[field].ndim > 1 else rows


def _use(arrays: WorldArrays, count: int) -> None:
    """Set the number of rows, and make room for them."""
    if arrays.used["constraint"] == count:
        return
    used = {"constraint": count, "row": count * MAX_ROWS_PER_CONSTRAINT}
    arrays.model.reserve(used)
    arrays.state.reserve(used)
    arrays.used = {**arrays.used, **used}


def _count(arrays: WorldArrays, changes: Iterable[tuple[JointConstraint, bool]]) -> None:
    """Update the number of constraints of each tree."""
    more: dict[int, int] = {}
    for constraint, added in changes:
        change = 1 if added else -1
        for tree in _trees_of(constraint):
            more[tree] = more.get(tree, 0) + change
    for tree, count in more.items():
        if count:
            arrays.model.numpy["tree_constraint_count"][tree] += count


def _trees_of(constraint: JointConstraint) -> list[int]:
    """The trees that a constraint acts on."""
    trees = [constraint.body.rows.tree]
    if constraint.user is not None and constraint.user.child is not None:
        trees.append(constraint.user.child.rows.tree)
    return trees


def _write_batches(
    arrays: WorldArrays, rows: Sequence[JointConstraint], islands: Iterable[tuple[int, int]]
) -> None:
    """Write which trees are solved together; `islands` are runs of rows, by first row and length."""
    tree_count = arrays.used["tree"]
    batches, first_constraints, lengths = list(range(tree_count)), [0] * tree_count, [0] * tree_count
    for first, length in islands:
        trees = [constraint.body.rows.tree for constraint in rows[first : first + length]]
        root = min(trees)
        for tree in trees:
            batches[tree] = root
        first_constraints[root], lengths[root] = first, length
    model = arrays.model.numpy
    model["tree_batch"][:tree_count] = batches
    model["tree_first_constraint"][:tree_count] = first_constraints
    model["tree_batch_constraints"][:tree_count] = lengths
