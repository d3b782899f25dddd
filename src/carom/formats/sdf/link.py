"""`<link>` of SDF: pose, inertia, shapes and contact parameters."""

from __future__ import annotations

from dataclasses import replace

from carom.description import (
    Collision,
    ContactParameters,
    Inertial,
    Link,
    Material,
    Mesh,
    Visual,
)
from carom.errors import DescriptionError
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.geometry import read_sdf_geometry
from carom.formats.urdf.link import DEFAULT_DAMPING, DEFAULT_STIFFNESS, MASSLESS, NO_INERTIAL
from carom.formats.xml_tree import Element


def read_sdf_link(context: SdfContext, element: Element) -> Link:
    """A `<link>` with everything in it but its pose.

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


def _read_inertial(context: SdfContext, link: Element, name: str) -> Inertial:
    element = link.first("inertial")
    if element is None:
        if name == "world":
            return MASSLESS
        context.links_without_inertial.append(name)
        return NO_INERTIAL
    inertia = element.first("inertia")
    mass = context.non_negative_value(element, "mass")
    if inertia is None:
        raise context.error(element, "<inertia> is missing")
    ixx, iyy, izz = (context.value(inertia, key) for key in ("ixx", "iyy", "izz"))
    products = ("ixy", "ixz", "iyz")
    # Products of inertia count only when all three are given.
    if all(inertia.first(key) is not None for key in products):
        ixy, ixz, iyz = (context.value(inertia, key) for key in products)
    else:
        ixy = ixz = iyz = 0.0
    return Inertial(mass=mass, frame=context.pose(element), tensor=(ixx, ixy, ixz, iyy, iyz, izz))


def _read_collision(context: SdfContext, element: Element) -> Collision:
    geometry = read_sdf_geometry(context, element)
    # The attribute counts by being there, whatever it says.
    if "concave" in element.attributes and isinstance(geometry, Mesh):
        geometry = replace(geometry, concave=True)
    return Collision(
        geometry,
        frame=context.pose(element),
        name=element.attributes.get("name", ""),
        group=context.bit_mask(element, "group"),
        mask=context.bit_mask(element, "mask"),
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
    """The components of a colour; None, with a warning, where they cannot be read: looks stop no robot."""
    if element is None:
        return None
    try:
        components = context.values(element)
    except DescriptionError as error:
        context.warn(element, f"ignored: {error.reason}")
        return None
    if len(components) not in counts:
        context.warn(element, f"it has {len(components)} numbers instead of {counts[0]}; ignored")
        return None
    return components


def _read_contact(context: SdfContext, element: Element | None) -> ContactParameters:
    if element is None:
        return ContactParameters()

    def value(tag: str) -> float | None:
        return None if element.first(tag) is None else context.value(element, tag)

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
