"""`<joint>`: type, links, limits and dynamics."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot

from carom.description import JointLimit, JointType
from carom.description.joint import NEEDS_AXIS, NEEDS_LIMIT
from carom.description.pose import Vector3
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown

ALONG_X: tuple[Vector3, float] = (1.0, 0.0, 0.0), 1.0
"""Axis, and its length in the file, of a joint that states none."""


def read_joint_type(context: FileContext, element: Element, types: Mapping[str, JointType]) -> JointType:
    """The type a `<joint>` states; raises `DescriptionError` where it is missing or unknown."""
    name = context.required(element, "type")
    if name not in types:
        raise context.error(element, f"unknown joint type {shown(name)}; known are {', '.join(types)}")
    return types[name]


def link_index(context: FileContext, element: Element, name: str, link_indices: Mapping[str, int]) -> int:
    """The index of a link that an element names; raises `DescriptionError` where there is none."""
    if name not in link_indices:
        raise context.error(element, f"there is no link {shown(name)}")
    return link_indices[name]


def unit_axis(
    context: FileContext, element: Element, kind: JointType, axis: Vector3
) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file; along x where it has none and the joint needs none."""
    x, y, z = axis
    length = hypot(x, y, z)
    if length != 0.0:
        return (x / length, y / length, z / length), length
    if kind in NEEDS_AXIS:
        raise context.error(element, f"the axis of a {kind.value} joint has no length")
    return ALONG_X


def read_limit(context: FileContext, owner: Element, kind: JointType, scale: float = 1.0) -> JointLimit:
    """The `<limit>` below an element; `scale` is a factor on lower and upper limit.

    Raises:
        DescriptionError: A joint of this type needs a limit, or a value is NaN.
    """
    element = owner.first("limit")
    if element is None:
        if kind in NEEDS_LIMIT:
            raise context.error(owner, f"a {kind.value} joint needs a <limit>")
        return JointLimit()
    # Missing limits are scaled like given ones, which is visible in PyBullet's getJointInfo.
    return JointLimit(
        lower=context.bound(element, "lower", 0.0) * scale,
        upper=context.bound(element, "upper", -1.0) * scale,
        effort=context.bound(element, "effort", 0.0),
        velocity=context.bound(element, "velocity", 0.0),
        twist=context.bound(element, "twist", -1.0),
    )


def read_dynamics(context: FileContext, owner: Element) -> tuple[float, float]:
    """Damping and friction in the `<dynamics>` below an element."""
    element = owner.first("dynamics")
    if element is None:
        return 0.0, 0.0
    if context.written is None and not (
        context.states(element, "damping") or context.states(element, "friction")
    ):
        raise context.error(element, "it states neither damping nor friction")
    return context.value(element, "damping", 0.0), context.value(element, "friction", 0.0)
