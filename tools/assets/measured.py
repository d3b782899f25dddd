"""Robots as real PyBullet found them: their joints, masses and inertias are recorded facts.

What the recorded figures leave open is what a robot looks like, and what stands in for meshes. Both are
for the tables of this folder to say, in a `Dress`.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from tools.assets.envelope import Envelope
from tools.assets.parts import (
    ZERO,
    Box,
    Capsule,
    Cylinder,
    Inertial,
    Joint,
    Link,
    Mesh,
    Paint,
    Plane,
    Robot,
    Shape,
    Sphere,
    Vector3,
)

from carom.description import Pose
from carom.description.pose import Quaternion
from carom.description.transform import (
    compose,
    conjugate,
    inverse,
    multiplied,
    quaternion_from_rpy,
    rotate,
    rotation_matrix,
)
from carom.formats.urdf_writer import roll_pitch_yaw

FACTS = Path(__file__).resolve().parents[2] / "tests" / "pybullet_data" / "facts"

TYPES = {0: "revolute", 1: "prismatic", 2: "spherical", 4: "fixed"}
"""Joint types by PyBullet's numbers."""

SPHERE, BOX, CYLINDER, MESH, PLANE, CAPSULE = 2, 3, 4, 5, 6, 7
"""PyBullet's numbers of shapes."""

CONTACT_DEFAULTS = {
    "lateral_friction": 0.5,
    "rolling_friction": 0.0,
    "spinning_friction": 0.0,
    "restitution": 0.0,
}
MESH_MARGIN = 0.003
"""How much wider the bounds of a mesh are than its corners, on each side, besides that of a compound [m]."""

FEW_DIGITS = 10
"""Rounding is taken off figures that have at most so many digits after the point."""

Filler = Callable[[Envelope], tuple[Shape, ...]]
"""Shapes that fill the bounds of a mesh, both in the inertial frame of the link."""

Part = TypeVar("Part")


def fill_with_box(room: Envelope) -> tuple[Shape, ...]:
    """One box."""
    return (room.box(),)


def fitted(file: str) -> Filler:
    """A mesh that spans one unit around its origin, stretched to the bounds."""

    def fill(room: Envelope) -> tuple[Shape, ...]:
        ends = [room.inner(axis) for axis in "xyz"]
        x, y, z = (high - low - 2.0 * MESH_MARGIN for low, high in ends)
        centre_x, centre_y, centre_z = ((low + high) / 2.0 for low, high in ends)
        return (Shape(Mesh(file, (x, y, z)), (centre_x, centre_y, centre_z)),)

    return fill


@dataclass(frozen=True)
class Dress:
    """What a robot looks like and touches with; link names are patterns, the first that fits counts.

    Attributes:
        paint: Colour of the shapes that touch.
        fill: What stands in for the meshes of a link; a box where nothing is said.
        seen: Looks of links in their link frames, instead of what touches.
        more: Looks besides that.
        borrowed: Links of other robots that lend their looks and shapes.
        inertia_scaling: What PyBullet is told to multiply inertias by.
    """

    paint: Mapping[str, Paint]
    fill: Mapping[str, Filler] = field(default_factory=dict)
    seen: Mapping[str, tuple[Shape, ...]] = field(default_factory=dict)
    more: Mapping[str, tuple[Shape, ...]] = field(default_factory=dict)
    borrowed: Mapping[str, Link] = field(default_factory=dict)
    inertia_scaling: float = 1.0


def dressed(file: str, about: str, dress: Dress, number: int = 0) -> Robot:
    """A robot with the recorded joints and masses.

    Args:
        file: Its file in the data folder.
        about: A sentence that introduces it.
        dress: Its shapes.
        number: Which of the bodies of the file.
    """
    facts = recorded(file)[number]
    names = [facts["base"], *(joint["link"] for joint in facts["joints"])]
    frames = [_inertial_frame(fact) for fact in facts["default"]]
    links = tuple(_link(facts, dress, i, name) for i, name in enumerate(names))
    joints = tuple(_joint(fact, names, frames, i) for i, fact in enumerate(facts["joints"], start=1))
    return Robot(facts["robot"], about, _as_in_file(links, facts), joints)


def _as_in_file(links: tuple[Link, ...], facts: Mapping[str, Any]) -> tuple[Link, ...]:
    """Links in the order of the original's file, which is that of URDF_MAINTAIN_LINK_ORDER."""
    order = facts.get("file_order")
    if order is None:
        return links
    places = {name: place for place, name in enumerate(order)}
    return tuple(sorted(links, key=lambda link: places.get(link.name, -1)))


def place(file: str, number: int = 0) -> Pose:
    """Where a body of a scene has the frame of its first link."""
    facts = recorded(file)[number]
    x, y, z, *turn = facts["place"]
    at = compose(Pose((x, y, z), tuple(turn)), inverse(_inertial_frame(facts["default"][0])))
    return Pose(_tidied(at.position), at.orientation)


def recorded(file: str) -> list[dict[str, Any]]:
    """Everything recorded of the bodies of a file."""
    name = file.replace("/", "__").removesuffix(".urdf")
    return json.loads((FACTS / f"{name}.json").read_text())


def _link(facts: Mapping[str, Any], dress: Dress, number: int, name: str) -> Link:
    inertial = _inertial(facts, number, dress.inertia_scaling)
    contact = _contact(facts, number)
    if dress.inertia_scaling != 1.0:
        contact["inertia_scaling"] = dress.inertia_scaling
    if name in dress.borrowed:
        lender = dress.borrowed[name]
        return Link(name, inertial, lender.seen, lender.touching, contact)
    frame = _inertial_frame(facts["default"][number])
    touching = _touching(facts, dress, number, name, frame)
    painted = tuple(replace(shape, paint=_chosen(dress.paint, name)) for shape in touching)
    seen = _chosen(dress.seen, name, painted) + _chosen(dress.more, name, ())
    return Link(name, inertial, seen, touching, contact)


def _chosen(table: Mapping[str, Part], name: str, otherwise: Part | None = None) -> Part:
    for pattern, value in table.items():
        if fnmatchcase(name, pattern):
            return value
    if otherwise is None:
        raise KeyError(f"nothing is said of link {name!r}")
    return otherwise


def _touching(
    facts: Mapping[str, Any], dress: Dress, number: int, name: str, frame: Pose
) -> tuple[Shape, ...]:
    recorded_shapes = facts["collisions"][number]
    if any(shape["type"] == MESH for shape in recorded_shapes):
        shapes = _chosen(dress.fill, name, fill_with_box)(_room(facts, number, dress.inertia_scaling))
    else:
        shapes = tuple(_primitive(shape) for shape in recorded_shapes)
    return tuple(_moved(shape, frame) for shape in shapes)


def _room(facts: Mapping[str, Any], number: int, scaling: float) -> Envelope:
    """The bounds that the inertia tells of, since getAABB leaves out some of the margins that it counts."""
    low, high = (np.array(corner) for corner in facts["bounds"][number])
    fact = facts["default"][number]
    if fact["mass"] > 0.0:
        return Envelope.of_inertia(tuple((low + high) / 2.0), fact["inertia"], scaling * fact["mass"])
    return Envelope(tuple(low), tuple(high))


def _primitive(fact: Mapping[str, Any]) -> Shape:
    """A recorded shape in the inertial frame of its link."""
    x, y, z = fact["dimensions"]
    geometry = {
        SPHERE: lambda: Sphere(x),
        BOX: lambda: Box((_tidy(x), _tidy(y), _tidy(z))),
        CYLINDER: lambda: Cylinder(y, x),
        PLANE: lambda: Plane((x, y, z)),
        CAPSULE: lambda: Capsule(y, x),
    }[fact["type"]]()
    return placed(geometry, Pose(tuple(fact["position"]), tuple(fact["orientation"])))


def placed(geometry: Any, pose: Pose) -> Shape:
    """A shape at a pose."""
    return Shape(geometry, _tidied(pose.position), _angles(pose.orientation))


def _moved(shape: Shape, frame: Pose) -> Shape:
    """A shape of the inertial frame, in the link frame."""
    return placed(shape.geometry, compose(frame, Pose(shape.xyz, _turn(shape.rpy))))


def _turn(rpy: Vector3) -> Quaternion:
    return quaternion_from_rpy(*rpy)


def _inertial_frame(fact: Mapping[str, Any]) -> Pose:
    return Pose(tuple(fact["inertial_position"]), tuple(fact["inertial_orientation"]))


def _inertial(facts: Mapping[str, Any], number: int, scaling: float) -> Inertial:
    """Mass and inertia; the principal inertias of the file are turned back into the frame they came from."""
    fact = facts["default"][number]
    frame = _inertial_frame(fact)
    stated = facts.get("inertia_from_file", facts["default"])[number]
    to_principal = rotation_matrix(
        multiplied(conjugate(frame.orientation), tuple(stated["inertial_orientation"]))
    )
    turn = np.array(to_principal)
    tensor = turn @ np.diag(stated["inertia"]) @ turn.T / scaling
    ixx, ixy, ixz, iyy, iyz, izz = (
        float(f"{tensor[i, j]:.12g}") if abs(tensor[i, j]) > 1e-15 else 0.0
        for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    )
    return Inertial(
        fact["mass"],
        _tidied(frame.position),
        _angles(frame.orientation),
        (ixx, ixy, ixz, iyy, iyz, izz),
    )


def _contact(facts: Mapping[str, Any], number: int) -> dict[str, float | None]:
    fact = facts["default"][number]
    contact: dict[str, float | None] = {
        name: fact[name] for name, usual in CONTACT_DEFAULTS.items() if fact[name] != usual
    }
    if fact["contact_stiffness"] != -1.0:
        contact |= {"stiffness": fact["contact_stiffness"], "damping": fact["contact_damping"]}
    return contact


def _joint(fact: Mapping[str, Any], names: list[str], frames: list[Pose], number: int) -> Joint:
    """A joint as a URDF file tells of it: its frame is that of the link, seen from the parent link."""
    parent = fact["parent"] + 1
    kind = TYPES[fact["type"]]
    of_link = frames[number]
    turn = conjugate(multiplied(of_link.orientation, tuple(fact["parent_frame_orientation"])))
    in_parent = compose(frames[parent], Pose(tuple(fact["parent_frame_position"]), turn))
    moves = kind in ("revolute", "prismatic")
    if kind == "revolute" and fact["lower"] > fact["upper"]:
        kind = "continuous"
    reach = ("lower", "upper") if kind in ("revolute", "prismatic") else ()
    drive = ("effort", "velocity") if moves or fact["effort"] or fact["velocity"] else ()
    limit = {name: _tidy(fact[name]) for name in (*reach, *drive)}
    return Joint(
        fact["name"],
        kind,
        names[parent],
        names[number],
        _tidied(in_parent.position),
        _angles(in_parent.orientation),
        _tidied(rotate(of_link.orientation, tuple(fact["axis"]))) if moves else None,
        limit,
        fact["damping"] or None,
        fact["friction"] or None,
    )


def _tidy(value: float) -> float:
    """The short figure that a computed one stands for, if there is one."""
    short = round(value, FEW_DIGITS)
    return short + 0.0 if abs(value - short) < 3e-13 else value


def _tidied(vector: Vector3) -> Vector3:
    x, y, z = vector
    return (_tidy(x), _tidy(y), _tidy(z))


def _angles(orientation: Quaternion) -> Vector3:
    angles = _tidied(roll_pitch_yaw(orientation))
    return ZERO if max(map(abs, angles)) < 1e-12 else angles
