"""A robot of our tables as the text of an SDF file."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from tools.assets.parts import (
    ONE,
    ZERO,
    Box,
    Capsule,
    Cylinder,
    Geometry,
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
from carom.description.pose import IDENTITY
from carom.description.transform import compose, quaternion_from_rpy
from carom.formats.urdf_writer import roll_pitch_yaw

INDENT = "  "
LINES = list[str]


def sdf_text(robots: list[tuple[Robot, Pose]]) -> str:
    """A world of robots, each with the pose of its first link."""
    body = [line for robot, pose in robots for line in _model(robot, pose)]
    about = robots[0][0].about
    head = ['<?xml version="1.0"?>', f"<!-- {about} Written by tools/assets of Carom; MIT licence. -->"]
    world = _element("world", body, 'name="default"')
    return "\n".join([*head, *_element("sdf", world, 'version="1.6"'), ""])


def _model(robot: Robot, pose: Pose) -> LINES:
    """Links have their poses in the frame of the model, which is that of its first link."""
    children = _pose(pose.position, roll_pitch_yaw(pose.orientation))
    poses = {robot.links[0].name: IDENTITY}
    for joint in robot.joints:
        placed = Pose(joint.xyz, quaternion_from_rpy(*joint.rpy))
        poses[joint.child] = compose(poses[joint.parent], placed)
    for link in robot.links:
        children += _link(link, poses[link.name])
    for joint in robot.joints:
        children += _joint(joint)
    return _element("model", children, f"name={quoteattr(robot.name)}")


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:.13g}" for value in values)


def _element(tag: str, children: LINES, attributes: str = "") -> LINES:
    opening = f"{tag} {attributes}" if attributes else tag
    return [f"<{opening}>", *(INDENT + line for line in children), f"</{tag}>"]


def _text(tag: str, *values: float) -> str:
    return f"<{tag}>{_numbers(values)}</{tag}>"


def _pose(xyz: Vector3, rpy: Vector3) -> LINES:
    return [] if xyz == ZERO and rpy == ZERO else [_text("pose", *xyz, *rpy)]


def _link(link: Link, pose: Pose) -> LINES:
    children = _pose(pose.position, roll_pitch_yaw(pose.orientation))
    if link.contact:
        children += _element("contact", [_text(tag, value or 0.0) for tag, value in link.contact.items()])
    if link.inertial:
        children += _inertial(link.inertial)
    for number, shape in enumerate(link.seen):
        inside = _shape(shape) + _material(shape.paint)
        children += _element("visual", inside, f'name="{link.name}_visual_{number}"')
    for number, shape in enumerate(link.touching):
        children += _element("collision", _shape(shape), f'name="collision_{number}"')
    return _element("link", children, f"name={quoteattr(link.name)}")


def _inertial(inertial: Inertial) -> LINES:
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    tensor = [_text(name, value) for name, value in zip(names, inertial.tensor, strict=True)]
    pose = _pose(inertial.xyz, inertial.rpy)
    return _element("inertial", [*pose, _text("mass", inertial.mass), *_element("inertia", tensor)])


def _shape(shape: Shape) -> LINES:
    return [*_pose(shape.xyz, shape.rpy), *_element("geometry", _geometry(shape.geometry))]


def _geometry(geometry: Geometry) -> LINES:
    match geometry:
        case Box(size):
            return _element("box", [_text("size", *size)])
        case Sphere(radius):
            return _element("sphere", [_text("radius", radius)])
        case Cylinder(radius, length):
            return _element("cylinder", [_text("radius", radius), _text("length", length)])
        case Capsule(radius, length):
            return _element("capsule", [_text("radius", radius), _text("length", length)])
        case Plane(normal):
            return _element("plane", [_text("normal", *normal), _text("size", 100.0, 100.0)])
        case Mesh(file, scale):
            scaled = [_text("scale", *scale)] if scale != ONE else []
            return _element("mesh", [f"<uri>{file}</uri>", *scaled])


def _material(paint: Paint | None) -> LINES:
    if paint is None:
        return []
    shine = [_text("specular", *paint.specular, 1.0)] if paint.specular else []
    return _element("material", [_text("diffuse", *paint.rgba), *shine])


def _joint(joint: Joint) -> LINES:
    children = [f"<parent>{joint.parent}</parent>", f"<child>{joint.child}</child>"]
    if joint.axis is not None:
        axis = [_text("xyz", *joint.axis)]
        if joint.limit:
            axis += _element("limit", [_text(name, value) for name, value in joint.limit.items()])
        dynamics = [
            _text(name, value)
            for name, value in (("damping", joint.damping), ("friction", joint.friction))
            if value is not None
        ]
        axis += _element("dynamics", dynamics) if dynamics else []
        children += _element("axis", axis)
    return _element("joint", children, f'name={quoteattr(joint.name)} type="{joint.type}"')
