"""Saving and loading worlds completely, from meshes to the impulses of contacts.

`docs/world-files.md` describes the format; `container.py` and `records.py` are its lower layers.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

from carom.description.compliance import PairContact
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.tendon import WORLD, PathPart, TendonSpec
from carom.engine.parameters import EngineParameters, check_contact
from carom.errors import DescriptionError, StateError
from carom.formats.boundary import reading
from carom.formats.bullet import is_bullet
from carom.formats.files import read_bounded
from carom.layouts.codes import (
    LIMIT_KIND,
    MOTOR_KIND,
    WITH_FRICTION,
    ConstraintKind,
    JointCode,
    PathKind,
    UserConstraintKind,
)
from carom.lazy_dataclasses import dataclass, field, fields
from carom.model.body_spec import BASE, BodySpec
from carom.model.builder import late_links
from carom.model.link_dynamics import LinkDynamics
from carom.model.soft_spec import Anchor
from carom.native.change import Change
from carom.native.gates import alone
from carom.native.uninterrupted import uninterrupted
from carom.scene.actuators.actuated_joint import actuated_joint
from carom.scene.changes import append_now, free_base
from carom.scene.core.soft_core import SoftCore
from carom.scene.draft import draft_of
from carom.scene.dynamics_changes import change_dynamics
from carom.scene.joint_constraints import JointConstraint
from carom.scene.snapshot import check_same, layout
from carom.scene.user_constraints import UserConstraint
from carom.scene.user_data import UserDatum
from carom.version import __version__
from carom.world_files.bullet_state import refuse_to_load, restore_bullet
from carom.world_files.check import check_body, check_finite
from carom.world_files.container import packed, unpacked
from carom.world_files.files import restored
from carom.world_files.records import Reader, Writer
from carom.world_files.saved_state import check_arrays, read_state, state_of, write_state
from carom.writing import write_whole

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore
    from carom.world.world import World

_NONE = -1
# Exceptions that the engine may raise while it loads a document with invalid content.


class Part(Protocol):
    """Interface of a package above the engine that keeps data in world files."""

    def save(self, world: WorldCore, writer: Writer) -> Any:
        """The data for the file, in the form that `Writer.write` returns."""
        ...

    def begin(self, world: WorldCore, draft: WorldCore) -> None:
        """Give the draft of a world what the world has."""
        ...

    def load(self, bodies: Sequence[BodyCore], reader: Reader, data: Any) -> None:
        """Apply the saved data to bodies that have just been loaded into the draft of a world."""
        ...

    def publish(self, change: Change, world: WorldCore, draft: WorldCore) -> None:
        """Give a world what its draft has, with a change."""
        ...


Parts = Mapping[str, Part]
"""Parts of a file besides the world itself, by name; a module with `save` and `load` can be a part."""


@dataclass(slots=True)
class SavedBody:
    """One body; `spec` is an index in `SavedWorld.specs`.

    `links`, `groups` and `masks` have an entry for each link, the base first; `sensors` one for each joint.
    By `links_before` the window chooses the body's colours; earlier files do not have it.
    """

    id: int
    spec: int
    fixed_base: bool
    linear_damping: float
    angular_damping: float
    max_velocity: float
    can_sleep: bool
    can_wake: bool
    sleep_threshold: float
    links: list[LinkDynamics]
    groups: list[int]
    masks: list[int]
    sensors: list[bool]
    links_before: int | None = None


@dataclass(slots=True)
class SavedConstraint:
    """One motor, limit or user constraint; `user` is the number of the user constraint, or -1."""

    body: int
    joint: int
    kind: ConstraintKind
    lower: float
    upper: float
    twist: float
    max_impulse: float
    user: int
    actuator: int = 0


@dataclass(slots=True)
class SavedTie:
    """One user constraint; bodies by number, `child` -1 for the world. See `UserConstraint`."""

    id: int
    kind: UserConstraintKind
    parent: int
    parent_link: int
    child: int
    child_link: int
    axis: Vector3
    parent_frame: Pose
    child_frame: Pose
    max_impulse: float
    max_force: float
    gear_ratio: float
    gear_auxiliary_link: int
    relative_position_target: float
    erp: float
    enabled: bool = True
    polynomial: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    name: str = ""
    path: tuple[PathPart, ...] = ()
    second_path: tuple[PathPart, ...] = ()
    actuator: int = -1
    is_wrench: bool = False
    spring: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    range: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    reference: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    impedance: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    inverse_inertia: float = 0.0
    armature: float = 0.0


@dataclass(slots=True)
class SavedAnchor:
    """One anchored node of a soft body; `body` is -1 for the world. See `soft_arrays.Anchor`."""

    id: int
    soft: int
    node: int
    body: int
    link: int
    pivot: Vector3
    damped: bool = True
    late_force: float = 0.0


@dataclass(slots=True)
class SavedFilter:
    """Two links between which a user has switched collisions on or off."""

    body_a: int
    link_a: int
    body_b: int
    link_b: int
    enabled: bool
    contact: PairContact | None = None


@dataclass(slots=True)
class SavedWorld:
    """Everything except the state and the parts of packages above the engine.

    Attributes:
        carom: Version of Carom that wrote the file.
        parameters: Parameters of the engine.
        specs: Specifications of bodies; several bodies may share one.
        bodies: The bodies in the order of their rows.
        free_ids: Numbers of removed bodies, to be reused; the next one is the last.
        next_id: The lowest number that no body has had.
        objects: BodyCore and link, the base being 0, in the order of Bullet's list of objects.
        constraints: All constraints in the order of the solver's list.
        ties: The user constraints.
        next_tie: The number of the next user constraint.
        filters: Pairs of links whose collisions a user has switched on or off.
        user_data: Texts attached to bodies.
        anchors: Anchors of nodes of soft bodies.
        links_loaded: See `World`; earlier files do not have it.
    """

    carom: str
    parameters: EngineParameters
    specs: list[BodySpec]
    bodies: list[SavedBody]
    free_ids: list[int]
    next_id: int
    objects: list[tuple[int, int]]
    constraints: list[SavedConstraint]
    ties: list[SavedTie]
    next_tie: int
    filters: list[SavedFilter]
    user_data: list[UserDatum]
    anchors: list[SavedAnchor] = field(default_factory=list)
    links_loaded: int | None = None


def save_world(world: WorldCore, path: Path, parts: Parts) -> None:
    """Write a world to a file, as `World.save` does.

    Raises:
        StateError: It could not be loaded again; the message says why. No file is written.
    """
    writer = Writer()
    document = {
        "world": writer.write(_saved(world)),
        "state": writer.write(state_of(world)),
        "parts": {name: part.save(world, writer) for name, part in parts.items()},
    }
    document["files"] = writer.files.records
    _check_saved(world, path, document, writer)
    write_whole(path, packed(document, writer.blocks))


def _check_saved(world: WorldCore, path: Path, document: dict[str, Any], writer: Writer) -> None:
    """Raise `StateError` if what is to be saved would be refused by those who load it."""
    files = [Path(record["path"]) for record in writer.files.records]
    reader = Reader(path, memoryview(writer.blocks.joined()), files)
    try:
        with reading(path, untyped=True):
            _checked(reader, document)
            check_arrays(world, list(world.bodies.values()), read_state(reader, document["state"]))
    except DescriptionError as problem:
        raise StateError(
            f"the world is not saved, since it could not be loaded: {problem.reason}"
        ) from problem


@alone("call_lock")
def load_world(world: WorldCore, path: Path, parts: Parts) -> list[Body]:
    """Add the bodies of a file to a world, as `World.load` does."""
    with reading(path, untyped=True):
        data, _ = read_bounded(path, "world_bytes")
        refuse_to_load(data, path)
        document, reader, saved = _read(data, path)
        with uninterrupted:
            draft = draft_of(world)
            for part in parts.values():
                part.begin(world, draft.world)
            bodies = _load(draft.world, document, reader, saved, parts)
            draft.measure(bodies)
            change = Change()
            for part in parts.values():
                part.publish(change, world, draft.world)
            draft.publish(change)
        return bodies


def _load(
    world: WorldCore, document: dict[str, Any], reader: Reader, saved: SavedWorld, parts: Parts
) -> list[Body]:
    """Add the bodies of a file to the draft of a world."""
    state = read_state(reader, document.get("state"), _late_links(saved))
    alone = not world.bodies
    bodies = _append(world, saved, alone)
    for name, part in parts.items():
        part.load(bodies, reader, document["parts"][name])
    write_state(world, bodies, state, whole=alone)
    if alone:
        world.free_ids, world.next_id = saved.free_ids, saved.next_id
        world.links_loaded = saved.links_loaded or world.links_loaded
        world.user_constraints.next_id = saved.next_tie
        world.parameters = saved.parameters
        world.law_of_contacts = saved.parameters.contact
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
        snapshot = read_state(reader, document.get("state"), _late_links(saved))
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


def _saved(world: WorldCore) -> SavedWorld:
    bodies = list(world.bodies.values())
    specs = list({id(body.spec): body.spec for body in bodies}.values())
    places = {id(spec): place for place, spec in enumerate(specs)}
    owners = {
        body.first_link + link: (body.id, link - 1) for body in bodies for link in range(1 + body.joint_count)
    }
    return SavedWorld(
        carom=__version__,
        parameters=world.parameters,
        specs=specs,
        bodies=[_saved_body(body, places[id(body.spec)]) for body in bodies],
        free_ids=world.free_ids,
        next_id=world.next_id,
        objects=cast("list[tuple[int, int]]", world.constraints.tags.links),
        constraints=[_saved_constraint(constraint) for constraint in world.constraints.all],
        ties=[_saved_tie(tie) for tie in world.user_constraints.all],
        next_tie=world.user_constraints.next_id,
        filters=[
            SavedFilter(*owners[a], *owners[b], enabled, contact)
            for a, b, enabled, contact in world.contact_arrays.shapes.filters.all
        ],
        user_data=[datum for body in bodies for datum in world.user_data.of_body(body.id)],
        anchors=[
            SavedAnchor(
                anchor.id,
                body.id,
                anchor.node,
                _holder(world, anchor),
                anchor.link,
                anchor.pivot,
                anchor.damped,
                anchor.late_force,
            )
            for body in bodies
            if isinstance(body, SoftCore)
            for anchor in body.anchors
        ],
        links_loaded=world.links_loaded,
    )


def _holder(world: WorldCore, anchor: Anchor) -> int:
    """The number of the body that holds a node; -1 for the world."""
    return next((body.id for body in world.bodies.values() if body.rows is anchor.body), _NONE)


def _saved_body(body: BodyCore, spec: int) -> SavedBody:
    model = body.world.arrays.model.numpy
    shapes = body.world.contact_arrays.shapes.table.numpy
    tree, links = body.rows.tree, slice(body.first_link, body.first_link + 1 + body.joint_count)
    return SavedBody(
        body.id,
        spec,
        body.fixed_base,
        float(model["tree_linear_damping"][0, tree]),
        float(model["tree_angular_damping"][0, tree]),
        float(model["tree_max_velocity"][0, tree]),
        bool(model["tree_can_sleep"][tree]),
        bool(model["tree_can_wake"][tree]),
        float(model["tree_sleep_threshold"][tree]),
        [body.dynamics(link) for link in range(BASE, body.joint_count)],
        shapes["link_group"][links].tolist(),
        shapes["link_mask"][links].tolist(),
        [body.has_sensor(joint) for joint in range(body.joint_count)],
        body.links_before,
    )


def _saved_constraint(it: JointConstraint) -> SavedConstraint:
    user = _NONE if it.user is None else it.user.id
    limits = it.lower, it.upper, it.twist
    return SavedConstraint(it.body.id, it.joint, it.kind, *limits, it.max_impulse, user, it.actuator)


def _saved_tie(tie: UserConstraint) -> SavedTie:
    values = {field.name: getattr(tie, field.name) for field in fields(SavedTie)}
    values["parent"] = tie.parent.id
    values["child"] = _NONE if tie.child is None else tie.child.id
    return SavedTie(**values)


def _append(world: WorldCore, saved: SavedWorld, alone: bool) -> list[Body]:
    """Add the bodies, constraints, filters and texts, without appearance and state."""
    bodies: dict[int, Body] = {}
    for record in saved.bodies:
        if record.id in bodies or not 0 <= record.id < saved.next_id:
            raise ValueError(f"the number {record.id} of a body is used twice or out of range")
        if alone:
            world.free_ids = [*world.free_ids, record.id]
        bodies[record.id] = append_now(world, saved.specs[_index(record.spec, saved.specs)], IDENTITY)
        _give_dynamics(bodies[record.id], record)
    ties = _make_ties(world, saved, bodies, alone)
    _make_anchors(world, saved, bodies, alone)
    _order_constraints(world, saved, bodies, ties)
    _set_filters(world, saved, bodies)
    for body in bodies.values():
        for datum in world.user_data.of_body(body.id).copy():
            world.user_data.remove(datum)
    for datum in saved.user_data:
        body = bodies[datum.body]
        world.user_data.add(body.id, datum.link, datum.shape, datum.key, datum.value)
    return list(bodies.values())


def _late_links(saved: SavedWorld) -> dict[int, int]:
    return {body.id: late_links(saved.specs[_index(body.spec, saved.specs)]) for body in saved.bodies}


def _index(number: int, items: list[Any]) -> int:
    if not 0 <= number < len(items):
        raise ValueError(f"index {number} is out of range for {len(items)} items")
    return number


def _check_link(body: BodyCore, link: int) -> None:
    if not BASE <= link < body.joint_count:
        raise ValueError(f"body {body.id} has no link {link}")


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


def _make_ties(
    world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], alone: bool
) -> dict[int, UserConstraint]:
    ties = {}
    for record in saved.ties:
        parent = bodies[record.parent]
        child = None if record.child == _NONE else bodies[record.child]
        _check_link(parent, record.parent_link)
        _check_link(parent, record.gear_auxiliary_link)
        if child is not None:
            _check_link(child, record.child_link)
        _check_path(parent, record)
        values = {field.name: getattr(record, field.name) for field in fields(SavedTie)}
        values |= {"parent": parent, "child": child}
        if not alone:
            values["id"] = world.user_constraints.next_id
        elif record.id in ties or record.id < 1:
            raise ValueError(f"the number {record.id} of a constraint is used twice or out of range")
        ties[record.id] = UserConstraint(**values)
        change = Change()
        world.user_constraints.put(change, ties[record.id])
        change.commit()
    return ties


def _check_path(body: BodyCore, record: SavedTie) -> None:
    """Raise `ValueError` unless the path of a constraint is one, and its actuator exists."""
    if record.kind < UserConstraintKind.TENDON or record.kind is UserConstraintKind.BASE_FRICTION:
        return
    if record.kind is UserConstraintKind.TENDON:
        stiffness, damping, *rest = record.spring
        lower, upper, friction, _ = record.range
        bounds = (rest[0], rest[1]), (lower, upper)
        TendonSpec(
            record.name, record.path, stiffness, damping, *bounds, friction, armature=record.armature
        ).check()
    elif any(abs(number) == inf for number in record.range):
        raise ValueError("only tendons have bounds that may be infinite")
    for path in (record.path, *((record.second_path,) if record.second_path else ())):
        if not record.is_wrench:
            TendonSpec(record.name, path).check()
        elif len(path) != 1 or path[0].kind is not PathKind.SITE:
            raise ValueError("the transmission to a site needs one site")
    for part in (*record.path, *record.second_path):
        for link in (part.link, part.side_link):
            if link != WORLD:
                _check_link(body, link)
        if part.kind is PathKind.JOINT and (part.link < 0 or body.velocity_count[part.link] != 1):
            raise ValueError(f"link {part.link} of body {body.id} has no joint that a tendon could follow")
        if part.kind is PathKind.BALL and (
            part.link < 0 or body.joint_types[part.link] != JointCode.SPHERICAL
        ):
            raise ValueError(f"link {part.link} of body {body.id} has no spherical joint")
    if record.kind is UserConstraintKind.TRANSMISSION:
        _index(record.actuator, list(body.spec.actuators))


def _make_anchors(world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], alone: bool) -> None:
    for record in saved.anchors:
        soft, body = bodies[record.soft], None if record.body == _NONE else bodies[record.body]
        if not isinstance(soft, SoftCore) or not 0 <= record.node < soft.rows.count["node"]:
            raise ValueError(f"body {record.soft} has no node {record.node}")
        if body is not None and (body.spec.soft is not None or not BASE <= record.link < body.joint_count):
            raise ValueError(f"body {body.id} has no link {record.link} to which a node could be anchored")
        change = Change()
        number = record.id if alone else world.user_constraints.take_id(change)
        if number in world.contact_arrays.soft.anchors or number < 1:
            raise ValueError(f"the number {number} of an anchor is used twice or out of range")
        rows = None if body is None else body.rows
        anchor = Anchor(
            number, soft.soft_rows, record.node, rows, record.link, record.pivot,
            record.damped, record.late_force,
        )  # fmt: skip
        change.put(world.contact_arrays.soft.anchors, number, anchor)
        change.commit()


def _order_constraints(
    world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], ties: dict[int, UserConstraint]
) -> None:
    """Restore the order of constraints and of objects, from which the solver's order follows."""
    ours = {id(body) for body in bodies.values()}
    own = [constraint for constraint in world.constraints.all if id(constraint.body) not in ours]
    used = set()
    for record in saved.constraints:
        body = bodies[record.body]
        tie = None if record.user == _NONE else ties[record.user]
        if not _fits(record, body, tie):
            raise ValueError("a constraint does not fit its joint")
        if tie is not None:
            used.add(record.user)
        limits = record.lower, record.upper, record.twist
        rest = tie, record.max_impulse, record.actuator
        own.append(JointConstraint(body, record.joint, record.kind, *limits, *rest))
        own[-1].yield_as_described()
    if used != ties.keys():
        raise ValueError("a constraint is missing")
    world.constraints.all = own
    tags = world.constraints.tags
    others = [link for link in tags.links if world.bodies[cast(int, link[0])] not in bodies.values()]
    objects = [(bodies[body].id, link) for body, link in saved.objects]
    count = sum(1 + body.joint_count for body in bodies.values())
    if not len(set(objects)) == len(objects) == count:
        raise ValueError("the list of objects does not contain every link exactly once")
    tags.reorder([*others, *objects])


def _fits(record: SavedConstraint, body: BodyCore, tie: UserConstraint | None) -> bool:
    """Whether the kind of a constraint is one that its joint, or its user constraint, can have."""
    if tie is not None:
        kind_and_place = (ConstraintKind.USER, tie.parent, tie.parent_link)
        return (record.kind, body, record.joint) == kind_and_place
    joint = body.joint_types[_index(record.joint, body.spec.links)]
    if record.kind == ConstraintKind.ACTUATOR:
        actuator = body.spec.actuators[_index(record.actuator, list(body.spec.actuators))]
        return record.joint == actuated_joint(body, actuator)
    friction = ConstraintKind.FRICTION if joint in WITH_FRICTION else None
    return record.kind in (MOTOR_KIND.get(joint), LIMIT_KIND.get(joint), friction)


def _set_filters(world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore]) -> None:
    for it in saved.filters:
        rows = []
        for body, link in ((bodies[it.body_a], it.link_a), (bodies[it.body_b], it.link_b)):
            _check_link(body, link)
            rows.append(body.first_link + 1 + link)
        world.contact_arrays.shapes.filters.set(*rows, enabled=it.enabled, contact=it.contact)
