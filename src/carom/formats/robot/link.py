"""`<link>`: inertia, collision shapes and contact parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from carom.description import Collision, ContactParameters, Geometry, Inertial, Mesh
from carom.formats.robot.context import FileContext
from carom.formats.xml_element import Element

MASSLESS = Inertial(mass=0.0)
"""Inertial of a link that stands for the world."""

_NO_INERTIAL = Inertial(mass=1.0, tensor=(1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
"""Inertial of a link that states none."""

_DEFAULT_STIFFNESS = 1e4
"""Contact stiffness [N/m] where a link states only a damping."""

_DEFAULT_DAMPING = 1.0
"""Contact damping [N s/m] where a link states only a stiffness."""

_DEFAULT_CONTACT = ContactParameters()


def read_inertial(
    context: FileContext, link: Element, name: str, read_mass: Callable[[Element], float]
) -> Inertial:
    """The `<inertial>` of a link.

    Args:
        context: The reading it belongs to.
        link: The `<link>` element.
        name: Name of the link; a link called `world` without `<inertial>` has no mass.
        read_mass: Reads the mass from the `<inertial>` element.

    Raises:
        DescriptionError: Mass or moments are missing or are not numbers.
    """
    element = link.first("inertial")
    if element is None:
        if name == "world":
            return MASSLESS
        context.links_without_inertial.append(name)
        return _NO_INERTIAL
    mass = read_mass(element)
    inertia = element.first("inertia")
    if inertia is None:
        raise context.error(element, "<inertia> is missing")
    ixx, iyy, izz = (context.value(inertia, key) for key in ("ixx", "iyy", "izz"))
    products = ("ixy", "ixz", "iyz")
    # Products of inertia count only when all three are given.
    if all(context.states(inertia, key) for key in products):
        ixy, ixz, iyz = (context.value(inertia, key) for key in products)
    else:
        ixy = ixz = iyz = 0.0
    return Inertial(mass=mass, frame=context.pose(element), tensor=(ixx, ixy, ixz, iyy, iyz, izz))


def read_collision(context: FileContext, element: Element, geometry: Geometry) -> Collision:
    """The collision shape that a `<collision>` with this geometry describes."""
    # Only the presence of the attribute matters, not its value.
    if "concave" in element.attributes and isinstance(geometry, Mesh):
        geometry = replace(geometry, concave=True)
    return Collision(
        geometry,
        frame=context.pose(element),
        name=element.attributes.get("name", ""),
        group=context.bit_mask(element, "group"),
        mask=context.bit_mask(element, "mask"),
    )


def read_contact(element: Element | None, value: Callable[[Element], float]) -> ContactParameters:
    """The contact parameters of a link.

    Args:
        element: Its `<contact>` element; None if it has none.
        value: Reads the number from a child of that element.
    """
    if element is None:
        return _DEFAULT_CONTACT

    def optional(tag: str) -> float | None:
        child = element.first(tag)
        return None if child is None else value(child)

    stiffness, damping = optional("stiffness"), optional("damping")
    if stiffness is not None or damping is not None:
        stiffness = _DEFAULT_STIFFNESS if stiffness is None else stiffness
        damping = _DEFAULT_DAMPING if damping is None else damping
    return ContactParameters(
        lateral_friction=optional("lateral_friction"),
        rolling_friction=optional("rolling_friction"),
        spinning_friction=optional("spinning_friction"),
        restitution=optional("restitution"),
        stiffness=stiffness,
        damping=damping,
        inertia_scaling=optional("inertia_scaling"),
        friction_anchor=element.first("friction_anchor") is not None,
    )
