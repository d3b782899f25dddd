"""The state of a world in a file: its arrays, and their checks before the engine uses them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.contacts import AS_LINKS, AS_SHAPES, CONTACT_COLUMNS, KNOWN, NO_MANIFOLD, RESETS, THERE
from carom.layouts.magnitudes import MAX_MAGNITUDE
from carom.layouts.model import State
from carom.native.change import Change
from carom.native.tables import fields_of
from carom.scene.snapshot import (
    JOINT_DOFS,
    BodyLayout,
    Layout,
    Shape,
    Snapshot,
    axis_of,
    counted_rows,
    layout,
    return_to,
    take,
)
from carom.world_files.records import Reader

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

_FIELDS = {"bodies", "time", "unspent_time", "state", "contacts", "user_impulses"}
_ARRAYS = ("state", "contacts")
# What a step says about itself and no step begins with; NaN where nothing could move.
_REPORTS = [name for name, field in fields_of(State).items() if field.use.may_be_nan]
_USER_IMPULSES = 6
_BOUNDED = [name for name, field in fields_of(State).items() if field.use.bounded]
# Coordinates of a base: a position, then a quaternion; where that begins, and its length.
_BASE_TURN, _QUATERNION = 3, 4
_UNIT_TOLERANCE = 1e-3
_OF_ACTUATORS = ("actuator_control", "actuator_activation", "actuator_force")
_OF_SENSORS = ("dof_joint_impulse", "dof_limit_impulse")
_OF_LATE = ("late_velocity", "late_joint")
NO_LATE: Mapping[int, int] = {}
_OF_NODES = ("node_position", "node_velocity", "node_force")


def state_of(world: WorldCore) -> dict[str, Any]:
    """The present state of a world, as a value for `Writer.write`."""
    snapshot = take(world, Shape(layout(world)))
    return {
        "bodies": list(snapshot.layout.bodies),
        "time": snapshot.time,
        "unspent_time": snapshot.unspent_time,
        "state": snapshot.state,
        "contacts": snapshot.contacts,
        "user_impulses": snapshot.user_impulses,
    }


def read_state(reader: Reader, data: Any, late: Mapping[int, int] = NO_LATE) -> Snapshot:
    """The state in a document; bodies have the numbers they had when they were saved.

    `late` has by body the number of its links with late velocities, which older files lack: they are 0.

    Raises:
        carom.errors.DescriptionError: The document has no valid state, or arrays do not fit the bodies.
    """
    if not isinstance(data, dict) or data.keys() != _FIELDS:
        raise reader.fail("state", "is missing or does not have the fields of a state")
    bodies = reader.read(list[BodyLayout], data["bodies"], "state.bodies")
    arrays = {part: _arrays(reader, part, data[part]) for part in _ARRAYS}
    for name in _OF_NODES:
        # Files from versions without soft bodies do not have these arrays.
        arrays["state"].setdefault(name, np.zeros((0, 3)))
    for name in _OF_ACTUATORS:
        # Nor do those from versions without actuators have these.
        arrays["state"].setdefault(name, np.zeros(0))
    # Nor those from versions without sensors these.
    arrays["state"].setdefault("sensor_memory", np.zeros(0))
    if not any(name in arrays["state"] for name in _OF_LATE):
        # Nor those from versions without late velocities of links have these.
        bodies = [replace(body, late=late.get(body.id, 0)) for body in bodies]
    rows = sum(body.late for body in bodies)
    # A count that is damaged must not exhaust memory: no body has more of these than links.
    if not 0 <= rows <= len(arrays["state"].get("link_pose", ())):
        raise reader.fail("state.bodies", "does not have the rows of late_velocity")
    for name in _OF_LATE:
        arrays["state"].setdefault(name, np.zeros((rows, 6)))
    if "link_reaction" in arrays["state"]:
        arrays["state"].setdefault("link_load", np.zeros_like(arrays["state"]["link_reaction"]))
    if "dof_velocity" in arrays["state"]:
        for name in _OF_SENSORS:
            arrays["state"].setdefault(name, np.zeros(len(arrays["state"]["dof_velocity"])))
    _add_last_steps(arrays["state"])
    split_impulses(arrays["contacts"])
    add_overlaps(arrays["contacts"])
    add_breaking_distances(arrays["contacts"])
    add_resets(arrays["state"], arrays["contacts"])
    # Nor do files from the first versions with soft bodies have this array; the next step computes it.
    arrays["state"].setdefault("node_push", np.zeros_like(arrays["state"]["node_position"]))
    _check_counts(reader, bodies, arrays["state"])
    impulses = reader.array(
        data["user_impulses"], np.dtype(np.float64), (None, _USER_IMPULSES), "state.user_impulses"
    )
    return Snapshot(
        Layout.of(tuple(bodies)),
        reader.read(float, data["time"], "state.time"),
        reader.read(float, data["unspent_time"], "state.unspent_time"),
        arrays["state"],
        arrays["contacts"],
        impulses,
    )


def _add_last_steps(state: dict[str, np.ndarray]) -> None:
    """Add the motion in the last step, which older files do not have: it is not known."""
    for name in ("position", "dof_velocity"):
        if name in state:
            for end in ("before", "after"):
                state.setdefault(f"{name}_{end}", np.zeros_like(state[name]))
    if "tree_activity" in state:
        for name in ("tree_last_step", "tree_load_step"):
            state.setdefault(name, np.zeros((len(state["tree_activity"]), 4)))
        state.setdefault("tree_is_pushed", np.zeros_like(state["tree_activity"]))
    if "link_wrench" in state:
        for name in ("link_applied", "link_push"):
            state.setdefault(name, np.zeros_like(state["link_wrench"]))
    if "dof_velocity" in state:
        for name in ("dof_acceleration", "dof_coupling"):
            state.setdefault(name, np.zeros_like(state["dof_velocity"]))


def split_impulses(contacts: dict[str, np.ndarray]) -> None:
    """Move counters of warm starting to their own array; in older files they are a column of impulses."""
    impulses = contacts.get("contact_impulse")
    if impulses is not None and impulses.ndim == 2 and "contact_warm_start" not in contacts:
        contacts["contact_warm_start"] = impulses[:, 3:].ravel()
        contacts["contact_impulse"] = impulses[:, :3].copy()


def add_overlaps(contacts: dict[str, np.ndarray]) -> None:
    """Add the arrays of overlaps that older files do not have; the next step finds all overlaps."""
    counts = contacts.get("count_contacts")
    if counts is not None and counts.ndim == 1 and "overlap_place" not in contacts:
        counts[THERE + 1 :] = 0
        contacts["overlap_shapes"] = np.zeros((0, 2), dtype=np.int32)
        for name in ("overlap_place", "overlap_manifold", "overlap_sorted"):
            contacts[name] = np.zeros(0, dtype=np.int32)


def add_breaking_distances(contacts: dict[str, np.ndarray]) -> None:
    """Add the distances of manifolds that older files do not have: those of their shapes and links."""
    if "overlap_shapes" in contacts:
        for name, value in (("overlap_breaking", AS_SHAPES), ("overlap_solved_up_to", AS_LINKS)):
            contacts.setdefault(name, np.full(len(contacts["overlap_shapes"]), value))


def add_resets(state: dict[str, np.ndarray], contacts: dict[str, np.ndarray]) -> None:
    """Add the numbers of resets that older files do not have: nothing was reset."""
    counts = contacts.get("count_contacts")
    if counts is not None and counts.ndim == 1 and "tree_reset" not in state and "tree_activity" in state:
        contacts["count_contacts"] = np.append(counts[:RESETS], np.zeros(2, dtype=counts.dtype))
        state["tree_reset"] = np.zeros_like(state["tree_activity"])


def _check_counts(reader: Reader, bodies: list[BodyLayout], state: dict[str, np.ndarray]) -> None:
    """Check that the counts of bodies agree with the arrays, so that wrong counts cannot exhaust memory."""
    for axis, counts in (
        ("link_pose", [body.links for body in bodies]),
        ("position", [body.positions for body in bodies]),
        ("dof_velocity", [body.dofs for body in bodies]),
        ("node_position", [body.nodes for body in bodies]),
        ("actuator_control", [body.actuators for body in bodies]),
        ("sensor_memory", [body.sensors for body in bodies]),
        ("late_velocity", [body.late for body in bodies]),
    ):
        if axis not in state or min(counts, default=0) < 0 or sum(counts) != len(state[axis]):
            raise reader.fail("state.bodies", f"does not have the rows of {axis}")


def _arrays(reader: Reader, part: str, data: Any) -> dict[str, np.ndarray]:
    if not isinstance(data, dict):
        raise reader.fail(f"state.{part}", "is not an object")
    arrays = {}
    for name, record in data.items():
        where = f"state.{part}[{name!r}]"
        kind = record.get("array") if isinstance(record, dict) else None
        dtype = np.dtype(np.int32 if kind == "<i4" else np.float64)
        arrays[name] = reader.array(record, dtype, None, where, may_be_nan=name in _REPORTS)
    return arrays


def write_state(world: WorldCore, bodies: Sequence[BodyCore], snapshot: Snapshot, *, whole: bool) -> None:
    """Set bodies that were just loaded, in the order they were saved, to their state in a snapshot.

    They are the last of the world. If they are the `whole` of it, contacts, time and impulses of constraints
    are set as well.

    Raises:
        ValueError: The state does not fit the bodies.
    """
    present, saved = layout(world), snapshot.layout.bodies
    ours = present.bodies[len(present.bodies) - len(bodies) :]
    if [body.id for body in bodies] != [body.id for body in ours] or len(ours) != len(saved):
        raise ValueError("the state is that of other bodies")
    if any(a != b if whole else not a.moves_like(b) for a, b in zip(ours, saved, strict=True)):
        raise ValueError("the state is that of other bodies")
    check_arrays(world, bodies, snapshot)
    if whole:
        _return_to(world, present, snapshot)
        return
    others = take(world, Shape(present))
    for name, rows in others.state.items():
        if axis_of(name) != "tree":
            rows[len(rows) - len(snapshot.state[name]) :] = snapshot.state[name]
    world.contact_arrays.forget_contacts()
    _return_to(world, present, others)


def _return_to(world: WorldCore, present: Layout, snapshot: Snapshot) -> None:
    change = Change()
    return_to(change, world, Shape(present), snapshot)
    change.commit()


def check_arrays(world: WorldCore, bodies: Sequence[BodyCore], snapshot: Snapshot) -> None:
    """Raise `ValueError` unless the arrays of a snapshot from a file fit its bodies, in its order."""
    saved = snapshot.layout.bodies
    counts = snapshot.contacts["count_contacts"]
    if counts.ndim != 1 or len(counts) < CONTACT_COLUMNS:
        raise ValueError("array 'count_contacts' has the wrong shape")
    lengths = {
        "tree": len(saved),
        "link": sum(body.links for body in saved),
        "position": sum(body.positions for body in saved),
        "dof": sum(body.dofs for body in saved),
        "node": sum(body.nodes for body in saved),
        "actuator": sum(body.actuators for body in saved),
        "sensor": sum(body.sensors for body in saved),
        "late": sum(body.late for body in saved),
        JOINT_DOFS: len(snapshot.layout.joint_dofs),
        **counted_rows(counts),
    }
    example = take(world, Shape(layout(world)))
    axes = {name: axis_of(name) for name in example.state}
    axes |= {name: world.contact_arrays.contacts.axis_of(name) for name in example.contacts}
    for given, wanted in ((snapshot.state, example.state), (snapshot.contacts, example.contacts)):
        if given.keys() != wanted.keys():
            raise ValueError("an array of the state is missing or unknown")
        for name, array in given.items():
            length = lengths.get(axes[name], len(wanted[name]))
            if array.shape != (length, *wanted[name].shape[1:]) or array.dtype != wanted[name].dtype:
                raise ValueError(f"array {name!r} has the wrong shape")
    islands = snapshot.state["tree_island"]
    if islands.size and not 0 <= islands.min() <= islands.max() < len(saved):
        raise ValueError("an island number is out of range")
    for name in _BOUNDED:
        if not (np.abs(snapshot.state[name]) <= MAX_MAGNITUDE).all():
            raise ValueError(f"array {name!r} contains a number that is infinite, NaN or very large")
    _check_turns(bodies, snapshot)
    _check_contacts(world, snapshot)
    _check_overlaps(world, snapshot)


def _check_turns(bodies: Sequence[BodyCore], snapshot: Snapshot) -> None:
    """Check that orientations of links, bases and spherical joints are quaternions of about length 1."""
    turns = [snapshot.state["link_pose"][:, 3:]]
    first = 0
    for body, saved in zip(bodies, snapshot.layout.bodies, strict=True):
        places = [_BASE_TURN]
        for place, count in zip(body.position_index, body.position_count, strict=True):
            if count == _QUATERNION:
                places.append(place - body.first_position)
        for place in places:
            turn = snapshot.state["position"][first + place : first + place + _QUATERNION]
            turns.append(turn[None])
        first += saved.positions
    lengths = np.square(np.concatenate(turns)).sum(axis=1)
    if (np.abs(lengths - 1.0) > _UNIT_TOLERANCE).any():
        raise ValueError("a quaternion does not have length 1")


def _check_contacts(world: WorldCore, snapshot: Snapshot) -> None:
    """Check that contacts refer to shapes that exist, and to their links."""
    shapes, links = np.hsplit(snapshot.contacts["contact_shapes"], 2)
    if not shapes.size:
        return
    if shapes.min() < 0 or shapes.max() >= world.contact_arrays.shapes.shape_count:
        raise ValueError("a contact refers to a shape that does not exist")
    if (world.contact_arrays.shapes.table.numpy["shape_link"][shapes] != links).any():
        raise ValueError("a contact refers to a link that does not have its shape")


def _check_overlaps(world: WorldCore, snapshot: Snapshot) -> None:
    """Check that overlaps refer to shapes that exist, are sorted, and have one place each in both orders."""
    shape_count = world.contact_arrays.shapes.shape_count
    if not 0 <= snapshot.contacts["count_contacts"][KNOWN] <= shape_count:
        raise ValueError("the number of known shapes is out of range")
    first, second = snapshot.contacts["overlap_shapes"].astype(np.int64).T
    if not len(first):
        return
    if first.min() < 0 or second.max() >= shape_count or (first >= second).any():
        raise ValueError("an overlap refers to a shape that does not exist")
    if (np.diff(first * shape_count + second) <= 0).any():
        raise ValueError("the overlaps are not sorted")
    manifolds = snapshot.contacts["overlap_manifold"]
    for places in (snapshot.contacts["overlap_place"], manifolds[manifolds != NO_MANIFOLD]):
        if (np.sort(places) != np.arange(len(places))).any():
            raise ValueError("the places of overlaps are not all different")
