"""`<material>`: colours and textures, global and inside visuals."""

from __future__ import annotations

from pathlib import Path

from carom.description import Material
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown


def read_global_materials(context: FileContext) -> None:
    """Read the materials directly below `<robot>`; of several with the same name the first counts."""
    for element in context.root.all("material"):
        material = _read_material(context, element, element.attributes.get("name", ""))
        context.materials.setdefault(material.name, material)


def read_visual_material(context: FileContext, visual: Element) -> Material | None:
    """The material of a visual: defined in place, or referred to by its name.

    Later visuals can refer to a definition in place.

    Returns:
        The material; one with only a name if that name is not defined yet; None if there is none.
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


def _read_material(context: FileContext, element: Element, name: str) -> Material:
    texture = element.first("texture")
    colour = _components(context, element.first("color"), "rgba", 4)
    specular = _components(context, element.first("specular"), "rgb", 3)
    return Material(
        name,
        rgba=None if colour is None else (colour[0], colour[1], colour[2], colour[3]),
        specular=None if specular is None else (specular[0], specular[1], specular[2]),
        texture=None if texture is None else _texture(context, texture),
    )


def _components(
    context: FileContext, element: Element | None, attribute: str, count: int
) -> list[float] | None:
    text = "" if element is None else element.attributes.get(attribute, "")
    if element is None or not text:
        return None
    return context.parse_components(element, attribute, text, (count,))


def _texture(context: FileContext, texture: Element) -> Path | None:
    name = texture.attributes.get("filename", "")
    if not name:
        return None
    path = context.find_file(name)
    if path is None:
        context.warn(texture, f"texture {shown(name)} was not found; the material has no texture")
    return path
