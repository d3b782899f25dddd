"""Bodies that scripts create from shapes, masses and joints."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar, overload

from carom import description
from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.transform import quaternion_from_matrix, rotation_matrix
from carom.errors import CaromError
from pybullet._calls.arguments import (
    Indices,
    Vector,
    Vectors,
    integer,
    moderate,
    real,
    rotation,
    sequence,
    vector3,
)
from pybullet._calls.builtin import exported
from pybullet._calls.constants import JOINT_FIXED, JOINT_PRISMATIC, JOINT_REVOLUTE, JOINT_SPHERICAL
from pybullet._calls.errors import fail, logger
from pybullet._calls.optional_vectors import optional_pose
from pybullet._clients.clients import Client, client_of
from pybullet._clients.shape_registry import KeptDescription, ShapeTable
from pybullet._loading.new_bodies import add_bodies, warn_of_coordinates, with_flags_of_colours

if TYPE_CHECKING:
    from carom.model.body_spec import BodySpec

__all__ = ["createMultiBody"]

Shape = TypeVar("Shape")

_FAILED = "createMultiBody failed."

JOINT_TYPES = {
    JOINT_REVOLUTE: "REVOLUTE",
    JOINT_PRISMATIC: "PRISMATIC",
    JOINT_SPHERICAL: "SPHERICAL",
    JOINT_FIXED: "FIXED",
}


@overload
def createMultiBody(
    baseMass: float = 0,
    baseCollisionShapeIndex: int = -1,
    baseVisualShapeIndex: int = -1,
    basePosition: Vector | None = None,
    baseOrientation: Vector | None = None,
    baseInertialFramePosition: Vector | None = None,
    baseInertialFrameOrientation: Vector | None = None,
    linkMasses: Vector | None = None,
    linkCollisionShapeIndices: Indices | None = None,
    linkVisualShapeIndices: Indices | None = None,
    linkPositions: Vectors | None = None,
    linkOrientations: Vectors | None = None,
    linkInertialFramePositions: Vectors | None = None,
    linkInertialFrameOrientations: Vectors | None = None,
    linkParentIndices: Indices | None = None,
    linkJointTypes: Indices | None = None,
    linkJointAxis: Vectors | None = None,
    useMaximalCoordinates: int = 0,
    flags: int = -1,
    batchPositions: None = None,
    physicsClientId: int = 0,
) -> int: ...
@overload
def createMultiBody(
    baseMass: float = 0,
    baseCollisionShapeIndex: int = -1,
    baseVisualShapeIndex: int = -1,
    basePosition: Vector | None = None,
    baseOrientation: Vector | None = None,
    baseInertialFramePosition: Vector | None = None,
    baseInertialFrameOrientation: Vector | None = None,
    linkMasses: Vector | None = None,
    linkCollisionShapeIndices: Indices | None = None,
    linkVisualShapeIndices: Indices | None = None,
    linkPositions: Vectors | None = None,
    linkOrientations: Vectors | None = None,
    linkInertialFramePositions: Vectors | None = None,
    linkInertialFrameOrientations: Vectors | None = None,
    linkParentIndices: Indices | None = None,
    linkJointTypes: Indices | None = None,
    linkJointAxis: Vectors | None = None,
    useMaximalCoordinates: int = 0,
    flags: int = -1,
    *,
    batchPositions: Vectors,
    physicsClientId: int = 0,
) -> tuple[int, ...]: ...
@exported
def createMultiBody(
    baseMass: float = 0,
    baseCollisionShapeIndex: int = -1,
    baseVisualShapeIndex: int = -1,
    basePosition: Vector | None = None,
    baseOrientation: Vector | None = None,
    baseInertialFramePosition: Vector | None = None,
    baseInertialFrameOrientation: Vector | None = None,
    linkMasses: Vector | None = None,
    linkCollisionShapeIndices: Indices | None = None,
    linkVisualShapeIndices: Indices | None = None,
    linkPositions: Vectors | None = None,
    linkOrientations: Vectors | None = None,
    linkInertialFramePositions: Vectors | None = None,
    linkInertialFrameOrientations: Vectors | None = None,
    linkParentIndices: Indices | None = None,
    linkJointTypes: Indices | None = None,
    linkJointAxis: Vectors | None = None,
    useMaximalCoordinates: int = 0,
    flags: int = -1,
    batchPositions: Vectors | None = None,
    physicsClientId: int = 0,
) -> int | tuple[int, ...]:
    """Makes a body: a base and, if there are link lists, links on joints.

    Links are named `link1`, `link2`... in the order of the lists, their joints `joint1`, `joint2`..., and the
    base `link0`. Link indices are depth first, as for files; with `URDF_MAINTAIN_LINK_ORDER` they follow the
    order of the lists. Joints have no limits and, as always, a motor that holds their velocity at 0. Moments
    of inertia are those of the collision shapes.

    Args:
        baseMass: [kg]; 0 fixes the base in the world.
        baseCollisionShapeIndex: A collision shape; -1 for none.
        baseVisualShapeIndex: A visual shape; -1 for none: then the collision shape is visible.
        basePosition: Position of the base's link frame [m].
        baseOrientation: Its orientation (x, y, z, w).
        baseInertialFramePosition: Centre of mass in the link frame [m].
        baseInertialFrameOrientation: Orientation of the inertial frame in the link frame.
        linkMasses: Mass of each link [kg].
        linkCollisionShapeIndices: Its collision shape, or -1.
        linkVisualShapeIndices: Its visual shape, or -1.
        linkPositions: Position of its joint frame in the link frame of its parent [m].
        linkOrientations: Orientation of its joint frame there (x, y, z, w).
        linkInertialFramePositions: As for the base.
        linkInertialFrameOrientations: As for the base.
        linkParentIndices: Its parent: 0 for the base, k for the k-th link of the lists.
        linkJointTypes: `JOINT_REVOLUTE`, `JOINT_PRISMATIC`, `JOINT_SPHERICAL` or `JOINT_FIXED`.
        linkJointAxis: Axis of its joint, in the joint frame.
        useMaximalCoordinates: Bodies always have reduced coordinates in Carom; 1 logs a warning. As in
            PyBullet, air does not slow such bodies, and in deformable worlds external forces act twice.
        flags: `URDF_*` for self-collision, link order, inertia and sleeping, added up.
        batchPositions: Makes a body at each of these positions instead of `basePosition`.
        physicsClientId: The connection.

    Returns:
        The id of the body, or a tuple of ids if there are `batchPositions`.

    Raises:
        pybullet.error: Not connected, the link lists differ in length, an item has a wrong type or value, or
            the links do not form a tree. No body is made then.

    Examples:
        >>> ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
        >>> pendulum = p.createMultiBody(
        ...     baseMass=0,
        ...     linkMasses=[1],
        ...     linkCollisionShapeIndices=[ball],
        ...     linkVisualShapeIndices=[-1],
        ...     linkPositions=[[0, 0, -1]],
        ...     linkOrientations=[[0, 0, 0, 1]],
        ...     linkInertialFramePositions=[[0, 0, 0]],
        ...     linkInertialFrameOrientations=[[0, 0, 0, 1]],
        ...     linkParentIndices=[0],
        ...     linkJointTypes=[p.JOINT_REVOLUTE],
        ...     linkJointAxis=[[0, 1, 0]],
        ...     basePosition=[0, 2, 2],
        ... )
        >>> p.getNumJoints(pendulum)
        1
    """
    lists = {name: values for name, values in locals().items() if name.startswith("link")}
    client = client_of(physicsClientId)
    maximal, bits = integer(useMaximalCoordinates, "useMaximalCoordinates"), integer(flags, "flags")
    pose = optional_pose(basePosition, baseOrientation, _FAILED, "base")
    base = (
        baseMass,
        baseCollisionShapeIndex,
        baseVisualShapeIndex,
        baseInertialFramePosition,
        baseInertialFrameOrientation,
    )
    from pybullet._loading.kept_descriptions import kept_description, key_of

    key = key_of((*base, *lists.values()))
    kept = kept_description(client.shapes, key)
    places = None if batchPositions is None else sequence(batchPositions, _FAILED, "batchPositions")
    if kept is None:
        kept = _described(client, key, base, _link_lists(lists))
    batch = [vector3(place, _FAILED, "batchPositions") for place in places or ()]
    warn_of_coordinates("createMultiBody", maximal, client)
    spec = _assembled(kept.robot, with_flags_of_colours(client, max(bits, 0)))
    poses = [Pose(place, pose.orientation) for place in batch or [pose.position]]
    ids = add_bodies(client, [(spec, pose) for pose in poses], _FAILED, maximal=maximal > 0)
    for number in kept.collisions:
        shape = client.shapes.collisions.get(number)
        if shape is not None:
            shape.used = True
    return ids if batch else ids[0]


def _described(
    client: Client, key: bytes | None, base: tuple[Any, ...], lists: dict[str, tuple[Any, ...]]
) -> KeptDescription:
    """The description of a body, which is kept under the key of its arguments."""
    from pybullet._loading.kept_descriptions import keep_description

    mass, collision, visual, place, turn = base
    frame = optional_pose(place, turn, _FAILED, "baseInertialFrame")
    links = [_link(client, 0, _mass(mass, "baseMass"), frame, collision, visual), *_links(client, lists)]
    robot = description.Robot("", tuple(links), tuple(_joints(lists)))
    collisions = {integer(it, "collision shape") for it in (collision, *lists["linkCollisionShapeIndices"])}
    visuals = {integer(it, "visual shape") for it in (visual, *lists["linkVisualShapeIndices"])}
    return keep_description(client.shapes, key, robot, collisions, visuals)


def _link_lists(lists: dict[str, Any]) -> dict[str, tuple[Any, ...]]:
    """The link lists by name, after a check that their lengths are equal."""
    items = {
        name: () if values is None else sequence(values, "expected a sequence", name)
        for name, values in lists.items()
    }
    lengths = {name: len(values) for name, values in items.items()}
    if len(set(lengths.values())) > 1:
        stated = ", ".join(f"{name} has {length}" for name, length in lengths.items())
        fail("All link arrays need to be same size.", f"{stated}.")
    return items


def _links(client: Client, lists: dict[str, tuple[Any, ...]]) -> list[description.Link]:
    columns = zip(
        _each(lists, "linkMasses", _mass),
        _each(lists, "linkInertialFramePositions", _vector),
        _each(lists, "linkInertialFrameOrientations", _rotation),
        lists["linkCollisionShapeIndices"],
        lists["linkVisualShapeIndices"],
        strict=True,
    )
    return [
        _link(client, number, mass, Pose(place, turn), collision, visual)
        for number, (mass, place, turn, collision, visual) in enumerate(columns, start=1)
    ]


def _joints(lists: dict[str, tuple[Any, ...]]) -> list[description.Joint]:
    parents = _each(lists, "linkParentIndices", integer)
    _check_tree(parents)
    columns = zip(
        parents,
        _each(lists, "linkJointTypes", _joint_type),
        _each(lists, "linkPositions", _vector),
        _each(lists, "linkOrientations", _rotation),
        _each(lists, "linkJointAxis", _vector),
        strict=True,
    )
    return [_joint(number, *column) for number, column in enumerate(columns, start=1)]


def _vector(values: Any, name: str) -> Vector3:
    return vector3(values, _FAILED, name)


def _each(lists: dict[str, tuple[Any, ...]], name: str, convert: Callable[[Any, str], Any]) -> list[Any]:
    return [convert(item, f"{name}[{place}]") for place, item in enumerate(lists[name])]


def _mass(value: Any, name: str) -> float:
    mass = real(value, name)
    if mass < 0.0:
        fail(_FAILED, f"{name} is {mass}; it has to be at least 0.")
    return moderate(mass, _FAILED, name)


def _rotation(values: Any, name: str) -> Quaternion:
    return quaternion_from_matrix(rotation_matrix(rotation(values, _FAILED, name)))


def _joint_type(value: Any, name: str) -> description.JointType:
    kind = integer(value, name)
    if kind not in JOINT_TYPES:
        fail(_FAILED, f"{name} is {kind}; a joint has to be revolute, prismatic, spherical or fixed.")
    return description.JointType[JOINT_TYPES[kind]]


def _check_tree(parents: list[int]) -> None:
    """Check that every link is connected to the base."""
    for link, parent in enumerate(parents):
        if not 0 <= parent <= len(parents):
            fail(_FAILED, f"linkParentIndices[{link}] is {parent}; it has to be from 0 to {len(parents)}.")
    hangs = {0}
    for link in range(1, len(parents) + 1):
        way = []
        while link not in hangs:
            if link in way:
                fail(_FAILED, f"linkParentIndices: link {link} is its own ancestor.")
            way.append(link)
            link = parents[link - 1]
        hangs.update(way)


def _link(
    client: Client, number: int, mass: float, frame: Pose, collision_id: Any, visual_id: Any
) -> description.Link:
    collision = _shape(client.shapes.collisions, collision_id, "collision")
    visuals = _shape(client.shapes.visuals, visual_id, "visual")
    # PyBullet uses these moments of inertia if the flag URDF_USE_INERTIA_FROM_FILE is set.
    moment = mass if number else 0.0
    return description.Link(
        f"link{number}",
        description.Inertial(mass, frame, (moment, 0.0, 0.0, moment, 0.0, moment)),
        () if collision is None else collision.collisions,
        visuals or (() if collision is None else collision.visuals),
    )


def _shape(table: ShapeTable[Shape], number: Any, kind: str) -> Shape | None:
    index = integer(number, f"{kind} shape")
    shape = table.get(index)
    if shape is None and index >= 0:
        logger.warning("createMultiBody: there is no %s shape %d.", kind, index)
    return shape


def _joint(
    number: int, parent: int, kind: description.JointType, place: Vector3, turn: Quaternion, axis: Vector3
) -> description.Joint:
    from carom.description.joint import NEEDS_AXIS

    x, y, z = axis
    length = (x * x + y * y + z * z) ** 0.5
    if length == 0.0 and kind in NEEDS_AXIS:
        fail(_FAILED, f"linkJointAxis[{number - 1}] has no length.")
    unit = (x / length, y / length, z / length) if length else (1.0, 0.0, 0.0)
    return description.Joint(
        f"joint{number}",
        kind,
        parent,
        number,
        Pose(place, turn),
        unit,
        length or 1.0,
        description.JointLimit(1.0, -1.0),
    )


def _assembled(robot: description.Robot, flags: int) -> BodySpec:
    from carom.soft.from_urdf import rigid_body

    without, also = _flags_of_bodies()
    try:
        return rigid_body(robot, flags=(flags & ~without) | also, compound_margin=0.0)
    except CaromError as problem:
        fail(_FAILED, str(problem))


@cache
def _flags_of_bodies() -> tuple[int, int]:
    """The flags that are for files only, and those that bodies of shapes always have."""
    from carom.layouts.flags import LoadFlags

    of_files = (
        LoadFlags.MERGE_FIXED_LINKS
        | LoadFlags.IGNORE_VISUAL_SHAPES
        | LoadFlags.IGNORE_COLLISION_SHAPES
        | LoadFlags.PRINT_URDF_INFO
    )
    return int(of_files), int(LoadFlags.USE_IMPLICIT_CYLINDER)
