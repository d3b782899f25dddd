"""Colours and textures of geoms, from their own attributes and from materials."""

from __future__ import annotations

from dataclasses import replace

from carom.description import Material
from carom.description.pose import Vector3
from carom.description.texture import Texture
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.looks.textures import read_texture
from carom.formats.mjcf.defaults import Attributes, class_defaults
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import shown

GREY = (0.5, 0.5, 0.5, 1.0)
_SPECULAR = 0.5
_COLOURS = ("rgb", "rgba")


def read_material(
    context: CompiledContext,
    element: Element,
    attributes: Attributes,
    size: Vector3 | None = None,
) -> Material:
    """The material of a geom, site or tendon; its own colour comes before that of its material.

    Args:
        context: The reading of the file.
        element: The geom, site or tendon.
        attributes: Its attributes with defaults.
        size: Half extents of a geom, 0 for none [m]; only with them there is a texture.

    Raises:
        DescriptionError: There is no material of the name that it states, or no such texture.
    """
    name = attributes.get("material", "")
    rgba, specular, reflectance, image = GREY, _SPECULAR, 0.0, None
    if name:
        asset = context.named.material.get(name)
        if asset is None:
            raise context.error(element, f"there is no material {shown(name)}")
        asset.note()
        stated = layered(class_defaults(context, asset, None), asset.attributes)
        rgba = (1.0, 1.0, 1.0, 1.0)
        if "rgba" in stated:
            rgba = _rgba(context, asset, stated["rgba"])
        specular = context.number(asset, stated, "specular", _SPECULAR)
        reflectance = context.number(asset, stated, "reflectance", 0.0)
        if size is not None:
            image = _texture(context, asset, stated, size)
    if "rgba" in attributes:
        rgba = _rgba(context, element, attributes["rgba"])
    return Material(name, rgba, (specular, specular, specular), image=image, reflectance=reflectance)


def _rgba(context: CompiledContext, element: Element, text: str) -> tuple[float, float, float, float]:
    red, green, blue, opacity = context.numbers(element, "rgba", text, 4, 4)
    return (red, green, blue, opacity)


def _texture(context: CompiledContext, asset: Element, stated: Attributes, size: Vector3) -> Texture | None:
    """The texture of a material on a geom; of several layers that of its colour."""
    names = [stated["texture"]] if "texture" in stated else []
    for layer in asset.children:
        if layer.tag == "layer" and layer.attributes.get("role") in _COLOURS:
            layer.note()
            names = [layer.attributes.get("texture", "")]
    if not names:
        return None
    element = context.named.texture.get(names[0])
    if element is None:
        raise context.error(asset, f"there is no texture {shown(names[0])}")
    texture = read_texture(context, element)
    if texture is None:
        return None
    across, along = context.numbers(asset, "texrepeat", stated.get("texrepeat", "1 1"), 2, 2)
    uniform = context.flag(asset, stated, "texuniform", False)
    return replace(texture, repeat=(across, along), uniform=uniform, size=size)
