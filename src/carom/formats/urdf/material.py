"""`<material>`: colours and textures, global and inside visuals."""

from __future__ import annotations

from pathlib import Path

from carom.description import Material
from carom.description.link import Rgba
from carom.formats.urdf.context import UrdfContext
from carom.formats.xml_tree import Element


def read_global_materials(context: UrdfContext) -> None:
    """The materials that stand directly below `<robot>`; the first of a name counts."""
    for element in context.robot.all("material"):
        material = _read_material(context, element, element.attributes.get("name", ""))
        context.materials.setdefault(material.name, material)


def read_visual_material(context: UrdfContext, visual: Element) -> Material | None:
    """The material of a visual: defined in place, or named.

    A definition in place also serves later visuals that name it.

    Returns:
        The material; a bare name where nothing of that name is known yet; None where there is none.
    """
    element = visual.first("material")
    if element is None:
        return None
    name = context.required(element, "name")
    if element.first("texture") or element.first("color") or element.first("specular"):
        material = _read_material(context, element, name)
        context.materials[name] = material
        return material
    return context.materials.get(name) or Material(name)


def _read_material(context: UrdfContext, element: Element, name: str) -> Material:
    colour = element.first("color")
    specular = element.first("specular")
    texture = element.first("texture")
    return Material(
        name,
        rgba=None if colour is None else _rgba(context, colour),
        specular=None
        if specular is None or "rgb" not in specular.attributes
        else context.vector(specular, "rgb"),
        texture=None if texture is None else _texture(context, texture),
    )


def _rgba(context: UrdfContext, colour: Element) -> Rgba | None:
    words = colour.attributes.get("rgba", "").split()
    if not words:
        return None
    if len(words) != 4:
        context.warn(colour, f"rgba={colour.attributes['rgba']!r} needs four numbers; ignored")
        return None
    red, green, blue, alpha = (context.parse_number(colour, "rgba", word) for word in words)
    return (red, green, blue, alpha)


def _texture(context: UrdfContext, texture: Element) -> Path | None:
    name = texture.attributes.get("filename", "")
    if not name:
        return None
    path = context.find_file(name)
    if path is None:
        context.warn(texture, f"texture {name!r} was not found; the material goes without")
    return path
