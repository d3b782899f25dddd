"""What a world file says of a world besides its state: records, and how they follow from a world.

Names and fields of the records are part of the format, which `docs/world-files.md` describes.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, cast

from carom.description.compliance import PairContact
from carom.description.pose import Pose, Vector3
from carom.description.tendon import PathPart, TendonLook
from carom.engine.parameters import EngineParameters
from carom.layouts.codes import ConstraintKind, UserConstraintKind
from carom.model.body_spec import BASE, BodySpec
from carom.model.builder import late_links
from carom.model.link_dynamics import LinkDynamics
from carom.model.soft_spec import Anchor
from carom.scene.core.soft_core import SoftCore
from carom.scene.joint_constraints import JointConstraint
from carom.scene.user_constraints import UserConstraint
from carom.scene.user_data import UserDatum
from carom.version import __version__

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

NONE = -1
"""The number of no body and of no constraint."""


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
    look: TendonLook | None = None


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


def described(world: WorldCore) -> SavedWorld:
    """The records of a world."""
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
        objects=cast("list[tuple[int, int]]", world.joint_constraints.tags.links),
        constraints=[_saved_constraint(constraint) for constraint in world.joint_constraints.all],
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
    return next((body.id for body in world.bodies.values() if body.rows is anchor.body), NONE)


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
    user = NONE if it.user is None else it.user.id
    limits = it.lower, it.upper, it.twist
    return SavedConstraint(it.body.id, it.joint, it.kind, *limits, it.max_impulse, user, it.actuator)


def _saved_tie(tie: UserConstraint) -> SavedTie:
    values = {field.name: getattr(tie, field.name) for field in fields(SavedTie)}
    values["parent"] = tie.parent.id
    values["child"] = NONE if tie.child is None else tie.child.id
    return SavedTie(**values)


def late_links_of(saved: SavedWorld) -> dict[int, int]:
    """How many links with late velocities each body has, by its number."""
    return {body.id: late_links(saved.specs[index_in(body.spec, saved.specs)]) for body in saved.bodies}


def index_in(number: int, items: list[Any]) -> int:
    """An index that was read; ValueError if it is out of range."""
    if not 0 <= number < len(items):
        raise ValueError(f"index {number} is out of range for {len(items)} items")
    return number
