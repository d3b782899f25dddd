"""Files of many worlds: the file of their scene, and what each world has of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.layouts.contacts import COUNTED, Contacts
from carom.layouts.types import STATE
from carom.model.placed_pieces import MOST_PATHS
from carom.native.tables import ArrayTable, fields_of
from carom.render.appearance import appearance_of
from carom.render.world_looks import looks_of
from carom.scene.snapshot import Layout, Shape, Snapshot, counted_rows, layout, take
from carom.world.world import World
from carom.world_files.records import Reader, Writer
from carom.world_files.saved_state import check_arrays
from carom.world_files.world_file import (
    document_of,
    load_world,
    refuse_endings_of_others,
    save_document,
)
from carom.worlds.checkpoint import parameters_of, set_parameters
from carom.worlds.lone import lone_world, refill
from carom.worlds.saved import SavedWorlds

if TYPE_CHECKING:
    from carom.worlds.worlds import Worlds

_FIELDS = {"count", "times", "unspent_times", "halted", "sensor_seeds", "state", "contacts", "impulses"}
_FIELDS |= {"parameters", "looks"}
# Parameters that are no real numbers, and their greatest values.
_SWITCHES = {"tree_joint_terms": 1, "shape_friction_dimensions": 6, "user_enabled": 1}
_SWITCHES |= {"shape_path": MOST_PATHS - 1}
# Lengths, which are not negative; those of planes are normals.
_LENGTHS = {"shape_size", "shape_margin", "shape_breaking", "link_extents"}
_PARTS = ("state", "contacts")
_COUNTS = "count_contacts"


class ManyStates(NamedTuple):
    """What a file says of many worlds beside their scene.

    Attributes:
        snapshots: The state of each.
        halted: Which are halted, (count,).
        sensor_seeds: Seeds of the noise of their sensors.
        parameters: Those that differ between worlds, by table and field, (count, ...).
        looks: Colours (count, 4) by number of body, link and visible shape; textures likewise, as numbers of
            images, -1 for none.
    """

    snapshots: list[Snapshot]
    halted: np.ndarray
    sensor_seeds: list[int]
    parameters: dict[str, dict[str, np.ndarray]]
    looks: dict[str, Any]


# Writing


def save_worlds(worlds: Worlds, path: Path) -> None:
    """Write all worlds to a file, as `Worlds.save` does."""
    refuse_endings_of_others(path)
    scene, writer = worlds._scene, Writer()
    document = document_of(scene, writer)
    document["worlds"] = _written(worlds, writer)

    def check(reader: Reader, saved: dict[str, Any]) -> None:
        read_many(reader, saved["worlds"], scene)

    save_document(document, writer, path, check)


def _written(worlds: Worlds, writer: Writer) -> dict[str, Any]:
    states: dict[str, dict[str, list[np.ndarray]]] = {part: {} for part in _PARTS}
    impulses = []
    for snapshot in _snapshots(worlds):
        for part in _PARTS:
            for name, rows in getattr(snapshot, part).items():
                states[part].setdefault(name, []).append(rows)
        impulses.append(snapshot.user_impulses)
    own = parameters_of(worlds._engine)
    return {
        "count": worlds.count,
        "times": writer.write(worlds.time.copy()),
        "unspent_times": writer.write(worlds._unspent_times.copy()),
        "halted": writer.write(worlds.halted.copy()),
        "sensor_seeds": worlds.sensor_seeds.tolist(),
        # Of contacts each world has as many rows as it has contacts.
        "state": {name: writer.write(np.stack(rows)) for name, rows in states["state"].items()},
        "contacts": {
            name: writer.write(np.stack(rows) if name == _COUNTS else np.concatenate(rows))
            for name, rows in states["contacts"].items()
        },
        "impulses": writer.write(np.stack(impulses)),
        "parameters": {
            table: {name: writer.write(array) for name, array in fields.items() if _differs(name, array)}
            for table, fields in own.items()
        },
        "looks": writer.write(looks_of(worlds._scene, worlds.count).kept()),
    }


def _differs(name: str, array: np.ndarray) -> bool:
    return len(array) > 1 and (array.dtype.kind == "f" or name in _SWITCHES)


def _snapshots(worlds: Worlds) -> Iterator[Snapshot]:
    """The state of each world; arrays of one are copied before the next."""
    engine = worlds._engine
    lone = lone_world(worlds._scene, engine, 0, 0.0, 0.0)
    for number in range(worlds.count):
        refill(lone, engine, number, parameters=False)
        yield take(lone, Shape(layout(lone)))


# Reading


def load_worlds(kind: type[Worlds], path: Path, device: Any, threads: int | None) -> Worlds:
    """The worlds in a file, as `Worlds.load` gives them."""
    world = World()
    found: list[ManyStates] = []
    load_world(world, path, lambda reader, data: found.append(read_many(reader, data, world)))
    (many,) = found
    worlds = kind(world, len(many.snapshots), device=device, threads=threads)
    parameters = parameters_of(worlds._engine)
    for table, fields in many.parameters.items():
        for name, given in fields.items():
            # Tables have room for more rows, here perhaps for others than there.
            own = parameters[table][name]
            rows = min(own.shape[1], given.shape[1])
            parameters[table][name] = np.broadcast_to(own, (worlds.count, *own.shape[1:])).copy()
            parameters[table][name][:, :rows] = given[:, :rows]
    set_parameters(worlds._engine, parameters)
    _give_states(worlds, world, many)
    looks_of(worlds._scene, worlds.count).take(many.looks)
    worlds.halted[:], worlds.sensor_seeds[:] = many.halted, many.sensor_seeds
    worlds.set_start()
    return worlds


def _give_states(worlds: Worlds, world: World, many: ManyStates) -> None:
    """Give each world its state: those of `many`, put into a lone world with the same bodies."""
    for number, snapshot in enumerate(many.snapshots):
        world.restore(snapshot)
        state, contacts = world.arrays.state, world.contact_arrays.contacts
        own = {name: _fitted(array, worlds._engine.arrays.state, name) for name, array in _of(state).items()}
        own_contacts = {name: array.copy() for name, array in _of(contacts).items()}
        times = np.array([snapshot.time]), np.array([snapshot.unspent_time])
        saved = SavedWorlds(np.array([number]), *times, own, own_contacts)
        worlds._put_back(saved, np.array([number]), np.zeros(1, dtype=np.int64))


def _of(table: ArrayTable) -> dict[str, np.ndarray]:
    return table.of_kind(STATE)


def _fitted(array: np.ndarray, table: ArrayTable, name: str) -> np.ndarray:
    """Rows of a lone world, which has room for more, as many worlds have them."""
    return array[:, : table.numpy[name].shape[1]].copy()


def read_many(reader: Reader, data: Mapping[str, Any], world: World) -> ManyStates:
    """What a file says of many worlds whose scene a world has.

    Raises:
        DescriptionError, ValueError: It makes no sense, or does not fit the bodies.
    """
    if not data.keys() == _FIELDS:
        raise reader.fail("worlds", "does not have the fields of many worlds")
    count = reader.read(int, data["count"], "worlds.count")
    if count < 1:
        raise reader.fail("worlds.count", "is less than 1")
    real = np.dtype(np.float64)
    times = reader.array(data["times"], real, (count,), "worlds.times")
    unspent = reader.array(data["unspent_times"], real, (count,), "worlds.unspent_times")
    halted = reader.array(data["halted"], np.dtype(bool), (count,), "worlds.halted")
    seeds = reader.read(list[int], data["sensor_seeds"], "worlds.sensor_seeds")
    if len(seeds) != count:
        raise reader.fail("worlds.sensor_seeds", f"has {len(seeds)} numbers for {count} worlds")
    if not (np.isfinite(times).all() and np.isfinite(unspent).all()):
        raise reader.fail("worlds.times", "has a number that is not finite")
    present = layout(world)
    example = take(world, Shape(present))
    impulses = reader.array(data["impulses"], real, (count, *example.user_impulses.shape), "worlds.impulses")
    states = _read_states(reader, data, count, example)
    snapshots = []
    for number, (state, contacts) in enumerate(states):
        clock = float(times[number]), float(unspent[number])
        snapshots.append(_checked(world, present, clock, state, contacts, impulses[number]))
    return ManyStates(
        snapshots,
        halted,
        seeds,
        _read_parameters(reader, data["parameters"], count, world),
        _read_looks(reader, data["looks"], count, world),
    )


def _checked(
    world: World,
    present: Layout,
    clock: tuple[float, float],
    state: dict[str, np.ndarray],
    contacts: dict[str, np.ndarray],
    impulses: np.ndarray,
) -> Snapshot:
    law = world.law_of_contacts
    snapshot = Snapshot(present, *clock, state, contacts, impulses, contact=law)
    check_arrays(world, [*world.bodies.values()], snapshot)
    return snapshot


def _read_states(
    reader: Reader, data: Mapping[str, Any], count: int, example: Snapshot
) -> Iterator[tuple[dict[str, np.ndarray], dict[str, np.ndarray]]]:
    """The arrays of each world, of which an example has types and shapes."""
    for part in _PARTS:
        given = data[part]
        if not isinstance(given, dict) or given.keys() != getattr(example, part).keys():
            raise reader.fail(f"worlds.{part}", "does not have the arrays of a state")
    states = {
        name: reader.array(
            data["state"][name], like.dtype, (count, *like.shape), f"worlds.state.{name}", may_be_nan=True
        )
        for name, like in example.state.items()
    }
    contacts = {
        name: reader.array(
            data["contacts"][name],
            like.dtype,
            (count if name == _COUNTS else None, *like.shape[name != _COUNTS :]),
            f"worlds.contacts.{name}",
        )
        for name, like in example.contacts.items()
    }
    return _split(reader, states, contacts, count, example)


def _split(
    reader: Reader,
    states: dict[str, np.ndarray],
    contacts: dict[str, np.ndarray],
    count: int,
    example: Snapshot,
) -> Iterator[tuple[dict[str, np.ndarray], dict[str, np.ndarray]]]:
    axes = {name: fields_of(Contacts)[name].axis for name in contacts}
    begun = dict.fromkeys(contacts, 0)
    for number in range(count):
        rows = counted_rows(contacts[_COUNTS][number])
        if any(length < 0 for length in rows.values()):
            raise reader.fail("worlds.contacts", "counts less than 0 rows")
        own = {_COUNTS: contacts[_COUNTS][number]}
        for name, array in contacts.items():
            if name != _COUNTS:
                length = rows[axes[name]] if axes[name] in COUNTED else len(example.contacts[name])
                own[name] = array[begun[name] : begun[name] + length]
                begun[name] += length
        ordered = {name: own[name] for name in contacts}
        yield {name: array[number] for name, array in states.items()}, ordered


def _read_parameters(reader: Reader, data: Any, count: int, world: World) -> dict[str, dict[str, np.ndarray]]:
    tables = {
        "model": world.arrays.model,
        "shapes": world.contact_arrays.shapes.table,
        "users": world.contact_arrays.users,
    }
    if not isinstance(data, dict) or data.keys() != tables.keys():
        raise reader.fail("worlds.parameters", "does not have the tables of parameters")
    found: dict[str, dict[str, np.ndarray]] = {}
    for table, own in tables.items():
        if not isinstance(data[table], dict):
            raise reader.fail(f"worlds.parameters.{table}", "is not an object")
        found[table] = {}
        for name, given in data[table].items():
            where = f"worlds.parameters.{table}.{name}"
            known = name in own.numpy and own.is_per_world(name)
            if not known or (own.numpy[name].dtype.kind != "f" and name not in _SWITCHES):
                raise reader.fail(where, "is no parameter that differs between worlds")
            like = own.numpy[name]
            array = reader.array(given, like.dtype, (count, None, *like.shape[2:]), where)
            if name in _SWITCHES and not ((array >= 0) & (array <= _SWITCHES[name])).all():
                raise reader.fail(where, "has a number that is out of range")
            if name in _LENGTHS and _has_negative(array, own, name):
                raise reader.fail(where, "has a length less than 0")
            found[table][name] = array
    return found


def _has_negative(array: np.ndarray, own: ArrayTable, name: str) -> bool:
    """Whether a length (count, rows, ...) is negative, and in no world may be: normals of planes may."""
    of_scene = own.numpy[name][:, : array.shape[1]]
    return bool(((array[:, : of_scene.shape[1]] < 0.0) & (of_scene >= 0.0)).any())


def _read_looks(reader: Reader, data: Any, count: int, world: World) -> dict[str, Any]:
    if not isinstance(data, dict) or data.keys() != {"images", "colours", "textures"}:
        raise reader.fail("worlds.looks", "does not have colours and textures")
    pixels = np.dtype(np.uint8)
    images = [
        reader.array(each, pixels, (None, None, 3), place)
        for place, each in reader.items(data["images"], "worlds.looks.images")
    ]
    shown = appearance_of(world)
    found: dict[str, Any] = {"images": images, "colours": [], "textures": []}
    kinds = {"colours": (np.dtype(np.float64), (count, 4)), "textures": (np.dtype(np.int32), (count,))}
    for name, (dtype, shape) in kinds.items():
        for where, record in reader.items(data[name], f"worlds.looks.{name}"):
            if not isinstance(record, list) or len(record) != 2:
                raise reader.fail(where, "is no place with its values")
            body, link, look = reader.read(tuple[int, int, int], record[0], where)
            values = reader.array(record[1], dtype, shape, where)
            known = body in world.bodies and -1 <= link < world.bodies[body].joint_count
            if not known or not 0 <= look < len(shown.shapes(world.bodies[body], link)):
                raise reader.fail(where, "is of a shape that does not exist")
            least, greatest = (0.0, 1.0) if name == "colours" else (-1, len(images) - 1)
            if not ((values >= least) & (values <= greatest)).all():
                raise reader.fail(where, "has a number that is out of range")
            found[name].append(((body, link, look), values))
    return found
