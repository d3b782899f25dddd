"""`<link>` of SDF: pose, inertia, shapes and contact parameters."""

from __future__ import annotations

from carom.description import Link, Material, Visual
from carom.formats.robot.link import read_collision, read_contact, read_inertial
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.geometry import read_sdf_geometry
from carom.formats.xml_element import Element


def read_sdf_link(context: SdfContext, element: Element) -> Link:
    """The link that a `<link>` element describes, without its pose.

    Raises:
        DescriptionError: The name is missing, or something inside is wrong.
    """
    name = context.required(element, "name")
    return Link(
        name,
        inertial=read_inertial(
            context, element, name, lambda inertial: context.non_negative(inertial, "mass")
        ),
        collisions=tuple(
            read_collision(context, child, read_sdf_geometry(context, child))
            for child in element.all("collision")
        ),
        visuals=tuple(_read_visual(context, child) for child in element.all("visual")),
        contact=read_contact(element.first("contact"), context.number),
        user_data=context.user_data(element),
    )


def _read_visual(context: SdfContext, element: Element) -> Visual:
    name = element.attributes.get("name", "")
    return Visual(
        read_sdf_geometry(context, element),
        frame=context.pose(element),
        name=name,
        material=_read_material(context, element.first("material"), name or "mat"),
        user_data=context.user_data(element),
    )


def _read_material(context: SdfContext, element: Element | None, name: str) -> Material | None:
    if element is None:
        return None
    diffuse = _colour(context, element.first("diffuse"), (4,))
    specular = _colour(context, element.first("specular"), (3, 4))
    return Material(
        name,
        rgba=None if diffuse is None else (diffuse[0], diffuse[1], diffuse[2], diffuse[3]),
        specular=None if specular is None else (specular[0], specular[1], specular[2]),
    )


def _colour(context: SdfContext, element: Element | None, counts: tuple[int, ...]) -> list[float] | None:
    return None if element is None else context.parse_components(element, element.tag, element.text, counts)
