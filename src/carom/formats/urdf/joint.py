"""`<joint>`: type, frame, axis, limits, dynamics, mimic and safety controller."""

from __future__ import annotations

from math import hypot

from carom.description import Joint, JointType, Mimic, SafetyController
from carom.description.joint import NEEDS_AXIS, SLIDES, WITHOUT_AXIS
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.formats.robot.context import shown
from carom.formats.robot.joint import link_index, read_dynamics, read_joint_type, read_limit
from carom.formats.urdf.context import UrdfContext
from carom.formats.xml_element import Element

_TYPES = {kind.value: kind for kind in JointType}


def read_joint(context: UrdfContext, element: Element, link_indices: dict[str, int]) -> Joint:
    """The joint that a `<joint>` element describes.

    Args:
        context: The reading it belongs to.
        element: The `<joint>` element.
        link_indices: Index in `Robot.links` of every link, by name.

    Raises:
        DescriptionError: The name, type or a link is missing or unknown, or something inside is wrong.
    """
    name = context.required(element, "name")
    kind = read_joint_type(context, element, _TYPES)
    axis, axis_length = _read_axis(context, element, kind)
    damping, friction = read_dynamics(context, element)
    return Joint(
        name,
        kind,
        parent=_read_end(context, element, "parent", link_indices),
        child=_read_end(context, element, "child", link_indices),
        frame=context.pose(element),
        axis=axis,
        axis_length=axis_length,
        limit=read_limit(context, element, kind, _length_scale(context, kind)),
        damping=damping,
        friction=friction,
        mimic=_read_mimic(context, element, kind),
        safety=_read_safety(context, element, kind),
    )


def _read_end(context: UrdfContext, joint: Element, tag: str, link_indices: dict[str, int]) -> int:
    element = joint.first(tag)
    if element is None:
        raise context.error(joint, f"<{tag}> is missing")
    return link_index(context, element, context.required(element, "link"), link_indices)


def _read_axis(context: UrdfContext, joint: Element, kind: JointType) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file."""
    element = joint.first("axis")
    if kind in WITHOUT_AXIS or element is None or "xyz" not in element.attributes:
        return (1.0, 0.0, 0.0), 1.0
    vector = context.vector(element, "xyz")
    if vector is None:
        raise context.error(element, f"xyz={shown(element.attributes['xyz'])} needs three numbers")
    x, y, z = vector
    length = hypot(x, y, z)
    if length == 0.0:
        if kind in NEEDS_AXIS:
            raise context.error(element, f"the axis of a {kind.value} joint has no length")
        return (1.0, 0.0, 0.0), 1.0
    if length == 1.0:
        return vector, 1.0
    return (x / length, y / length, z / length), length


def _length_scale(context: UrdfContext, kind: JointType) -> float:
    """Factor on positions of a joint of this type."""
    return context.scale if kind in SLIDES else 1.0


def _read_mimic(context: UrdfContext, joint: Element, kind: JointType) -> Mimic | None:
    element = joint.first("mimic")
    if element is None:
        return None
    scale = _length_scale(context, kind)
    try:
        return Mimic(
            context.required(element, "joint"),
            multiplier=context.value(element, "multiplier", 1.0),
            offset=context.value(element, "offset", 0.0) * scale,
        )
    except DescriptionError as error:
        # PyBullet ignores `<mimic>`, so a file with an invalid one still has to load.
        context.warn(element, f"ignored: {error.reason}")
        return None


def _read_safety(context: UrdfContext, joint: Element, kind: JointType) -> SafetyController | None:
    element = joint.first("safety_controller")
    if element is None:
        return None
    scale = _length_scale(context, kind)
    try:
        return SafetyController(
            soft_lower=context.value(element, "soft_lower_limit", 0.0) * scale,
            soft_upper=context.value(element, "soft_upper_limit", 0.0) * scale,
            k_position=context.value(element, "k_position", 0.0),
            k_velocity=context.value(element, "k_velocity", 0.0),
        )
    except DescriptionError as error:
        context.warn(element, f"ignored: {error.reason}")
        return None
