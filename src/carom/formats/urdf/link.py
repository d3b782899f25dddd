"""`<link>`: inertia, shapes and contact parameters."""

from __future__ import annotations

from carom.description import Link, Visual
from carom.formats.robot.link import read_collision, read_contact, read_inertial
from carom.formats.urdf.context import UrdfContext
from carom.formats.urdf.geometry import read_urdf_geometry
from carom.formats.urdf.material import read_visual_material
from carom.formats.xml_element import Element


def read_link(context: UrdfContext, element: Element) -> Link:
    """The link that a `<link>` element describes.

    Raises:
        DescriptionError: The name is missing, or something inside is wrong.
    """
    name = context.required(element, "name")
    return Link(
        name,
        inertial=read_inertial(context, element, name, lambda inertial: _read_mass(context, inertial)),
        collisions=tuple(
            read_collision(context, child, read_urdf_geometry(context, child))
            for child in element.all("collision")
        ),
        visuals=tuple(_read_visual(context, child) for child in element.all("visual")),
        contact=read_contact(element.first("contact"), lambda child: context.value(child, "value")),
        user_data=context.user_data(element),
    )


def _read_mass(context: UrdfContext, inertial: Element) -> float:
    mass = inertial.first("mass")
    if mass is None:
        raise context.error(inertial, "<mass> is missing")
    return context.non_negative(mass, "value")


def _read_visual(context: UrdfContext, element: Element) -> Visual:
    return Visual(
        read_urdf_geometry(context, element),
        frame=context.pose(element),
        name=element.attributes.get("name", ""),
        material=read_visual_material(context, element),
        user_data=context.user_data(element),
    )
