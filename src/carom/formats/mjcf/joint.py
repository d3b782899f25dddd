"""`<joint>`: type, position, axis and range."""

from __future__ import annotations

from math import hypot

from carom.description import Joint, JointLimit, JointType, Pose
from carom.description.joint import BALL, HINGE, SLIDER, UNLIMITED
from carom.description.pose import Vector3
from carom.description.transform import rotate
from carom.files.xml_element import Element
from carom.formats.mjcf.context import SINGLE_PI, MjcfContext, single
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

FREE = "free"
_UNLIMITED = (1.0, 0.0)
_HINGE, _SLIDE, _BALL, _FIXED = "hinge", "slide", "ball", "fixed"


def read_joint(
    context: MjcfContext,
    element: Element,
    attributes: Attributes,
    *,
    parent: int,
    child: int,
    frame: Pose,
    into: Pose,
) -> Joint:
    """The joint between two links that a `<joint>` element of a body describes.

    `attributes` include defaults; `frame` is the joint frame in the parent link, and `into` the pose, in the
    body's frame, of the frame in which its axis is given. Raises `DescriptionError` if an attribute is
    missing or invalid.
    """
    kind = attributes.get("type", _HINGE)
    if kind not in (_HINGE, _SLIDE, _BALL, _FIXED):
        raise context.error(element, f"unknown joint type {shown(kind)}, or one that is not allowed here")
    lower, upper = _range(context, element, attributes, kind)
    limited = lower <= upper
    axis, length = _axis(context, element, attributes, kind, into)
    types = {_HINGE: HINGE if limited else UNLIMITED[HINGE], _SLIDE: SLIDER, _BALL: BALL}
    return Joint(
        "",
        types.get(kind, JointType.FIXED),
        parent,
        child,
        frame,
        axis,
        length,
        JointLimit(lower, upper) if kind != _BALL else JointLimit(),
    )


def joint_position(context: MjcfContext, element: Element, attributes: Attributes) -> Vector3:
    """Position of a joint, in the frame in which the file gives it."""
    text = attributes.get("pos")
    return (0.0, 0.0, 0.0) if text is None else context.triple(element, "pos", text)


def _axis(
    context: MjcfContext, element: Element, attributes: Attributes, kind: str, into: Pose
) -> tuple[Vector3, float]:
    """Unit axis and the length it had in the file; along x where there is none, as in PyBullet."""
    text = attributes.get("axis")
    if text is None or kind in (_BALL, _FIXED):
        return rotate(into.orientation, (1.0, 0.0, 0.0)), 1.0
    x, y, z = rotate(into.orientation, context.triple(element, "axis", text))
    length = hypot(x, y, z)
    if length == 0.0:
        raise context.error(element, "the axis has no length")
    return (x / length, y / length, z / length), length


def _range(context: MjcfContext, element: Element, attributes: Attributes, kind: str) -> tuple[float, float]:
    """Lower and upper limit [rad or m]; lower > upper if there are none."""
    limited = attributes.get("limited", "auto")
    text = attributes.get("range")
    if limited == "auto" and context.compiler.auto_limits and text is not None:
        limited = "true"
    if limited != "true":
        return _UNLIMITED
    if text is None:
        raise context.error(element, "a limited joint needs a range")
    numbers = context.singles(element, "range", text)
    if len(numbers) != 2:
        raise context.error(element, f"range={shown(text)} needs two numbers")
    lower, upper = numbers
    if kind == _HINGE and context.compiler.degrees:
        return _radians(lower), _radians(upper)
    return lower, upper


def _radians(degrees: float) -> float:
    """Degrees converted to radians in single precision."""
    return single(single(degrees * SINGLE_PI) / 180.0)
