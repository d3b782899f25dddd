"""`<joint>`: type, frame, axis, limits, dynamics, mimic and safety controller."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from carom.description import Joint, JointType, Mimic, SafetyController
from carom.description.joint import JOINTS, SLIDES, WITHOUT_AXIS
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown
from carom.formats.robot.joint import (
    ALONG_X,
    link_index,
    read_dynamics,
    read_joint_type,
    read_limit,
    unit_axis,
)
from carom.formats.urdf.transmission import with_rotor

Ignored = TypeVar("Ignored")

_TYPES = {it.urdf: kind for kind, it in JOINTS.items() if it.urdf}


def read_joint(context: FileContext, element: Element, link_indices: dict[str, int]) -> Joint:
    """The joint that a `<joint>` element describes; links have indices in `Robot.links`, by name.

    Raises:
        DescriptionError: The name, type or a link is missing or unknown, or something inside is wrong.
    """
    name = context.required(element, "name")
    kind = read_joint_type(context, element, _TYPES)
    axis, axis_length = _read_axis(context, element, kind)
    if context.written is not None:
        axis_length = 1.0
    damping, friction = read_dynamics(context, element)
    scale = context.scale if kind in SLIDES else 1.0
    joint = Joint(
        name,
        kind,
        parent=_read_end(context, element, "parent", link_indices),
        child=_read_end(context, element, "child", link_indices),
        frame=context.pose(element),
        axis=axis,
        axis_length=axis_length,
        limit=read_limit(context, element, kind, scale),
        damping=damping,
        friction=friction,
        mimic=_if_valid(context, element.first("mimic"), scale, _read_mimic),
        safety=_if_valid(context, element.first("safety_controller"), scale, _read_safety),
    )
    return joint if context.written is None else with_rotor(context, element, joint)


def _read_end(context: FileContext, joint: Element, tag: str, link_indices: dict[str, int]) -> int:
    element = joint.first(tag)
    if element is None:
        raise context.error(joint, f"<{tag}> is missing")
    return link_index(context, element, context.required(element, "link"), link_indices)


def _read_axis(context: FileContext, joint: Element, kind: JointType) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file."""
    element = joint.first("axis")
    if kind in WITHOUT_AXIS or element is None or "xyz" not in element.attributes:
        return ALONG_X
    vector = context.vector(element, "xyz")
    if vector is None:
        raise context.error(element, f"xyz={shown(element.attributes['xyz'])} needs three numbers")
    return unit_axis(context, element, kind, vector)


def _read_mimic(context: FileContext, element: Element, scale: float) -> Mimic:
    return Mimic(
        context.required(element, "joint"),
        multiplier=context.value(element, "multiplier", 1.0),
        offset=context.value(element, "offset", 0.0) * scale,
    )


def _read_safety(context: FileContext, element: Element, scale: float) -> SafetyController:
    return SafetyController(
        soft_lower=context.value(element, "soft_lower_limit", 0.0) * scale,
        soft_upper=context.value(element, "soft_upper_limit", 0.0) * scale,
        k_position=context.value(element, "k_position", 0.0),
        k_velocity=context.value(element, "k_velocity", 0.0),
    )


def _if_valid(
    context: FileContext,
    element: Element | None,
    scale: float,
    read: Callable[[FileContext, Element, float], Ignored],
) -> Ignored | None:
    """What an element describes; None, with a warning, if it is invalid: PyBullet ignores such elements."""
    try:
        return None if element is None else read(context, element, scale)
    except DescriptionError as error:
        context.leave_out(element or context.root, "ignored", error.reason)
        return None
