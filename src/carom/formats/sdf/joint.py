"""`<joint>` of SDF: type, axis, limits and dynamics."""

from __future__ import annotations

from math import inf

from carom.description import Joint, JointLimit, JointType, Pose
from carom.description.joint import JOINTS, WITHOUT_AXIS, WITHOUT_LIMIT
from carom.description.pose import Vector3
from carom.description.transform import compose, inverse
from carom.files.xml_element import Element
from carom.formats.robot.joint import (
    ALONG_X,
    link_index,
    read_dynamics,
    read_joint_type,
    read_limit,
    unit_axis,
)
from carom.formats.sdf.context import SdfContext

WORLD = "world"
TYPES: dict[str, JointType] = {name: kind for kind, it in JOINTS.items() for name in it.sdf}
"""Types by their names in files."""
_BULLETS = {name: kind for name, kind in TYPES.items() if JOINTS[kind].is_bullets}

Z: Vector3 = (0.0, 0.0, 1.0)
"""Axis of a joint that states none."""


def read_sdf_joint(
    context: SdfContext, element: Element, link_indices: dict[str, int], poses: list[Pose]
) -> Joint:
    """The joint that a `<joint>` element describes; its frame is that of the child link.

    Links have indices in `Robot.links`, by name, and poses in the model's frame.

    Raises:
        DescriptionError: The name, type or a link is missing or unknown, or something inside is wrong.
    """
    name = context.required(element, "name")
    kind = read_joint_type(context, element, _BULLETS)
    pose = element.first("pose")
    if pose is not None and any(context.values(pose)):
        context.warn(pose, "ignored, as in PyBullet: the joint is at the origin of its child")
    parent = read_end(context, element, "parent", link_indices)
    child = read_end(context, element, "child", link_indices)
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


def read_bounds(context: SdfContext, axis: Element) -> JointLimit:
    """The `<limit>` of an axis with the defaults of the format: what is not stated has no bound."""
    element = axis.first("limit")
    if element is None:
        return JointLimit(effort=inf, velocity=inf)
    effort, velocity = (context.bound(element, name, -1.0) for name in ("effort", "velocity"))
    return JointLimit(
        lower=context.bound(element, "lower", -inf),
        upper=context.bound(element, "upper", inf),
        effort=effort if effort >= 0.0 else inf,
        velocity=velocity if velocity >= 0.0 else inf,
    )


def read_end(context: SdfContext, joint: Element, tag: str, link_indices: dict[str, int]) -> int:
    """The index of the link at an end of a joint: `parent` or `child`."""
    name = context.text(joint, tag)
    if name is None:
        raise context.error(joint, f"<{tag}> is missing")
    return link_index(context, joint.first(tag) or joint, name, link_indices)


def _read_axis(context: SdfContext, element: Element, kind: JointType) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file."""
    vector = context.triple(element, "xyz")
    return (Z, 1.0) if vector is None else unit_axis(context, element, kind, vector)
