"""`<material>`: how a visual shape looks."""

from __future__ import annotations

from carom.description import Material
from carom.files.xml_element import Element
from carom.formats.sdf.context import SdfContext


def read_material(context: SdfContext, visual: Element) -> Material | None:
    """The material of a visual, with the visual's name."""
    element = visual.first("material")
    if element is None:
        return None
    # The format allows colours without opacity.
    diffuse = _colour(context, element.first("diffuse"), (4, 3) if context.as_written else (4,))
    if diffuse is not None and len(diffuse) == 3:
        diffuse.append(1.0)
    specular = _colour(context, element.first("specular"), (3, 4))
    return Material(
        visual.attributes.get("name") or "mat",
        rgba=None if diffuse is None else (diffuse[0], diffuse[1], diffuse[2], diffuse[3]),
        specular=None if specular is None else (specular[0], specular[1], specular[2]),
    )


def _colour(context: SdfContext, element: Element | None, counts: tuple[int, ...]) -> list[float] | None:
    return None if element is None else context.parse_components(element, element.tag, element.text, counts)
