"""`<joint>` as its author means it: where it is, its axes, and the joints of the engine that it consists of.

A joint of the engine has the frame of its child link. One elsewhere gets a massless link in between, to which
the child is fixed, unless it is the same motion at the origin of the child.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

from carom.description import Joint, JointType, Mimic, Pose
from carom.description.joint import BALL_TYPES, HINGE, SLIDES, STILL, WITHOUT_AXIS, WITHOUT_LIMIT
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import compose, conjugate, dot, inverse, rotate
from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.robot.joint import unit_axis
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.frames import WORLD, Frames
from carom.formats.sdf.joint import TYPES, Z, read_bounds
from carom.formats.sdf.tree import Part

# Up to this version of the format axes are in the frame of the model, later in that of the joint.
_AXES_OF_MODEL = (1, 4)
_ROUNDING = 1e-12
_TWO_AXES = ("revolute2", "universal")
_KNOWN = (*TYPES, *_TWO_AXES, "gearbox")


@dataclass(frozen=True, slots=True)
class Hinged:
    """The joints of the engine that a `<joint>` consists of, from its parent to its child.

    Attributes:
        joints: Their parents, children and frames are not set yet; a link without mass is between any two.
        parent: Index of the parent link.
        child: Index of the child link.
        pose: Of these links, in the frame of the outermost model.
        offset: Frame of the child link in theirs.
    """

    joints: tuple[Joint, ...]
    parent: int
    child: int
    pose: Pose = IDENTITY
    offset: Pose = IDENTITY


def read_hinged(
    part: Part, frames: Frames, names: dict[str, int], poses: list[Pose], prefix: str, place: Pose
) -> Hinged:
    """The joint that a `<joint>` element describes.

    Args:
        part: The element, in its model.
        frames: Frames of that model.
        names: Indices of links by their names in the model.
        poses: Of the links, in the outermost model.
        prefix: What the names of the model begin with in the outermost one.
        place: Pose of the model in the outermost one.

    Raises:
        DescriptionError: The type or a link is missing or unknown, or something inside is wrong.
    """
    context, element = part.context, part.element
    kind = context.required(element, "type")
    if kind not in _KNOWN:
        raise context.error(element, f"unknown joint type {shown(kind)}; known are {', '.join(_KNOWN)}")
    parent, child = (_end(part, frames, tag, names) for tag in ("parent", "child"))
    if parent == child:
        raise context.error(element, "its parent and its child are the same link")
    in_model = frames.of(part)
    # Where the joint is in the frame of the child link, and what turns an axis of it into that.
    moved = compose(inverse(poses[child]), compose(place, in_model))
    reader = _Axes(part, frames, in_model, moved, prefix)
    anchor = moved.position
    name = prefix + element.attributes["name"]
    if kind in _TWO_AXES:
        joints = (reader.joint(name, HINGE, "axis"), reader.joint(f"{name}@axis2", HINGE, "axis2"))
    else:
        joints = (reader.joint(name, TYPES[kind], "axis"),)
        if TYPES[kind] is JointType.SCREW:
            joints = (replace(joints[0], pitch=_pitch(context, element)),)
        if TYPES[kind] in (*STILL, *SLIDES):
            anchor = (0.0, 0.0, 0.0)
        elif TYPES[kind] not in BALL_TYPES:
            anchor = _across(anchor, joints[0].axis)
    if max(map(abs, anchor)) <= _ROUNDING:
        return Hinged(joints, parent, child, poses[child])
    x, y, z = anchor
    fixed = Joint(f"{name}@fixed", JointType.FIXED, 0, 0)
    return Hinged((*joints, fixed), parent, child, compose(poses[child], Pose(anchor)), Pose((-x, -y, -z)))


def _end(part: Part, frames: Frames, tag: str, names: dict[str, int]) -> int:
    """The index of the link at an end of a joint, which may be named by a frame that is attached to it."""
    context, joint = part.context, part.element
    name = context.text(joint, tag)
    if name is None:
        raise context.error(joint, f"<{tag}> is missing")
    place = joint.first(tag) or joint
    if name == WORLD and name in names:
        return names[name]
    found = frames.link(part, place, name)
    if found not in names:
        raise context.error(place, f"there is no link {shown(found)}")
    return names[found]


def _across(anchor: Vector3, axis: Vector3) -> Vector3:
    """An anchor without its share along an axis, which makes no difference to a turn about it."""
    along = dot(anchor, axis)
    return (anchor[0] - along * axis[0], anchor[1] - along * axis[1], anchor[2] - along * axis[2])


def _pitch(context: SdfContext, element: Element) -> float:
    """How far a screw goes along its axis in one turn [m]."""
    if element.first("screw_thread_pitch") is None and element.first("thread_pitch") is not None:
        # In radians per metre, of a thread that turns the other way.
        turns = context.value(element, "thread_pitch")
        if turns == 0.0:
            raise context.error(element, "<thread_pitch> must not be 0")
        return -2.0 * pi / turns * context.scale
    return context.value(element, "screw_thread_pitch", 1.0) * context.scale


class _Axes:
    """Reads the axes of one joint, as joints of the engine in the axes of the child link."""

    def __init__(self, part: Part, frames: Frames, in_model: Pose, moved: Pose, prefix: str) -> None:
        self._part = part
        self._frames = frames
        self._in_model = in_model
        self._moved = moved
        self._prefix = prefix

    def joint(self, name: str, kind: JointType, tag: str) -> Joint:
        """A joint about or along the axis that a child of this name states."""
        context = self._part.context
        joint, axis = Joint(name, kind, 0, 0), self._part.element.first(tag)
        if kind in WITHOUT_AXIS or kind in BALL_TYPES:
            return joint
        if axis is None:
            return replace(joint, axis=self._turned(Z), limit=read_bounds(context, self._part.element))
        dynamics = axis.first("dynamics")
        numbers = {
            key: 0.0 if dynamics is None else context.value(dynamics, key, 0.0)
            for key in ("damping", "friction", "spring_stiffness", "spring_reference")
        }
        return replace(
            joint,
            axis=self._turned(self._direction(axis, kind)),
            limit=joint.limit if kind in WITHOUT_LIMIT else read_bounds(context, axis),
            damping=numbers["damping"],
            friction=numbers["friction"],
            stiffness=numbers["spring_stiffness"],
            spring_reference=numbers["spring_reference"],
            mimic=self._mimic(axis),
        )

    def _turned(self, direction: Vector3) -> Vector3:
        turned = rotate(self._moved.orientation, direction)
        if max(abs(a - b) for a, b in zip(turned, direction, strict=True)) <= _ROUNDING:
            return direction
        return turned

    def _direction(self, axis: Element, kind: JointType) -> Vector3:
        """Unit axis in the frame of the joint."""
        context = self._part.context
        vector = context.triple(axis, "xyz")
        if vector is None:
            return Z
        (direction, _), element = unit_axis(context, axis, kind, vector), axis.first("xyz")
        frame = None if element is None else element.attributes.get("expressed_in")
        if frame:
            base = self._frames.named(self._part, element or axis, frame)
            direction = rotate(base.orientation, direction)
        elif not _in_model(context, axis):
            return direction
        return rotate(conjugate(self._in_model.orientation), direction)

    def _mimic(self, axis: Element) -> Mimic | None:
        element = axis.first("mimic")
        if element is None:
            return None
        context = self._part.context
        leader = context.required(element, "joint")
        if element.attributes.get("axis", "axis") == "axis2":
            leader += "@axis2"
        factor = context.value(element, "multiplier", 1.0)
        offset = context.value(element, "offset", 0.0) - factor * context.value(element, "reference", 0.0)
        return Mimic(self._prefix + leader, factor, offset)


def _in_model(context: SdfContext, axis: Element) -> bool:
    """Whether an axis is in the frame of the model."""
    stated = context.text(axis, "use_parent_model_frame")
    if stated is not None:
        return stated in ("1", "true")
    words = context.root.attributes.get("version", "").split(".")
    numbers = tuple(int(word) for word in words if word.isdigit())
    return bool(numbers) and numbers <= _AXES_OF_MODEL
