"""`<link>`: inertia, shapes and contact parameters."""

from __future__ import annotations

from dataclasses import replace

from carom.description import Collision, ContactParameters, Inertial, Link, Mesh, Visual
from carom.formats.urdf.context import UrdfContext
from carom.formats.urdf.geometry import read_geometry
from carom.formats.urdf.material import read_visual_material
from carom.formats.xml_tree import Element

DEFAULT_STIFFNESS = 1e4
"""Contact stiffness [N/m] where a link states only a damping."""

DEFAULT_DAMPING = 1.0
"""Contact damping [N s/m] where a link states only a stiffness."""

NO_INERTIAL = Inertial(mass=1.0, tensor=(1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
"""Of a link that states none."""

MASSLESS = Inertial(mass=0.0)
"""Of the link that is the world."""


def read_link(context: UrdfContext, element: Element) -> Link:
    """A `<link>` with everything in it.

    Raises:
        DescriptionError: The name is missing, or something inside is wrong.
    """
    name = context.required(element, "name")
    return Link(
        name,
        inertial=_read_inertial(context, element, name),
        collisions=tuple(_read_collision(context, child) for child in element.all("collision")),
        visuals=tuple(_read_visual(context, child) for child in element.all("visual")),
        contact=_read_contact(context, element.first("contact")),
        user_data=context.user_data(element),
    )


def _read_inertial(context: UrdfContext, link: Element, name: str) -> Inertial:
    element = link.first("inertial")
    if element is None:
        if name == "world":
            return MASSLESS
        context.links_without_inertial.append(name)
        return NO_INERTIAL
    mass = element.first("mass")
    if mass is None:
        raise context.error(element, "<mass> is missing")
    inertia = element.first("inertia")
    if inertia is None:
        raise context.error(element, "<inertia> is missing")
    ixx, iyy, izz = (context.number(inertia, key) for key in ("ixx", "iyy", "izz"))
    products = ("ixy", "ixz", "iyz")
    # Products of inertia count only when all three are given.
    if all(key in inertia.attributes for key in products):
        ixy, ixz, iyz = (context.number(inertia, key) for key in products)
    else:
        ixy = ixz = iyz = 0.0
    return Inertial(
        mass=context.non_negative(mass, "value"),
        frame=context.origin(element),
        tensor=(ixx, ixy, ixz, iyy, iyz, izz),
    )


def _read_collision(context: UrdfContext, element: Element) -> Collision:
    geometry = read_geometry(context, element)
    # The attribute counts by being there, whatever it says.
    if "concave" in element.attributes and isinstance(geometry, Mesh):
        geometry = replace(geometry, concave=True)
    return Collision(
        geometry,
        frame=context.origin(element),
        name=element.attributes.get("name", ""),
        group=context.bit_mask(element, "group"),
        mask=context.bit_mask(element, "mask"),
    )


def _read_visual(context: UrdfContext, element: Element) -> Visual:
    return Visual(
        read_geometry(context, element),
        frame=context.origin(element),
        name=element.attributes.get("name", ""),
        material=read_visual_material(context, element),
        user_data=context.user_data(element),
    )


def _read_contact(context: UrdfContext, element: Element | None) -> ContactParameters:
    if element is None:
        return _DEFAULT_CONTACT

    def value(tag: str) -> float | None:
        child = element.first(tag)
        return None if child is None else context.number(child, "value")

    stiffness, damping = value("stiffness"), value("damping")
    if stiffness is not None or damping is not None:
        stiffness = DEFAULT_STIFFNESS if stiffness is None else stiffness
        damping = DEFAULT_DAMPING if damping is None else damping
    return ContactParameters(
        lateral_friction=value("lateral_friction"),
        rolling_friction=value("rolling_friction"),
        spinning_friction=value("spinning_friction"),
        restitution=value("restitution"),
        stiffness=stiffness,
        damping=damping,
        inertia_scaling=value("inertia_scaling"),
        friction_anchor=element.first("friction_anchor") is not None,
    )


_DEFAULT_CONTACT = ContactParameters()
