"""`<camera>`: where cameras are, and what they see."""

from __future__ import annotations

from math import pi

from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import FileCamera
from carom.formats.mjcf.compiled.names import full
from carom.formats.robot.context import shown
from carom.formats.xml_element import Element
from carom.native.trigonometry import atan2

_FIELD_OF_VIEW = 45.0
_FIXED = "fixed"
_AIMED = ("targetbody", "targetbodycom")
_MODES = (_FIXED, "track", "trackcom", *_AIMED)


def read_camera(scope: Scope, element: Element, body: str) -> FileCamera:
    """The camera that a `<camera>` of a body describes; raises `DescriptionError`."""
    element.note()
    context, attributes = scope.context, scope.attributes(element)
    width, height = context.numbers(element, "resolution", attributes.get("resolution", "1 1"), 2, 2)
    angle = context.number(element, attributes, "fovy", _FIELD_OF_VIEW)
    if "sensorsize" in attributes:
        _, tall = context.numbers(element, "sensorsize", attributes["sensorsize"], 2, 2)
        if "focal" in attributes:
            focal = context.numbers(element, "focal", attributes["focal"], 2, 2)[1]
            angle = 360.0 / pi * atan2(0.5 * tall, focal)
        elif "focalpixel" in attributes:
            pixels = context.numbers(element, "focalpixel", attributes["focalpixel"], 2, 2)[1]
            angle = 360.0 / pi * atan2(0.5 * height, pixels)
    mode = attributes.get("mode", _FIXED)
    if mode not in _MODES:
        raise context.error(element, f"mode={shown(mode)} must be one of {', '.join(_MODES)}")
    target = full(scope, attributes.get("target", "")) if mode in _AIMED else ""
    frame = scope.pose(element, attributes)
    return FileCamera(scope.name(element), body, frame, angle, (int(width), int(height)), mode, target)
