"""Saving and loading worlds completely, from meshes to the impulses of contacts.

`docs/world-files.md` describes the format; `container.py` and `records.py` are its lower layers.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.description.pose import IDENTITY
from carom.engine.parameters import check_contact
from carom.errors import DescriptionError, StateError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.formats.bullet import is_bullet
from carom.model.body_spec import BASE
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.changes import append_now, free_base
from carom.scene.draft import draft_of
from carom.scene.dynamics.changes import change_dynamics
from carom.scene.snapshot import check_same, layout
from carom.world_files import saved_looks
from carom.world_files.bullet_state import refuse_to_load, restore_bullet
from carom.world_files.check import check_body, check_finite
from carom.world_files.container import packed, unpacked
from carom.world_files.files import restored
from carom.world_files.records import Reader, Writer
from carom.world_files.saved_constraints import put_on_bodies
from carom.world_files.saved_state import check_arrays, read_state, state_of, write_state
from carom.world_files.saved_world import SavedBody, SavedWorld, described, index_in, late_links_of
from carom.writing import write_whole

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore
    from carom.world.world import World

# Endings of files that are read by what they say, and that others read.
_ENDINGS_OF_OTHERS = frozenset(
    (".xml", ".mjcf", ".urdf", ".sdf", ".xacro", ".usd", ".usda", ".usdc", ".usdz")
)


def save_world(world: WorldCore, path: Path) -> None:
    """Write a world to a file, as `World.save` does.

    Raises:
        StateError: It could not be loaded again; the message says why. No file is written.
    """
    writer = Writer()
    save_document(document_of(world, writer), writer, path, _check_state(world))


def refuse_endings_of_others(path: Path) -> None:
    """Raise `ValueError` for the ending of a robot's file: it would not have what its name says."""
    if path.suffix.lower() in _ENDINGS_OF_OTHERS:
        raise ValueError(
            f"{path.name}: `save` writes Carom's own file, with all of the state: end its name in .carom, as "
            f"{path.stem}.carom. MJCF, URDF, SDF and USD are written by the description of what `load` "
            f"returns: scene.description.write({path.name!r})"
        )


def document_of(world: WorldCore, writer: Writer) -> dict[str, Any]:
    """Everything of a world but the list of files, which `save_document` adds."""
    return {
        "world": writer.write(described(world)),
        "state": writer.write(state_of(world)),
        "parts": {"looks": saved_looks.save(world, writer)},
    }


def save_document(
    document: dict[str, Any],
    writer: Writer,
    path: Path,
    check: Callable[[Reader, dict[str, Any]], object],
) -> None:
    """Write a document to a file, after the checks of those who load it.

    Raises:
        StateError: It would be refused; no file is written.
    """
    document["files"] = writer.files.records
    files = [Path(record["path"]) for record in writer.files.records]
    reader = Reader(path, memoryview(writer.blocks.joined()), files)
    try:
        with reading(path, untyped=True):
            _checked(reader, document)
            check(reader, document)
    except DescriptionError as problem:
        raise StateError(
            f"the world is not saved, since it could not be loaded: {problem.reason}"
        ) from problem
    write_whole(path, packed(document, writer.blocks))


def _check_state(world: WorldCore) -> Callable[[Reader, dict[str, Any]], None]:
    def check(reader: Reader, document: dict[str, Any]) -> None:
        check_arrays(world, list(world.bodies.values()), read_state(reader, document["state"]))

    return check


@gated("call_lock")
def load_world(
    world: WorldCore,
    path: Path,
    of_many: Callable[[Reader, Mapping[str, Any]], object] | None = None,
) -> list[Body]:
    """Add the bodies of a file to a world, as `World.load` does.

    Args:
        world: The world.
        path: The file.
        of_many: If the file is to be one of `Worlds`, what reads what it has of these, once the bodies are
            there.
    """
    with reading(path, untyped=True):
        data, _ = read_bounded(path, "world_bytes")
        refuse_to_load(data, path)
        document, reader, saved = _read(data, path)
        many = _many(document, path, wanted=of_many is not None)
        with uninterrupted:
            draft = draft_of(world)
            saved_looks.begin(world, draft.world)
            bodies = _load(draft.world, document, reader, saved)
            draft.measure(bodies)
            change = Change()
            saved_looks.publish(change, world, draft.world)
            draft.publish(change)
        if of_many is not None:
            of_many(reader, many)
        return bodies


def _many(document: dict[str, Any], path: Path, *, wanted: bool) -> Mapping[str, Any]:
    """What a file says of many worlds, empty if it is to have none.

    Raises:
        DescriptionError: It has one world where many are wanted, or the other way round.
    """
    many = document.get("worlds")
    if wanted and not isinstance(many, dict):
        raise DescriptionError(
            "it has one world, and not many: world.load(path) loads it, and Worlds(world, count) copies it",
            file=path,
        )
    if many is not None and not wanted:
        raise DescriptionError("it has many worlds: carom.Worlds.load(path) loads them", file=path)
    return many or {}


def _load(world: WorldCore, document: dict[str, Any], reader: Reader, saved: SavedWorld) -> list[Body]:
    """Add the bodies of a file to the draft of a world."""
    state = read_state(reader, document.get("state"), late_links_of(saved))
    alone = not world.bodies
    bodies = _append(world, saved, alone)
    saved_looks.load(bodies, reader, document["parts"]["looks"])
    state.contact = saved.parameters.contact
    if alone:
        # By which the contacts of the state remember impulses.
        world.law_of_contacts = saved.parameters.contact
    write_state(world, bodies, state, whole=alone)
    if alone:
        world.free_ids, world.next_id = saved.free_ids, saved.next_id
        world.links_loaded = saved.links_loaded or world.links_loaded
        world.user_constraints.next_id = saved.next_tie
        world.parameters = saved.parameters
        world.apply_parameters()
    world.scene_changed()
    return bodies


def restore_world(
    world: World, path: Path, *, update_poses: bool = False, maximal: Collection[int] = ()
) -> None:
    """Restore the state in a file, as `World.restore` does.

    Raises:
        DescriptionError: The file cannot be used; the world is as it was.
        StateError: The world has other bodies; it is as it was.
    """
    with reading(path, untyped=True):
        data, _ = read_bounded(path, "world_bytes")
        if is_bullet(data):
            restore_bullet(world, data, path, maximal=maximal, update_poses=update_poses)
            return
        document, reader, saved = _read(data, path)
        _many(document, path, wanted=False)
        snapshot = read_state(reader, document.get("state"), late_links_of(saved))
        snapshot.contact = saved.parameters.contact
        check_same(snapshot.layout, layout(world))
        check_arrays(world, [world.bodies[body.id] for body in snapshot.layout.bodies], snapshot)
        world.restore(snapshot, update_poses=update_poses)


def _read(data: bytes, path: Path) -> tuple[dict[str, Any], Reader, SavedWorld]:
    document, blocks = unpacked(data, path)
    reader = Reader(path, blocks, restored(document.get("files"), blocks, path))
    return document, reader, _checked(reader, document)


def _checked(reader: Reader, document: dict[str, Any]) -> SavedWorld:
    """The world in a document, without the state; DescriptionError or ValueError if it makes no sense."""
    saved = reader.record(SavedWorld, document.get("world"), "world")
    for spec in saved.specs:
        check_body(spec)
    check_finite(saved.parameters, "parameters")
    check_contact(saved.parameters.contact)
    for name in ("bodies", "constraints", "ties"):
        check_finite(getattr(saved, name), name)
    return saved


def _append(world: WorldCore, saved: SavedWorld, alone: bool) -> list[Body]:
    """Add the bodies, constraints, filters and texts, without appearance and state."""
    bodies: dict[int, Body] = {}
    for record in saved.bodies:
        if record.id in bodies or not 0 <= record.id < saved.next_id:
            raise ValueError(f"the number {record.id} of a body is used twice or out of range")
        if alone:
            world.free_ids = [*world.free_ids, record.id]
        bodies[record.id] = append_now(world, saved.specs[index_in(record.spec, saved.specs)], IDENTITY)
        _give_dynamics(bodies[record.id], record)
    put_on_bodies(world, saved, bodies, alone)
    return list(bodies.values())


def _give_dynamics(body: BodyCore, record: SavedBody) -> None:
    count = 1 + body.joint_count
    if not len(record.links) == len(record.groups) == len(record.masks) == len(record.sensors) + 1 == count:
        raise ValueError(f"body {record.id} has {count} links, but a list of another length")
    if record.links_before is not None:
        body.links_before = record.links_before
    if record.fixed_base != body.fixed_base:
        free_base(body.world, body, free=not record.fixed_base)
    for place in range(count):
        body.set_dynamics(place - 1, record.links[place])
        body.world.contact_arrays.shapes.set_group_and_mask(
            body.first_link + place, record.groups[place], record.masks[place]
        )
    for joint, enabled in enumerate(record.sensors):
        if enabled:
            body.set_sensor(joint, True)
    damping = {
        "linear_damping": record.linear_damping,
        "angular_damping": record.angular_damping,
        "max_joint_velocity": record.max_velocity,
        "sleep_threshold": record.sleep_threshold,
    }
    change_dynamics(body, BASE, damping)
    model = body.world.arrays.model.numpy
    model["tree_can_sleep"][body.rows.tree] = record.can_sleep
    model["tree_can_wake"][body.rows.tree] = record.can_wake
