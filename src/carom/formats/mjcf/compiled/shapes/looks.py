"""Colours and textures of geoms, from their own attributes and from materials."""

from __future__ import annotations

from pathlib import Path

from carom.description import Material
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.defaults import Attributes, class_defaults
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import shown
from carom.formats.xml_element import Element

_GREY = (0.5, 0.5, 0.5, 1.0)
_SPECULAR = 0.5


def read_material(context: CompiledContext, element: Element, attributes: Attributes) -> Material:
    """The material of a geom; the colour of its own attributes comes before that of its material.

    Raises:
        DescriptionError: There is no material of the name that it states.
    """
    name = attributes.get("material", "")
    rgba, specular, texture = _GREY, _SPECULAR, None
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
        if "texture" in stated:
            texture = _texture(context, asset, stated["texture"])
    if "rgba" in attributes:
        rgba = _rgba(context, element, attributes["rgba"])
    return Material(name, rgba, (specular, specular, specular), texture)


def _rgba(context: CompiledContext, element: Element, text: str) -> tuple[float, float, float, float]:
    red, green, blue, opacity = context.numbers(element, "rgba", text, 4, 4)
    return (red, green, blue, opacity)


def _texture(context: CompiledContext, element: Element, name: str) -> Path | None:
    asset = context.named.texture.get(name)
    if asset is None:
        raise context.error(element, f"there is no texture {shown(name)}")
    asset.note()
    attributes = layered(class_defaults(context, asset, None), asset.attributes)
    if "file" not in attributes or attributes.get("type", "cube") != "2d":
        return None
    return context.asset_file(asset, attributes["file"], context.compiler.texture_directory)
