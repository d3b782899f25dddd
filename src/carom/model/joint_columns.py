"""Numbers given joint by joint, put in the order of a body's coordinates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate, chain
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from carom.scene.body import Body

_UNSTATED_FORCE = 100000.0
_NO_TURN = (0.0, 0.0, 0.0, 1.0)

Entries = Sequence[Sequence[float]]
Numbers = tuple[float, ...]


class Column(NamedTuple):
    """A sequence of numbers for each of some joints; `column_of` makes one.

    Attributes:
        entries: The sequences; none if no joint has numbers.
        counts: Their lengths.
        numbers: The numbers of all of them, one after the other.
    """

    entries: Entries
    counts: list[int]
    numbers: list[float]


def column_of(entries: Entries) -> Column:
    """The column with these entries."""
    return Column(entries, list(map(len, entries)), _joined(entries))


def _joined(entries: Entries) -> list[float]:
    return list(chain.from_iterable(entries))


NO_ENTRIES = column_of(())
"""A column that is not given."""


class JointColumns:
    """Puts columns, which have an entry for each of some joints, in the order of all coordinates of a body.

    Scripts name the same joints in every step of a control loop; so where each number comes from is found
    only once. If a joint is named several times, its last entries count.

    Attributes:
        joints: The joints, in the order of the entries.
    """

    def __init__(self, body: Body, joints: tuple[int, ...]) -> None:
        self.joints = joints
        positions, dofs = body.position_count, body.velocity_count
        rest = [_NO_TURN if count == len(_NO_TURN) else (0.0,) * count for count in positions]
        self._rest = _joined(rest)
        self._zeros = [0.0] * sum(dofs)
        self._default_positions = column_of([rest[joint] for joint in joints])
        self._default_velocities = column_of([(0.0,) * dofs[joint] for joint in joints])
        self._default_forces = column_of([(_UNSTATED_FORCE,) * dofs[joint] for joint in joints])
        self._pick_positions = _picker(_sources(positions, joints))
        self._pick_dofs = _picker(_sources(dofs, joints))
        self._pick_gains = _picker(_common_sources(dofs, joints))

    def positions(self, column: Column) -> Numbers:
        """Position coordinates of all joints: 0 or no rotation where no entry fits."""
        return self._pick_positions(self._rest + _mended(column, self._default_positions, _fitting))

    def velocities(self, column: Column) -> Numbers:
        """Velocity coordinates of all joints: 0 where no entry fits."""
        return self._pick_dofs(self._zeros + _mended(column, self._default_velocities, _fitting))

    def forces(self, column: Column) -> Numbers:
        """Maximum forces of all dofs: 100000 beyond the length of an entry, 0 for joints not named."""
        return self._pick_dofs(self._zeros + _mended(column, self._default_forces, _filled_up))

    def gains(self, values: Sequence[float]) -> Numbers:
        """The gain of each dof, from one of each joint: 0 for joints not named."""
        return self._pick_gains([0.0, *values])


def _mended(
    column: Column, defaults: Column, mend: Callable[[Sequence[float], Sequence[float]], Sequence[float]]
) -> list[float]:
    """The numbers of a column, in which `mend` makes entries as long as their defaults."""
    if column.counts == defaults.counts:
        return column.numbers
    return _joined(list(map(mend, column.entries, defaults.entries))) if column.entries else defaults.numbers


def _fitting(entry: Sequence[float], default: Sequence[float]) -> Sequence[float]:
    """The default if the entry has another length."""
    return entry if len(entry) == len(default) else default


def _filled_up(entry: Sequence[float], default: Sequence[float]) -> Sequence[float]:
    """The entry, cut off or continued by the default to the default's length."""
    return (*entry[: len(default)], *default[len(entry) :])


def _picker(places: list[int]) -> Callable[[list[float]], Numbers]:
    """A function that returns the items of a list at some places."""
    if len(places) > 1:
        return itemgetter(*places)
    # Of a single item `itemgetter` makes no tuple.
    return lambda numbers: tuple([numbers[place] for place in places])


def _sources(counts: Sequence[int], joints: Sequence[int]) -> list[int]:
    """Where each number of all joints is in a list that has the usual numbers of all, then those given.

    Args:
        counts: How many numbers each joint of the body has.
        joints: The joints whose numbers are given.
    """
    firsts = list(accumulate(counts, initial=0))
    place = firsts.pop()
    sources = list(range(place))
    for joint in joints:
        first, count = firsts[joint], counts[joint]
        sources[first : first + count] = range(place, place + count)
        place += count
    return sources


def _common_sources(counts: Sequence[int], joints: Sequence[int]) -> list[int]:
    """As `_sources`, but the list has one usual number for all joints, then one for each joint given."""
    places = dict(zip(joints, range(1, len(joints) + 1), strict=True))
    return [places.get(joint, 0) for joint, count in enumerate(counts) for _ in range(count)]
