"""`<joint>`: type, frame, axis, limits, dynamics, mimic and safety controller."""

from __future__ import annotations

from math import hypot

from carom.description import Joint, JointLimit, JointType, Mimic, SafetyController
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.formats.urdf.context import UrdfContext, shown
from carom.formats.xml_tree import Element

_TYPES = {kind.value: kind for kind in JointType}
_WITHOUT_AXIS = (JointType.FIXED, JointType.FLOATING)
_NEEDS_LIMIT = (JointType.REVOLUTE, JointType.PRISMATIC)
_NEEDS_AXIS_LENGTH = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.PLANAR)


def read_joint(context: UrdfContext, element: Element, link_indices: dict[str, int]) -> Joint:
    """A `<joint>` with everything in it.

    Args:
        context: The reading it belongs to.
        element: The `<joint>` element.
        link_indices: Index in `Robot.links` of every link, by name.

    Raises:
        DescriptionError: The name, type or a link is missing or unknown, or something inside is wrong.
    """
    name = context.required(element, "name")
    kind = _TYPES.get(context.required(element, "type"))
    if kind is None:
        raise context.error(
            element, f"unknown joint type {shown(element.attributes['type'])}; known are {', '.join(_TYPES)}"
        )
    axis, axis_length = _read_axis(context, element, kind)
    damping, friction = _read_dynamics(context, element)
    return Joint(
        name,
        kind,
        parent=_read_end(context, element, "parent", link_indices),
        child=_read_end(context, element, "child", link_indices),
        frame=context.origin(element),
        axis=axis,
        axis_length=axis_length,
        limit=_read_limit(context, element, kind),
        damping=damping,
        friction=friction,
        mimic=_read_mimic(context, element, kind),
        safety=_read_safety(context, element, kind),
    )


def _read_end(context: UrdfContext, joint: Element, tag: str, link_indices: dict[str, int]) -> int:
    element = joint.first(tag)
    if element is None:
        raise context.error(joint, f"<{tag}> is missing")
    name = context.required(element, "link")
    if name not in link_indices:
        raise context.error(element, f"there is no link {shown(name)}")
    return link_indices[name]


def _read_axis(context: UrdfContext, joint: Element, kind: JointType) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file."""
    element = joint.first("axis")
    if kind in _WITHOUT_AXIS or element is None or "xyz" not in element.attributes:
        return (1.0, 0.0, 0.0), 1.0
    vector = context.vector(element, "xyz")
    if vector is None:
        raise context.error(element, f"xyz={shown(element.attributes['xyz'])} needs three numbers")
    x, y, z = vector
    length = hypot(x, y, z)
    if length == 0.0:
        if kind in _NEEDS_AXIS_LENGTH:
            raise context.error(element, f"the axis of a {kind.value} joint has no length")
        return (1.0, 0.0, 0.0), 1.0
    if length == 1.0:
        return vector, 1.0
    return (x / length, y / length, z / length), length


def _read_limit(context: UrdfContext, joint: Element, kind: JointType) -> JointLimit:
    element = joint.first("limit")
    if element is None:
        if kind in _NEEDS_LIMIT:
            raise context.error(joint, f"a {kind.value} joint needs a <limit>")
        return JointLimit()
    # Limits left out are scaled like stated ones: it shows in what getJointInfo reports.
    scale = context.scale if kind is JointType.PRISMATIC else 1.0
    return JointLimit(
        lower=context.number(element, "lower", 0.0) * scale,
        upper=context.number(element, "upper", -1.0) * scale,
        effort=context.number(element, "effort", 0.0),
        velocity=context.number(element, "velocity", 0.0),
        twist=context.number(element, "twist", -1.0),
    )


def _read_dynamics(context: UrdfContext, joint: Element) -> tuple[float, float]:
    """Damping and friction."""
    element = joint.first("dynamics")
    if element is None:
        return 0.0, 0.0
    if "damping" not in element.attributes and "friction" not in element.attributes:
        raise context.error(element, "it states neither damping nor friction")
    return context.number(element, "damping", 0.0), context.number(element, "friction", 0.0)


def _read_mimic(context: UrdfContext, joint: Element, kind: JointType) -> Mimic | None:
    element = joint.first("mimic")
    if element is None:
        return None
    scale = context.scale if kind is JointType.PRISMATIC else 1.0
    try:
        return Mimic(
            context.required(element, "joint"),
            multiplier=context.number(element, "multiplier", 1.0),
            offset=context.number(element, "offset", 0.0) * scale,
        )
    except DescriptionError as error:
        # PyBullet never looks at it, so a file with a bad one still has to load.
        context.warn(element, f"ignored: {error.reason}")
        return None


def _read_safety(context: UrdfContext, joint: Element, kind: JointType) -> SafetyController | None:
    element = joint.first("safety_controller")
    if element is None:
        return None
    scale = context.scale if kind is JointType.PRISMATIC else 1.0
    try:
        return SafetyController(
            soft_lower=context.number(element, "soft_lower_limit", 0.0) * scale,
            soft_upper=context.number(element, "soft_upper_limit", 0.0) * scale,
            k_position=context.number(element, "k_position", 0.0),
            k_velocity=context.number(element, "k_velocity", 0.0),
        )
    except DescriptionError as error:
        context.warn(element, f"ignored: {error.reason}")
        return None
