"""The state of a world at one moment, which can be restored.

It contains everything that a step starts from, including contacts and their last impulses. So a world that is
restored from a snapshot then moves exactly, bit for bit, as it did after the snapshot was taken. Masses and
shapes of bodies, constraints, gravity and the other parameters are not part of the state.
"""

from __future__ import annotations

import itertools
import operator
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.engine.parameters import BULLET
from carom.errors import StateError
from carom.layouts.codes import BASE_VELOCITIES
from carom.layouts.contacts import COUNTED, SORTED, Contacts
from carom.layouts.model import State
from carom.layouts.types import STATE
from carom.native.change import Change, packed_block
from carom.native.tables import fields_of

if TYPE_CHECKING:
    from carom.native.tables import ArrayTable
    from carom.scene.core.world_core import WorldCore

_USES = {name: field.use for name, field in fields_of(State).items()}
# What has the state of constraints, whose impulses are saved in the order of their creation.
_OF_CONSTRAINTS = "user"
# The axes of the other state, and of that of contacts.
_OF_BODIES = {
    name: use.axis for name, use in _USES.items() if use.kind == STATE and use.axis != _OF_CONSTRAINTS
}
_OF_CONTACTS = {name: field.axis for name, field in fields_of(Contacts).items() if field.use.kind == STATE}
# Drives of joints; the rows of bases are unused.
_DRIVES = [name for name, use in _USES.items() if use.joints]
JOINT_DOFS = "joint dof"
# What two bodies have to have as many of for one to take over the state of the other.
_MOVING = ("links", "positions", "dofs", "nodes", "actuators", "sensors", "late")
Pair = tuple[np.ndarray, np.ndarray]
"""Rows of a world, and those of a snapshot."""

# Each number stands for the memory of one world's arrays.
_places = itertools.count()


@dataclass(frozen=True, slots=True)
class BodyLayout:
    """The properties of a body that a state has to match.

    Attributes:
        id: Its number.
        links: Number of links, the base included.
        positions: Number of position coordinates.
        dofs: Number of velocity coordinates.
        shapes: Number of its collision shapes.
        nodes: Number of nodes; 0 unless it is a soft body.
        actuators: Number of actuators.
        sensors: Length of the memory of sensors.
        late: Number of links with late velocities.
    """

    id: int
    links: int
    positions: int
    dofs: int
    shapes: int
    nodes: int = 0
    actuators: int = 0
    sensors: int = 0
    late: int = 0

    def __str__(self) -> str:
        if self.nodes:
            return f"{self.nodes} nodes"
        joints, freedoms = self.links - 1, self.dofs - BASE_VELOCITIES
        driven = f" and {self.actuators} actuators" if self.actuators else ""
        sensed = f" and {self.sensors} numbers of sensors" if self.sensors else ""
        late = f" and late velocities of {self.late} links" if self.late else ""
        return f"{joints} joints with {freedoms} freedoms{driven}{sensed}{late}"

    def moves_like(self, other: BodyLayout) -> bool:
        """Whether both have the same numbers of links, coordinates, nodes, actuators and sensors' memory."""
        return all(getattr(self, name) == getattr(other, name) for name in _MOVING)


class Blocks:
    """How the arrays of a snapshot are copied to a world: records that are made when it first returns there.

    Attributes:
        records: `packed_block` of the arrays, one after the other.
        place: The `Shape.place` of the world.
        arrays: All arrays of the snapshot.
    """

    __slots__ = ("arrays", "place", "records")

    def __init__(self) -> None:
        self.records: bytes = b""
        self.place: int = -1
        self.arrays: list[np.ndarray] = []

    def __reduce__(self) -> tuple[type[Blocks], tuple[()]]:
        # Copies of the arrays are elsewhere.
        return Blocks, ()

    def fit(self, place: int, arrays: list[np.ndarray]) -> bool:
        """Whether the records are of these arrays of the snapshot, and of this place."""
        ours = self.arrays
        return self.place == place and len(ours) == len(arrays) and all(map(operator.is_, ours, arrays))

    def make(self, place: int, arrays: list[np.ndarray], pairs: Iterable[Pair]) -> bool:
        """Make records of pairs of targets and sources; False if some arrays are too unusual for that."""
        pairs = list(pairs)
        if not all(_is_plain_copy(target, source) for target, source in pairs):
            return False
        records = [packed_block(source.ctypes.data, to.ctypes.data, source.nbytes) for to, source in pairs]
        self.place = -1
        self.records, self.arrays, self.place = b"".join(records), arrays, place
        return True


def _is_plain_copy(target: np.ndarray, source: np.ndarray) -> bool:
    return (
        source.shape == target.shape
        and source.dtype == target.dtype
        and source.flags.c_contiguous
        and target.flags.c_contiguous
    )


@dataclass(slots=True)
class Snapshot:
    """A state; get one from `World.snapshot`.

    Attributes:
        layout: The bodies of the state.
        time: Simulated time [s].
        unspent_time: Part of it not yet covered by a substep [s].
        state: Fields of `State` by name, without the world axis: the rows in use; of drives, those of
            joints only.
        contacts: Fields of `Contacts`, likewise.
        user_impulses: Impulses of the user constraints, in order of creation, (constraints, 6).
        blocks: How it is copied back.
        contact: The law of its contacts.
    """

    layout: Layout
    time: float
    unspent_time: float
    state: dict[str, np.ndarray] = field(default_factory=dict)
    contacts: dict[str, np.ndarray] = field(default_factory=dict)
    user_impulses: np.ndarray = field(default_factory=lambda: np.zeros((0, 6)))
    blocks: Blocks = field(default_factory=Blocks, repr=False, compare=False)
    contact: str = BULLET


@dataclass(frozen=True, slots=True)
class Layout:
    """Which bodies a world has, in the order of their rows.

    Attributes:
        bodies: The layout of each.
        joint_dofs: Rows of the velocity coordinates of joints.
        resizes: How often the sizes of their shapes had been set.
    """

    bodies: tuple[BodyLayout, ...]
    joint_dofs: np.ndarray = field(compare=False)
    resizes: int = 0

    @classmethod
    def of(cls, bodies: tuple[BodyLayout, ...], resizes: int = 0) -> Layout:
        """The layout of some bodies."""
        counts = np.array([body.dofs for body in bodies], dtype=int)
        rows = np.arange(counts.sum())
        last = np.repeat(np.cumsum(counts), counts)
        within = rows - last + np.repeat(counts, counts)
        return cls(bodies, rows[within >= BASE_VELOCITIES], resizes)


def layout(world: WorldCore) -> Layout:
    """The present layout of a world."""
    all_shapes = world.contact_arrays.shapes
    shape_count = all_shapes.table.numpy["link_shape_count"]
    bodies = []
    for body in world.bodies.values():
        rows = body.rows
        first, links = rows.first["link"], rows.count["link"]
        shapes = int(shape_count[first : first + links].sum())
        positions, dofs = rows.count["position"], rows.count["dof"]
        others = [rows.count[axis] for axis in ("node", "actuator", "sensor", "late")]
        bodies.append(BodyLayout(body.id, links, positions, dofs, shapes, *others))
    return Layout.of(
        tuple(bodies), sum(all_shapes.body_of(body.rows).resizes for body in world.bodies.values())
    )


@dataclass(slots=True)
class Shape:
    """What `take` and `return_to` have to know of a world, found on demand.

    Attributes:
        layout: Its layout.
        rows: Fields of its state by name, with their rows in use.
        place: The number of the memory that these are in, and its contacts.
    """

    layout: Layout
    rows: dict[str, np.ndarray] = field(default_factory=dict)
    place: int = -1
    _replacements: tuple[int, int] = -1, -1

    def look(self, world: WorldCore) -> None:
        """Bring `rows` up to date if arrays were replaced; bodies are as when the layout was made."""
        state = world.arrays.state
        replacements = state.replacements, world.contact_arrays.contacts.replacements
        if replacements != self._replacements:
            self.rows = dict(_rows(state, world.arrays.used))
            self.place = next(_places)
            self._replacements = replacements


def take(world: WorldCore, shape: Shape) -> Snapshot:
    """The present state of a world, which has this shape."""
    layout = shape.layout
    snapshot = Snapshot(layout, world.time, world.unspent_time, contact=world.law_of_contacts)
    shape.look(world)
    snapshot.state = {
        name: rows[layout.joint_dofs] if name in _DRIVES else rows.copy() for name, rows in shape.rows.items()
    }
    islands = snapshot.state["tree_island"]
    if islands.size and islands.max() >= len(islands):
        # The numbers are those of the last step, and a body was removed since. The next step replaces them.
        islands[:] = np.arange(len(islands))
    counts = world.contact_arrays.contacts.numpy["count_contacts"][0]
    snapshot.contacts = {name: rows.copy() for name, rows in _contact_rows(world, counts)}
    snapshot.contacts["count_contacts"][SORTED] = 0
    snapshot.user_impulses = world.user_constraints.all_impulses(world.arrays.state)
    return snapshot


def return_to(change: Change, world: WorldCore, shape: Shape, snapshot: Snapshot) -> None:
    """Restore a world, which has this shape, from a snapshot with a change, which notes nothing before.

    Contacts are dropped, and detected again at the next step, if bodies have other shapes now or were removed
    and loaded in another order, or if they remember the impulses of another law.

    Raises:
        StateError: The world has other bodies.
    """
    same = shape.layout == snapshot.layout
    if not same:
        snapshot = _reordered(snapshot, shape.layout)
    else:
        world.grow(world.contact_arrays.contacts, counted_rows(snapshot.contacts["count_contacts"]))
    impulses, users = snapshot.user_impulses, world.user_constraints
    if len(impulses) == len(users.rows):
        world.grow(world.arrays.state, {"user": len(impulses)})
        users.set_impulses(change, world.arrays.state, impulses)
    shape.look(world)
    if len(snapshot.layout.joint_dofs):
        for name in _DRIVES:
            change.write(shape.rows[name], _of_drives(shape.rows[name], snapshot, name), lasting=True)
    if same and snapshot.contact == world.law_of_contacts:
        _copy_back(change, world, shape, snapshot)
        counts = world.contact_arrays.contacts.numpy["count_contacts"][0]
        change.write(counts, snapshot.contacts["count_contacts"], lasting=True)
        # The trees that can move may be others now.
        change.write(counts[SORTED : SORTED + 1], 0)
    else:
        for target, source in _pairs_of_state(shape, snapshot):
            change.write(target, source, lasting=True)
        world.contact_arrays.drop_contacts(change)
        change.write(world.arrays.state.numpy["tree_reset"][0], 0)
    world.note_time(change, snapshot.time, snapshot.unspent_time)
    if world.arrays.state.numpy["tree_activity"].any() or snapshot.state["tree_activity"].any():
        world.change_scene(change)


def _copy_back(change: Change, world: WorldCore, shape: Shape, snapshot: Snapshot) -> None:
    """Copy everything but drives and the counts of contacts."""
    arrays = [*snapshot.state.values(), *snapshot.contacts.values()]
    blocks = snapshot.blocks
    if not blocks.fit(shape.place, arrays):
        pairs = _pairs_of_state(shape, snapshot)
        for name, rows in _contact_rows(world, snapshot.contacts["count_contacts"]):
            if name != "count_contacts":
                pairs.append((rows, snapshot.contacts[name]))
        if not blocks.make(shape.place, arrays, pairs):
            for target, source in pairs:
                change.write(target, source, lasting=True)
            return
    change.copy_blocks(blocks.records, arrays)


def _pairs_of_state(shape: Shape, snapshot: Snapshot) -> list[Pair]:
    return [(rows, snapshot.state[name]) for name, rows in shape.rows.items() if name not in _DRIVES]


def _of_drives(rows: np.ndarray, snapshot: Snapshot, name: str) -> np.ndarray:
    """Rows of drives, of which a snapshot has those of joints."""
    drives = rows.copy()
    drives[snapshot.layout.joint_dofs] = snapshot.state[name]
    return drives


def _rows(table: ArrayTable, used: dict[str, int]) -> Iterator[tuple[str, np.ndarray]]:
    """Names of the fields in the state of a single world, with their rows in use."""
    for name, axis in _OF_BODIES.items():
        yield name, table.numpy[name][0, : used[axis]]


def axis_of(name: str) -> str:
    """The axis of a field in `Snapshot.state`; `JOINT_DOFS` where bases have no rows."""
    return JOINT_DOFS if _USES[name].joints else _USES[name].axis


def counted_rows(counts: np.ndarray) -> dict[str, int]:
    """Numbers of rows in use of `Contacts` by axis, from the row of `count_contacts`."""
    return {axis: int(counts[column]) for axis, column in COUNTED.items()}


def _contact_rows(world: WorldCore, counts: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    used = counted_rows(counts)
    contacts = world.contact_arrays.contacts.numpy
    for name, axis in _OF_CONTACTS.items():
        array = contacts[name]
        yield name, array[0, : used[axis]] if axis in used else array[0]


def _reordered(snapshot: Snapshot, layout: Layout) -> Snapshot:
    """The snapshot with its rows in the order of another layout."""
    check_same(snapshot.layout, layout)
    was, bodies = snapshot.layout.bodies, layout.bodies
    place = {body.id: index for index, body in enumerate(was)}
    counts = {
        "tree": [1] * len(was),
        "link": [body.links for body in was],
        "position": [body.positions for body in was],
        "dof": [body.dofs for body in was],
        "node": [body.nodes for body in was],
        "actuator": [body.actuators for body in was],
        "sensor": [body.sensors for body in was],
        "late": [body.late for body in was],
        JOINT_DOFS: [body.dofs - BASE_VELOCITIES for body in was],
    }
    order: dict[Any, np.ndarray] = {}
    for axis, lengths in counts.items():
        runs = np.split(np.arange(sum(lengths)), np.cumsum(lengths)[:-1])
        order[axis] = np.concatenate([runs[place[body.id]] for body in bodies])
    state = {name: rows[order[axis_of(name)]] for name, rows in snapshot.state.items()}
    # Islands are numbered by rows of trees, which have changed.
    state["tree_island"] = np.arange(len(bodies), dtype=np.int32)
    return Snapshot(layout, snapshot.time, snapshot.unspent_time, state)


def check_same(saved: Layout, present: Layout) -> None:
    """Raise `StateError` unless the present bodies, their joints and nodes are those of a saved state."""
    before = {body.id: body for body in saved.bodies}
    now = {body.id: body for body in present.bodies}
    for number in sorted(before.keys() | now.keys()):
        if number not in now:
            raise StateError(f"body {number} has been removed since the state was saved")
        if number not in before:
            raise StateError(f"body {number} was not there when the state was saved")
        if not before[number].moves_like(now[number]):
            raise StateError(f"body {number} has {now[number]}; it had {before[number]}")
