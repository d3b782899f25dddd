"""`<light>`, `<visual>` and the sky: how a scene is seen, besides its shapes."""

from __future__ import annotations

from math import hypot

from carom.description.pose import Pose, Vector3
from carom.description.stage import Headlight, Stage, StageLight
from carom.description.transform import compose, rotate
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.looks.textures import read_texture
from carom.formats.mjcf.compiled.model import FileLight
from carom.formats.mjcf.compiled.names import full
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

_KINDS = ("spot", "directional", "point", "image")
_FIXED = "fixed"
_AIMED = ("targetbody", "targetbodycom")
_MODES = (_FIXED, "track", "trackcom", *_AIMED)
_ALL_SIDES = 180.0


def read_light(scope: Scope, element: Element, body: str) -> FileLight | None:
    """The light that a `<light>` of a body describes; None for one that is switched off, or lights nothing.

    Raises:
        DescriptionError: An attribute has no meaning.
    """
    element.note()
    scope.name(element)
    context, attributes = scope.context, scope.attributes(element)
    kind = attributes.get("type", "spot")
    if kind not in _KINDS:
        raise context.error(element, f"type={shown(kind)} must be one of {', '.join(_KINDS)}")
    if context.flag(element, attributes, "directional", False):
        kind = "directional"
    mode = attributes.get("mode", _FIXED)
    if mode not in _MODES:
        raise context.error(element, f"mode={shown(mode)} must be one of {', '.join(_MODES)}")
    if kind == "image":
        context.leave_out(element, "none for the dynamics", "lights of images are not drawn")
        return None
    own = _three(context, element, attributes, "pos", (0.0, 0.0, 0.0))
    direction = rotate(scope.into.orientation, _three(context, element, attributes, "dir", (0.0, 0.0, -1.0)))
    length = hypot(*direction)
    if length == 0.0:
        raise context.error(element, "dir must not be zero")
    x, y, z = (part / length for part in direction)
    usual = StageLight()
    light = StageLight(
        position=compose(scope.into, Pose(own)).position,
        direction=(x, y, z),
        directional=kind == "directional",
        cutoff=_ALL_SIDES if kind == "point" else context.number(element, attributes, "cutoff", usual.cutoff),
        exponent=0.0 if kind == "point" else context.number(element, attributes, "exponent", usual.exponent),
        attenuation=_three(context, element, attributes, "attenuation", usual.attenuation),
        ambient=_three(context, element, attributes, "ambient", usual.ambient),
        diffuse=_three(context, element, attributes, "diffuse", usual.diffuse),
        specular=_three(context, element, attributes, "specular", usual.specular),
        casts_shadow=context.flag(element, attributes, "castshadow", True),
    )
    target = full(scope, attributes.get("target", "")) if mode in _AIMED else ""
    is_on = context.flag(element, attributes, "active", True)
    return FileLight(body, light, mode, target) if is_on else None


def read_stage(context: CompiledContext) -> Stage:
    """The sky of a file, its headlight and its haze.

    Raises:
        DescriptionError: An attribute has no meaning.
    """
    headlight, haze = Headlight(), (1.0, 1.0, 1.0)
    is_on = True
    for visual in context.root.all("visual"):
        for element in visual.children:
            if element.tag == "headlight":
                element.note()
                attributes = element.attributes
                ambient, diffuse, specular = (
                    _three(context, element, attributes, name, getattr(headlight, name))
                    for name in ("ambient", "diffuse", "specular")
                )
                headlight = Headlight(ambient, diffuse, specular)
                is_on = context.number(element, attributes, "active", 1.0 if is_on else 0.0) != 0.0
            elif element.tag == "rgba" and "haze" in element.attributes:
                element.note()
                haze = _colour(context, element, element.attributes["haze"])
    sky = None
    for assets in context.root.all("asset"):
        for element in assets.children:
            if sky is None and element.tag == "texture" and element.attributes.get("type") == "skybox":
                sky = read_texture(context, element)
    return Stage(headlight=headlight if is_on else None, sky=sky, haze=haze)


def _three(
    context: CompiledContext, element: Element, attributes: Attributes, name: str, usual: Vector3
) -> Vector3:
    if name not in attributes:
        return usual
    x, y, z = context.numbers(element, name, attributes[name], 3, 3)
    return (x, y, z)


def _colour(context: CompiledContext, element: Element, text: str) -> Vector3:
    red, green, blue, _ = context.numbers(element, "haze", text, 4, 4)
    return (red, green, blue)
