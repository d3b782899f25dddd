"""Our assets have the names, frames, limits, masses, inertias and contact parameters of the originals."""

from __future__ import annotations

import logging
from functools import cache, reduce
from typing import Any

import pytest
from original_facts import DATA, NAMES, facts
from tests.each import each

from carom.description import (
    Box,
    Capsule,
    Collision,
    ContactParameters,
    Cylinder,
    Geometry,
    JointType,
    Plane,
    Sphere,
)
from carom.description.pose import Quaternion
from carom.description.shapes.bounds import Bounds
from carom.description.transform import compose, conjugate, inverse, multiplied, rotate, rotation_matrix
from carom.formats.mjcf import read_mjcf
from carom.formats.placed import PlacedRobot
from carom.formats.sdf import read_sdf
from carom.formats.urdf import read_urdf
from carom.layouts.contacts import MARGIN
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.bounds import placed_bounds
from carom.model.mjcf_inertia import set_mjcf_inertias

TYPE_NUMBERS = {
    JointType.REVOLUTE: 0,
    JointType.CONTINUOUS: 0,
    JointType.PRISMATIC: 1,
    JointType.SPHERICAL: 2,
    JointType.FIXED: 4,
}
CONTACT_DEFAULTS = {
    "lateral_friction": 0.5,
    "rolling_friction": 0.0,
    "spinning_friction": 0.0,
    "restitution": 0.0,
    "stiffness": -1.0,
    "damping": -1.0,
}
MESH_NUMBER = 5
MARGIN_ALLOWANCE = 2.5 * MARGIN
"""PyBullet counts margins once or twice, depending on the kind and number of shapes."""

PRINCIPAL_AXES = {"default": 1e-9, "inertia_from_file": 1e-5}
"""How closely turns of inertial frames agree: PyBullet ends its search for principal axes early."""

FLAGS = {"default": LoadFlags.NONE, "inertia_from_file": LoadFlags.USE_INERTIA_FROM_FILE}
LOADED_WITH_FLAGS = [(name, key) for name in NAMES for key in FLAGS if key in facts(name)]
"""Only `loadURDF` takes flags."""

WITH_BOUNDS = [name for name in NAMES if not facts(name)["file"].endswith(".xml")]
"""Of MJCF files `getAABB` tells of swept spheres, with margins of 4 cm, that stand for capsules."""

URDFS = [name for name in NAMES if facts(name)["file"].endswith(".urdf")]
CHILDREN_FIRST = ("quadruped__microtaur__microtaur", "racecar__racecar_differential")
"""In these files links come before their parents; here every link comes after its parent."""

WITH_COLLISIONS = [name for name in NAMES if "collisions" in facts(name)]
"""PyBullet crashes when it is asked for the shapes of the others."""


def exactly(value: Any) -> Any:
    """A figure or several, compared up to rounding."""
    return pytest.approx(value, rel=1e-12, abs=1e-12)


def same_turn(ours: Quaternion, recorded: list[float], tolerance: float = 1e-9) -> bool:
    """Two quaternions stand for the same rotation, whatever their signs."""
    return any(
        max(abs(a - sign * b) for a, b in zip(ours, recorded, strict=True)) < tolerance
        for sign in (1.0, -1.0)
    )


@cache
def robots(file: str) -> list[PlacedRobot]:
    """The robots of one of our files, whatever its format."""
    path = DATA / file
    readers = {".sdf": read_sdf, ".xml": read_mjcf}
    return readers[path.suffix](path) if path.suffix in readers else [PlacedRobot(read_urdf(path))]


@cache
def body(name: str, flags: LoadFlags = LoadFlags.NONE) -> BodySpec:
    original = facts(name)
    robot = robots(original["file"])[original["number"]].robot
    if not original["file"].endswith(".xml"):
        return assemble(robot, flags=flags)
    spec = assemble(robot, flags=LoadFlags.USE_IMPLICIT_CYLINDER)
    set_mjcf_inertias(spec)
    return spec


def all_links(spec: BodySpec) -> list[LinkSpec]:
    return [spec.base, *spec.links]


def joint_view(spec: BodySpec, link: LinkSpec) -> dict[str, Any]:
    """A joint as getJointInfo tells of it."""
    parent = spec.base if link.parent < 0 else spec.links[link.parent]
    in_parent = compose(inverse(parent.inertial_frame), link.joint_frame)
    moves = TYPE_NUMBERS[link.joint_type] in (0, 1)
    in_inertial = rotate(conjugate(link.inertial_frame.orientation), link.joint_axis)
    axis = tuple(link.joint_axis_length * x if moves else 0.0 for x in in_inertial)
    return {
        "name": link.joint_name,
        "type": TYPE_NUMBERS[link.joint_type],
        "damping": exactly(link.damping),
        "friction": exactly(link.friction),
        "lower": exactly(link.lower),
        "upper": exactly(link.upper),
        "effort": exactly(link.effort),
        "velocity": exactly(link.velocity),
        "link": link.name,
        "axis": exactly(axis),
        "parent_frame_position": exactly(in_parent.position),
        "parent": link.parent,
    }


@each("name", [name for name in URDFS if name not in CHILDREN_FIRST])
def test_links_stand_in_the_file_in_the_order_of_the_original(name: str) -> None:
    original = facts(name)
    order = original.get("file_order", [joint["link"] for joint in original["joints"]])
    robot = robots(original["file"])[0].robot
    spec = assemble(robot, flags=LoadFlags.MAINTAIN_LINK_ORDER)
    assert [link.name for link in spec.links] == order


@each("name", NAMES)
def test_names_and_joints_are_those_of_the_original(name: str) -> None:
    original = facts(name)
    spec = body(name)
    assert (spec.name, spec.base.name) == (original["robot"], original["base"])
    recorded = [dict(joint) for joint in original["joints"]]
    orientations = [joint.pop("parent_frame_orientation") for joint in recorded]
    assert recorded == [joint_view(spec, link) for link in spec.links]
    for link, recorded_turn in zip(spec.links, orientations, strict=True):
        parent = spec.base if link.parent < 0 else spec.links[link.parent]
        in_parent = compose(inverse(parent.inertial_frame), link.joint_frame)
        turn = multiplied(conjugate(link.inertial_frame.orientation), conjugate(in_parent.orientation))
        assert same_turn(turn, recorded_turn), link.name


@each(("name", "key"), LOADED_WITH_FLAGS)
def test_masses_and_inertias_are_those_of_the_original(
    name: str, key: str, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.ERROR)
    for link, recorded in zip(all_links(body(name, FLAGS[key])), facts(name)[key], strict=True):
        assert link.mass == exactly(recorded["mass"])
        assert link.inertia == pytest.approx(recorded["inertia"], rel=1e-6, abs=0.0), link.name
        assert link.inertial_frame.position == exactly(recorded["inertial_position"])
        assert same_turn(
            link.inertial_frame.orientation, recorded["inertial_orientation"], PRINCIPAL_AXES[key]
        )


def stated(contact: ContactParameters, name: str) -> float:
    value = getattr(contact, name)
    return CONTACT_DEFAULTS[name] if value is None else value


@each("name", NAMES)
def test_links_touch_as_in_the_original(name: str) -> None:
    original = facts(name)
    for link, recorded in zip(all_links(body(name)), original["default"], strict=True):
        for quantity in ("lateral_friction", "rolling_friction", "spinning_friction", "restitution"):
            assert stated(link.contact, quantity) == recorded[quantity], f"{link.name}: {quantity}"
        assert stated(link.contact, "stiffness") == recorded["contact_stiffness"]
        assert stated(link.contact, "damping") == recorded["contact_damping"]


def bounds_of(link: LinkSpec) -> Bounds:
    """Bounds of what touches, in the inertial frame."""
    to_inertial = inverse(link.inertial_frame)
    frames = [compose(to_inertial, shape.frame) for shape in link.collisions]
    boxes = [
        placed_bounds(
            shape.geometry, rotation_matrix(frame.orientation), frame.position, implicit_cylinder=False
        )
        for shape, frame in zip(link.collisions, frames, strict=True)
    ]
    return reduce(Bounds.joined, boxes)


@each("name", WITH_BOUNDS)
def test_collision_shapes_span_the_room_of_the_original(name: str) -> None:
    for link, recorded in zip(all_links(body(name)), facts(name)["bounds"], strict=True):
        if not link.collisions or isinstance(link.collisions[0].geometry, Plane):
            continue
        bounds = bounds_of(link)
        low = [c - h for c, h in zip(bounds.center, bounds.half, strict=True)]
        high = [c + h for c, h in zip(bounds.center, bounds.half, strict=True)]
        assert low == pytest.approx(recorded[0], abs=MARGIN_ALLOWANCE), link.name
        assert high == pytest.approx(recorded[1], abs=MARGIN_ALLOWANCE), link.name


def assert_same_shape(link: LinkSpec, shape: Collision, recorded: dict[str, Any]) -> None:
    """A primitive is as getCollisionShapeData tells of it."""
    number, dimensions = primitive(shape.geometry)
    placed = compose(inverse(link.inertial_frame), shape.frame)
    assert number == recorded["type"], link.name
    assert dimensions == exactly(recorded["dimensions"]), link.name
    assert placed.position == exactly(recorded["position"]), link.name
    assert same_turn(placed.orientation, recorded["orientation"]), link.name


def primitive(geometry: Geometry) -> tuple[int, tuple[float, float, float]]:
    match geometry:
        case Sphere(radius):
            return 2, (radius, radius, radius)
        case Box((x, y, z)):
            return 3, (2 * x, 2 * y, 2 * z)
        case Cylinder(radius, length):
            return 4, (length, radius, 0.0)
        case Plane(normal):
            return 6, normal
        case Capsule(radius, length):
            return 7, (length, radius, 0.0)
    raise AssertionError(f"the original has a primitive here, not {geometry}")


@each("name", WITH_COLLISIONS)
def test_where_the_original_has_primitives_so_have_we(name: str) -> None:
    for link, recorded in zip(all_links(body(name)), facts(name)["collisions"], strict=True):
        if any(shape["type"] == MESH_NUMBER for shape in recorded):
            assert link.collisions, link.name
        else:
            for shape, recorded_shape in zip(link.collisions, recorded, strict=True):
                assert_same_shape(link, shape, recorded_shape)
