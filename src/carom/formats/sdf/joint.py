"""`<joint>` of SDF: type, axis, limits and dynamics."""

from __future__ import annotations

from carom.description import Joint, JointLimit, JointType, Pose
from carom.description.joint import WITHOUT_AXIS, WITHOUT_LIMIT
from carom.description.pose import Vector3
from carom.description.transform import compose, inverse
from carom.formats.robot.joint import (
    ALONG_X,
    link_index,
    read_dynamics,
    read_joint_type,
    read_limit,
    unit_axis,
)
from carom.formats.sdf.context import SdfContext
from carom.formats.xml_element import Element

WORLD = "world"
_TYPES = {kind.value: kind for kind in JointType} | {"ball": JointType.SPHERICAL}
_Z: Vector3 = (0.0, 0.0, 1.0)


def read_sdf_joint(
    context: SdfContext, element: Element, link_indices: dict[str, int], poses: list[Pose]
) -> Joint:
    """The joint that a `<joint>` element describes; its frame is that of the child link.

    Links have indices in `Robot.links`, by name, and poses in the model's frame.

    Raises:
        DescriptionError: The name, type or a link is missing or unknown, or something inside is wrong.
    """
    name = context.required(element, "name")
    kind = read_joint_type(context, element, _TYPES)
    pose = element.first("pose")
    if pose is not None and any(context.values(pose)):
        context.warn(pose, "ignored, as in PyBullet: the joint is at the origin of its child")
    parent = _read_end(context, element, "parent", link_indices)
    child = _read_end(context, element, "child", link_indices)
    axis, length = ALONG_X
    limit, damping, friction = JointLimit(), 0.0, 0.0
    axis_element = element.first("axis")
    if axis_element is not None and kind not in WITHOUT_AXIS:
        axis, length = _read_axis(context, axis_element, kind)
        if kind not in WITHOUT_LIMIT:
            # Not scaled in PyBullet, not even for prismatic joints.
            limit = read_limit(context, axis_element, kind)
        damping, friction = read_dynamics(context, axis_element)
    frame = compose(inverse(poses[parent]), poses[child])
    return Joint(name, kind, parent, child, frame, axis, length, limit, damping, friction)


def _read_end(context: SdfContext, joint: Element, tag: str, link_indices: dict[str, int]) -> int:
    name = context.text(joint, tag)
    if name is None:
        raise context.error(joint, f"<{tag}> is missing")
    return link_index(context, joint.first(tag) or joint, name, link_indices)


def _read_axis(context: SdfContext, element: Element, kind: JointType) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file."""
    vector = context.triple(element, "xyz")
    return (_Z, 1.0) if vector is None else unit_axis(context, element, kind, vector)
