"""Positions, and orientations in all forms that MJCF allows."""

from __future__ import annotations

from math import hypot

from carom.description import Pose
from carom.description.pose import Quaternion, Vector3
from carom.description.transform import (
    dot,
    multiplied,
    quaternion_from_matrix,
    rotation_matrix,
    transposed,
    turn_of_z,
)
from carom.files.xml_element import Element
from carom.formats.mjcf.context import MjcfContext
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown
from carom.native.trigonometry import cos, sin

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def read_pose(
    context: MjcfContext, element: Element, attributes: Attributes, *, radians: bool = False
) -> Pose:
    """The pose of an element, in the frame in which the file gives it; `attributes` include defaults.

    With `radians` the angle of `axisangle` is in radians, regardless of compiler options.
    """
    position = (0.0, 0.0, 0.0)
    if "pos" in attributes:
        position = context.triple(element, "pos", attributes["pos"])
    return Pose(position, _read_orientation(context, element, attributes, radians))


def _read_orientation(
    context: MjcfContext, element: Element, attributes: Attributes, radians: bool
) -> Quaternion:
    if "axisangle" in attributes:
        x, y, z, angle = _numbers(context, element, attributes, "axisangle", 4)
        return _turn(context, element, (x, y, z), angle if radians else context.angle(angle))
    if "quat" in attributes:
        w, x, y, z = _numbers(context, element, attributes, "quat", 4)
        if w == x == y == z == 0.0:
            raise context.error(element, "quat has no length, so it is no rotation")
        return quaternion_from_matrix(rotation_matrix((x, y, z, w)))
    if "euler" in attributes:
        return _euler(context, element, _numbers(context, element, attributes, "euler", 3))
    if "xyaxes" in attributes:
        return _from_axes(context, element, _numbers(context, element, attributes, "xyaxes", 6))
    if "zaxis" in attributes:
        x, y, z = _numbers(context, element, attributes, "zaxis", 3)
        return turn_of_z(_unit(context, element, (x, y, z)))
    return _NO_TURN


def _numbers(
    context: MjcfContext, element: Element, attributes: Attributes, name: str, count: int
) -> list[float]:
    numbers = context.singles(element, name, attributes[name])
    if len(numbers) != count:
        raise context.error(element, f"{name}={shown(attributes[name])} needs {count} numbers")
    return numbers


def _unit(context: MjcfContext, element: Element, vector: Vector3) -> Vector3:
    length = hypot(*vector)
    if length == 0.0:
        raise context.error(element, "an axis has no length")
    return (vector[0] / length, vector[1] / length, vector[2] / length)


def _turn(context: MjcfContext, element: Element, axis: Vector3, angle: float) -> Quaternion:
    x, y, z = _unit(context, element, axis)
    s = sin(0.5 * angle)
    return (x * s, y * s, z * s, cos(0.5 * angle))


def _euler(context: MjcfContext, element: Element, angles: list[float]) -> Quaternion:
    turn: Quaternion = _NO_TURN
    for letter, angle in zip(context.compiler.euler_sequence, angles, strict=True):
        step = _turn(context, element, _AXES[letter.lower()], context.angle(angle))
        # Lower case: about the rotated (intrinsic) axes; upper case: about the fixed axes of the parent.
        turn = multiplied(turn, step) if letter.islower() else multiplied(step, turn)
    return turn


def _from_axes(context: MjcfContext, element: Element, numbers: list[float]) -> Quaternion:
    x = _unit(context, element, (numbers[0], numbers[1], numbers[2]))
    y = (numbers[3], numbers[4], numbers[5])
    along = dot(x, y)
    y = _unit(context, element, (y[0] - along * x[0], y[1] - along * x[1], y[2] - along * x[2]))
    z = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    return quaternion_from_matrix(transposed((x, y, z)))
