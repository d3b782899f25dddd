"""Links and joints of a `<model>` and of the models inside it, as their author placed them."""

from __future__ import annotations

from collections.abc import Iterator

from carom.description import Joint, JointType, Link, Pose
from carom.description.joint import WITHOUT_AXIS, WITHOUT_LIMIT
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import compose, conjugate, inverse, rotate
from carom.formats.robot.joint import read_joint_type, unit_axis
from carom.formats.robot.link import MASSLESS, read_link
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.frames import Frames
from carom.formats.sdf.gearboxes import GEARBOX, names_within, with_gearboxes
from carom.formats.sdf.geometry import read_sdf_geometry
from carom.formats.sdf.joint import TYPES, WORLD, Z, read_bounds, read_end
from carom.formats.sdf.looks import read_material
from carom.formats.xml_element import Element
from carom.lazy_dataclasses import dataclass, field, replace

# Up to this version of the format axes are in the frame of the model, later in that of the joint.
_AXES_OF_MODEL = (1, 4)


@dataclass(slots=True)
class Parts:
    """Links and joints of a model.

    Attributes:
        links: Those of the models inside it have names like `arm::hand`.
        poses: Frames of the links in that of the model.
        joints: Likewise; their frames are those of their child links.
        elements: The `<joint>` of each joint.
        gearboxes: Joints that tie others together, and the prefix of the names of what they tie.
    """

    links: list[Link] = field(default_factory=list)
    poses: list[Pose] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    elements: list[Element] = field(default_factory=list)
    gearboxes: list[tuple[Element, str]] = field(default_factory=list)


def read_parts(context: SdfContext, model: Element) -> Parts:
    """The links and joints of a model; raises `DescriptionError`.

    The frame of a link that a joint carries is that of the joint: what the link has is placed in it.
    """
    parts = Parts()
    _add_links(context, parts, model, "", IDENTITY)
    if not parts.links:
        raise context.error(model, "there are no links")
    names = {link.name for link in parts.links}
    if WORLD not in names and any(context.text(joint, "parent") == WORLD for joint in model.all("joint")):
        parts.links.append(Link(WORLD, inertial=MASSLESS))
        parts.poses.append(IDENTITY)
    _add_joints(context, parts, model, "", IDENTITY)
    _place(parts)
    parts.joints = with_gearboxes(context, parts.links, parts.poses, parts.joints, parts.gearboxes)
    return parts


def _inside(
    context: SdfContext, model: Element, prefix: str, place: Pose
) -> Iterator[tuple[Element, str, Pose]]:
    """The models inside a model, the prefix of their names, and their poses in that of the outermost one."""
    frames = Frames(context, model)
    for element in model.all("model"):
        own = prefix + context.required(element, "name") + "::"
        yield element, own, compose(place, frames.of(element))


def _add_links(context: SdfContext, parts: Parts, model: Element, prefix: str, place: Pose) -> None:
    frames = Frames(context, model)
    lines: dict[str, int] = {}
    for element in model.all("link"):
        link = read_link(context, element, read_sdf_geometry, read_material)
        context.refuse_duplicate(element, link.name, lines)
        parts.links.append(replace(link, name=prefix + link.name))
        parts.poses.append(compose(place, frames.of(element)))
    for inner, own, pose in _inside(context, model, prefix, place):
        _add_links(context, parts, inner, own, pose)


def _add_joints(context: SdfContext, parts: Parts, model: Element, prefix: str, place: Pose) -> None:
    frames = Frames(context, model)
    # The world is the same in models inside others.
    whole = names_within(parts.links, "")
    world = {WORLD: whole[WORLD]} if WORLD in whole else {}
    names = world | names_within(parts.links, prefix)
    lines: dict[str, int] = {}
    for element in model.all("joint"):
        name = context.required(element, "name")
        context.refuse_duplicate(element, name, lines)
        if element.attributes.get("type") == GEARBOX:
            parts.gearboxes.append((element, prefix))
            continue
        parts.joints.append(_read_joint(context, names, element, frames, prefix, place))
        parts.elements.append(element)
    for inner, own, pose in _inside(context, model, prefix, place):
        _add_joints(context, parts, inner, own, pose)


def _read_joint(
    context: SdfContext, names: dict[str, int], element: Element, frames: Frames, prefix: str, place: Pose
) -> Joint:
    """A joint between links of these names; its `frame` is its place in the frame of the outermost model."""
    kind = read_joint_type(context, element, TYPES)
    parent, child = (read_end(context, element, end, names) for end in ("parent", "child"))
    in_model = frames.of(element)
    joint = Joint(prefix + element.attributes["name"], kind, parent, child, frame=compose(place, in_model))
    axis = element.first("axis")
    if axis is None or kind in WITHOUT_AXIS:
        return joint
    direction = _axis(context, axis, kind, frames, in_model)
    dynamics = axis.first("dynamics")
    numbers = {
        name: 0.0 if dynamics is None else context.value(dynamics, name, 0.0)
        for name in ("damping", "friction", "spring_stiffness", "spring_reference")
    }
    return replace(
        joint,
        axis=direction,
        limit=joint.limit if kind in WITHOUT_LIMIT else read_bounds(context, axis),
        damping=numbers["damping"],
        friction=numbers["friction"],
        stiffness=numbers["spring_stiffness"],
        spring_reference=numbers["spring_reference"],
    )


def _axis(context: SdfContext, axis: Element, kind: JointType, frames: Frames, joint: Pose) -> Vector3:
    """Unit axis in the frame of a joint, whose pose in that of its model is given."""
    vector = context.triple(axis, "xyz")
    if vector is None:
        return Z
    (direction, _), element = unit_axis(context, axis, kind, vector), axis.first("xyz")
    frame = None if element is None else element.attributes.get("expressed_in")
    if frame:
        direction = rotate(frames.named(axis, frame).orientation, direction)
    elif not _in_model(context, axis):
        return direction
    return rotate(conjugate(joint.orientation), direction)


def _in_model(context: SdfContext, axis: Element) -> bool:
    """Whether an axis is in the frame of the model."""
    stated = context.text(axis, "use_parent_model_frame")
    if stated is not None:
        return stated in ("1", "true")
    words = context.root.attributes.get("version", "").split(".")
    numbers = tuple(int(word) for word in words if word.isdigit())
    return bool(numbers) and numbers <= _AXES_OF_MODEL


def _place(parts: Parts) -> None:
    """Make the frames of joints those of their child links, and relative to their parents."""
    for joint in parts.joints:
        moved = compose(inverse(joint.frame), parts.poses[joint.child])
        parts.poses[joint.child] = joint.frame
        if moved != IDENTITY:
            parts.links[joint.child] = _moved(parts.links[joint.child], moved)
    parts.joints = [
        replace(joint, frame=compose(inverse(parts.poses[joint.parent]), joint.frame))
        for joint in parts.joints
    ]


def _moved(link: Link, pose: Pose) -> Link:
    """A link whose frame was at a pose in another one, described in that."""
    return replace(
        link,
        inertial=replace(link.inertial, frame=compose(pose, link.inertial.frame)),
        collisions=tuple(replace(each, frame=compose(pose, each.frame)) for each in link.collisions),
        visuals=tuple(replace(each, frame=compose(pose, each.frame)) for each in link.visuals),
    )
