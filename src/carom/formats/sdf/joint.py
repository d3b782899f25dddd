"""`<joint>` of SDF: type, axis, limits and dynamics."""

from __future__ import annotations

from math import hypot

from carom.description import Joint, JointLimit, JointType, Pose
from carom.description.pose import Vector3
from carom.description.transform import compose, inverse
from carom.formats.sdf.context import SdfContext
from carom.formats.urdf.context import shown
from carom.formats.xml_tree import Element

WORLD = "world"
_TYPES = {kind.value: kind for kind in JointType} | {"ball": JointType.SPHERICAL}
_WITHOUT_AXIS = (JointType.FIXED, JointType.FLOATING)
_NEEDS_LIMIT = (JointType.REVOLUTE, JointType.PRISMATIC)
_X: Vector3 = (1.0, 0.0, 0.0)
_Z: Vector3 = (0.0, 0.0, 1.0)


def read_sdf_joint(
    context: SdfContext, element: Element, link_indices: dict[str, int], poses: list[Pose]
) -> Joint:
    """A `<joint>` with everything in it. Its frame is that of the child.

    Args:
        context: The reading it belongs to.
        element: The `<joint>` element.
        link_indices: Index in `Robot.links` of every link, by name.
        poses: Poses of the links in the model's frame.

    Raises:
        DescriptionError: The name, type or a link is missing or unknown, or something inside is wrong.
    """
    name = context.required(element, "name")
    kind = _TYPES.get(context.required(element, "type"))
    if kind is None:
        raise context.error(
            element, f"unknown joint type {shown(element.attributes['type'])}; known are {', '.join(_TYPES)}"
        )
    pose = element.first("pose")
    if pose is not None and any(context.values(pose)):
        context.warn(pose, "ignored, as in PyBullet: the joint is at the origin of its child")
    parent = _read_end(context, element, "parent", link_indices)
    child = _read_end(context, element, "child", link_indices)
    axis, length = _X, 1.0
    limit, damping, friction = JointLimit(), 0.0, 0.0
    axis_element = element.first("axis")
    if axis_element is not None and kind not in _WITHOUT_AXIS:
        axis, length = _read_axis(context, axis_element, kind)
        limit = _read_limit(context, axis_element, kind)
        damping, friction = _read_dynamics(context, axis_element)
    return Joint(
        name,
        kind,
        parent=parent,
        child=child,
        frame=compose(inverse(poses[parent]), poses[child]),
        axis=axis,
        axis_length=length,
        limit=limit,
        damping=damping,
        friction=friction,
    )


def _read_end(context: SdfContext, joint: Element, tag: str, link_indices: dict[str, int]) -> int:
    name = context.text(joint, tag)
    if name is None:
        raise context.error(joint, f"<{tag}> is missing")
    if name not in link_indices:
        raise context.error(joint.first(tag) or joint, f"there is no link {shown(name)}")
    return link_indices[name]


def _read_axis(context: SdfContext, element: Element, kind: JointType) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file."""
    vector = context.triple(element, "xyz")
    if vector is None:
        return _Z, 1.0
    x, y, z = vector
    length = hypot(x, y, z)
    if length == 0.0:
        if kind is JointType.SPHERICAL:
            return _X, 1.0
        raise context.error(element, f"the axis of a {kind.value} joint has no length")
    return (x / length, y / length, z / length), length


def _read_limit(context: SdfContext, axis: Element, kind: JointType) -> JointLimit:
    element = axis.first("limit")
    if element is None:
        if kind in _NEEDS_LIMIT:
            raise context.error(axis, f"a {kind.value} joint needs a <limit>")
        return JointLimit()
    if kind is JointType.CONTINUOUS:
        return JointLimit()
    # Not scaled in PyBullet, not even for prismatic joints.
    return JointLimit(
        lower=context.value(element, "lower", 0.0),
        upper=context.value(element, "upper", -1.0),
        effort=context.value(element, "effort", 0.0),
        velocity=context.value(element, "velocity", 0.0),
        twist=context.value(element, "twist", -1.0),
    )


def _read_dynamics(context: SdfContext, axis: Element) -> tuple[float, float]:
    """Damping and friction."""
    element = axis.first("dynamics")
    if element is None:
        return 0.0, 0.0
    if element.first("damping") is None and element.first("friction") is None:
        raise context.error(element, "it states neither damping nor friction")
    return context.value(element, "damping", 0.0), context.value(element, "friction", 0.0)
