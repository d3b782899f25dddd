"""`<camera>`: where cameras are, and what they see."""

from __future__ import annotations

from math import pi

from carom.description.sensor import RangeImage
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import FileCamera, Lens
from carom.formats.mjcf.compiled.names import full
from carom.formats.robot.context import shown
from carom.native.trigonometry import atan2, cos, sin

_FIELD_OF_VIEW = 45.0
_FIXED = "fixed"
_PERSPECTIVE, _ORTHOGRAPHIC = "perspective", "orthographic"
_AIMED = ("targetbody", "targetbodycom")
_MODES = (_FIXED, "track", "trackcom", *_AIMED)


def read_camera(scope: Scope, element: Element, body: str) -> FileCamera:
    """The camera that a `<camera>` of a body describes; raises `DescriptionError`."""
    element.note()
    context, attributes = scope.context, scope.attributes(element)
    width, height = context.numbers(element, "resolution", attributes.get("resolution", "1 1"), 2, 2)
    angle = context.number(element, attributes, "fovy", _FIELD_OF_VIEW)
    lens: Lens | None = None
    if "sensorsize" in attributes:
        wide, tall = context.numbers(element, "sensorsize", attributes["sensorsize"], 2, 2)
        if min(wide, tall, width, height) <= 0.0:
            raise context.error(element, "sensorsize and resolution must be positive")

        def shares(name: str) -> tuple[float, float]:
            """Lengths on the sensor, or in pixels, which come first, per size of the image; 0 for none."""
            for stated, sizes in ((f"{name}pixel", (width, height)), (name, (wide, tall))):
                if stated in attributes:
                    x, y = context.numbers(element, stated, attributes[stated], 2, 2)
                    return x / sizes[0], y / sizes[1]
            return 0.0, 0.0

        (fx, fy), (x, y) = shares("focal"), shares("principal")
        if fx > 0.0 and fy > 0.0:
            lens = Lens((fx, fy), (0.5 - x, 0.5 - y))
            angle = 360.0 / pi * atan2(0.5, fy)
    elif "focal" in attributes or "principal" in attributes:
        raise context.error(element, "focal and principal need a sensorsize")
    projection = attributes.get("projection", _PERSPECTIVE)
    if projection not in (_PERSPECTIVE, _ORTHOGRAPHIC):
        raise context.error(
            element, f"projection={shown(projection)} must be {_PERSPECTIVE} or {_ORTHOGRAPHIC}"
        )
    mode = attributes.get("mode", _FIXED)
    if mode not in _MODES:
        raise context.error(element, f"mode={shown(mode)} must be one of {', '.join(_MODES)}")
    target = full(scope, attributes.get("target", "")) if mode in _AIMED else ""
    frame = scope.pose(element, attributes)
    return FileCamera(
        scope.name(element),
        body,
        frame,
        angle,
        (int(width), int(height)),
        mode,
        target,
        lens,
        is_orthographic=projection == _ORTHOGRAPHIC,
    )


def range_image(camera: FileCamera) -> RangeImage:
    """The rays through the pixels of a camera, as its images have them."""
    width, height = camera.resolution
    wide = width / max(height, 1)
    if camera.is_orthographic:
        per_height = 1.0 / camera.field_of_view
        return RangeImage(width, height, (per_height / wide, per_height), is_orthographic=True)
    if camera.lens is not None:
        return RangeImage(width, height, camera.lens.focal, camera.lens.middle)
    half = camera.field_of_view * pi / 360.0
    tall = 0.5 * cos(half) / sin(half)
    return RangeImage(width, height, (tall / wide, tall))
