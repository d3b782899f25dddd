"""Drafts of worlds: copies to which bodies are added, and which the world then takes over by one call.

A change of many steps, such as reading a file of a world, is made to a draft by the same functions as any
other change; if it fails, the draft is dropped.
"""

from __future__ import annotations

from copy import copy, deepcopy
from typing import TYPE_CHECKING, Any

from carom.engine.quick_scene import QuickScene
from carom.layouts.model import State
from carom.native.change import Change
from carom.native.clock import Clock
from carom.native.tables import ArrayTable, fields_of
from carom.scene.bodies import Bodies

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

# Attributes of a world that are replaced when it takes over a draft.
_VALUES = ("parameters", "free_ids", "next_id", "links_loaded")


class Draft:
    """A draft of a world.

    Attributes:
        world: The draft, a world of its own. Bodies and constraints of the original are shared and stay as
            they are; new bodies belong to the draft until it is published.
    """

    def __init__(self, original: WorldCore) -> None:
        self._original = original
        self.world: WorldCore = _copied(original)
        self._watches = False

    def measure(self, bodies: Sequence[BodyCore]) -> None:
        """Check the sensors of bodies that were added, and switch on what they need."""
        if any(body.spec.sensors for body in bodies):
            from carom.scene.sensors.changes import check_sensor, measure_loads

            for body in bodies:
                for spec in body.spec.sensors:
                    check_sensor(self.world, body, spec)
            change = Change()
            self._watches = measure_loads(change, bodies)
            change.commit()

    def publish(self, change: Change) -> None:
        """Let the original take over everything with a change, which is made."""
        world, draft = self._original, self.world
        for name in _VALUES:
            change.set(world, name, getattr(draft, name))
        world.note_time(change, draft.time, draft.unspent_time)
        for body in draft.bodies.values():
            if body.world is draft:
                change.set(body, "world", world)
        change.refill(world.bodies, draft.bodies)
        change.refill(world.listing, draft.listing)
        for one, other in (
            (world.joint_constraints, draft.joint_constraints),
            (world.joint_constraints.tags, draft.joint_constraints.tags),
            (world.user_constraints, draft.user_constraints),
            (world.user_data, draft.user_data),
            (world.arrays, draft.arrays),
            (world.contact_arrays, draft.contact_arrays),
            (world.contact_arrays.shapes, draft.contact_arrays.shapes),
            (world.contact_arrays.shapes.filters, draft.contact_arrays.shapes.filters),
            (world.contact_arrays.soft, draft.contact_arrays.soft),
        ):
            _take_over(change, one, other)
        for table, drafted in zip(_tables(world), _tables(draft), strict=True):
            table.take_over(change, drafted, but=_OF_ENGINE)
        change.set(world.arrays, "_row_changes", None)
        if self._watches:
            from carom.scene.sensors.changes import note_watch

            note_watch(change, world)
        world.change_scene(change)
        change.commit()


def draft_of(world: WorldCore) -> Draft:
    """A draft that is as the world is now."""
    return Draft(world)


def _tables(world: WorldCore) -> list[ArrayTable]:
    arrays, contacts = world.arrays, world.contact_arrays
    shapes, soft = contacts.shapes.table, contacts.soft.table
    return [arrays.model, arrays.state, shapes, contacts.contacts, contacts.users, soft]


# Parts that an object keeps: what is in them is taken over instead.
_PARTS = frozenset(
    {"tags", "rows", "model", "state", "shapes", "contacts", "users", "soft", "table", "filters"}
    | {"_table", "_arrays", "_row_changes"}
)
# The engine keeps the status of its steps.
_OF_ENGINE = [name for name, field in fields_of(State).items() if field.axis == "status"]


def _take_over(change: Change, one: Any, other: Any) -> None:
    """Give an object the attributes of another; dictionaries stay the same objects."""
    for name, value in vars(other).items():
        if name in _PARTS:
            continue
        present = vars(one)[name]
        if present is value:
            continue
        if type(present) is dict and type(value) is dict:
            change.refill(present, value)
        else:
            change.set(one, name, value)


def _copied(world: WorldCore) -> WorldCore:
    """A copy of a world with the same handles of bodies and constraints."""
    other: WorldCore = object.__new__(type(world))
    vars(other).update(vars(world))
    memo = {id(shared): shared for shared in _shared(world)}
    memo[id(world)] = other
    other.bodies, other.listing = Bodies(world.bodies), world.listing.copy()
    other._clock = Clock(world.time, world.unspent_time)
    other.observers = []
    other.quick = QuickScene()
    other.parameters = copy(world.parameters)
    other.joint_constraints = deepcopy(world.joint_constraints, memo)
    other.user_constraints = deepcopy(world.user_constraints, memo)
    other.user_data = deepcopy(world.user_data, memo)
    other.free_ids = world.free_ids.copy()
    arrays = deepcopy(world.arrays, memo)
    contact_arrays = deepcopy(world.contact_arrays, memo)
    change = Change()
    other.take_arrays(change, arrays, contact_arrays)
    change.commit()
    return other


def _shared(world: WorldCore) -> list[Any]:
    """What is the same object in a draft: handles that users have, and what these contain."""
    soft, shapes = world.contact_arrays.soft, world.contact_arrays.shapes
    bodies = world.bodies.values()
    return [
        *bodies,
        *(body.rows for body in bodies),
        *(body.spec for body in bodies),
        *world.joint_constraints.all,
        *world.user_constraints.everything,
        *world.user_data.everything,
        *soft.bodies,
        *soft.anchors.values(),
        *shapes.bodies,
    ]
