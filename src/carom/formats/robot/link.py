"""`<link>`: inertia, shapes and contact parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TypeVar

from carom.description import Collision, ContactParameters, Geometry, Inertial, Link, Material, Mesh, Visual
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, MissingFile

Context = TypeVar("Context", bound=FileContext)

MASSLESS = Inertial(mass=0.0)
"""Inertial of a link that stands for the world."""

_NO_INERTIAL = Inertial(mass=1.0, tensor=(1.0, 0.0, 0.0, 1.0, 0.0, 1.0))
"""Inertial of a link that states none."""

_DEFAULT_STIFFNESS = 1e4
"""Contact stiffness [N/m] where a link states only a damping."""

_DEFAULT_DAMPING = 1.0
"""Contact damping [N s/m] where a link states only a stiffness."""

_DEFAULT_CONTACT = ContactParameters()


def read_link(
    context: Context,
    element: Element,
    read_geometry: Callable[[Context, Element], Geometry],
    read_material: Callable[[Context, Element], Material | None],
) -> Link:
    """The link that a `<link>` element describes, without its pose.

    Raises:
        DescriptionError: The name is missing, or something inside is wrong.
    """
    name = context.required(element, "name")
    return Link(
        name,
        inertial=_read_inertial(context, element, name),
        collisions=tuple(
            _read_collision(context, child, geometry)
            for child, geometry in _shapes(context, element, "collision", read_geometry)
        ),
        visuals=tuple(
            Visual(
                geometry,
                frame=context.pose(child),
                name=child.attributes.get("name", ""),
                material=read_material(context, child),
                user_data=context.user_data(child),
            )
            for child, geometry in _shapes(context, element, "visual", read_geometry)
        ),
        contact=_read_contact(context, element.first("contact")),
        user_data=context.user_data(element),
    )


def _shapes(
    context: Context, link: Element, tag: str, read_geometry: Callable[[Context, Element], Geometry]
) -> Iterator[tuple[Element, Geometry]]:
    """The shapes of a link and their elements, without those whose files may be missing."""
    for child in link.all(tag):
        try:
            yield child, read_geometry(context, child)
        except MissingFile as problem:
            if context.written is None or not context.written.missing_meshes:
                raise
            context.leave_out(child, "the link is without this shape", problem.reason)


def _read_inertial(context: FileContext, link: Element, name: str) -> Inertial:
    """The `<inertial>` of a link; without one, a link called `world` has no mass."""
    element = link.first("inertial")
    if element is None:
        if name == "world":
            return MASSLESS
        if context.written is not None:
            return context.written.without_inertial()
        context.links_without_inertial.append(name)
        return _NO_INERTIAL
    if context.written is not None and element.first("mass") is None:
        mass = context.written.without_inertial().mass
    else:
        mass = context.non_negative(*context.place(element, "mass"))
    inertia = element.first("inertia")
    if inertia is None:
        raise context.error(element, "<inertia> is missing")
    ixx, iyy, izz = (context.value(inertia, key) for key in ("ixx", "iyy", "izz"))
    products = ("ixy", "ixz", "iyz")
    # In PyBullet, products of inertia count only when all three are given; it has no cursor.
    if context.cursor is not None:
        ixy, ixz, iyz = (context.value(inertia, key, 0.0) for key in products)
    elif all(context.states(inertia, key) for key in products):
        ixy, ixz, iyz = (context.value(inertia, key) for key in products)
    else:
        ixy = ixz = iyz = 0.0
    return Inertial(mass=mass, frame=context.pose(element), tensor=(ixx, ixy, ixz, iyy, iyz, izz))


def _read_collision(context: FileContext, element: Element, geometry: Geometry) -> Collision:
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


def _read_contact(context: FileContext, element: Element | None) -> ContactParameters:
    if element is None:
        return _DEFAULT_CONTACT
    stiffness, damping = (context.child_value(element, tag, None) for tag in ("stiffness", "damping"))
    if stiffness is not None or damping is not None:
        stiffness = _DEFAULT_STIFFNESS if stiffness is None else stiffness
        damping = _DEFAULT_DAMPING if damping is None else damping
    return ContactParameters(
        lateral_friction=context.child_value(element, "lateral_friction", None),
        rolling_friction=context.child_value(element, "rolling_friction", None),
        spinning_friction=context.child_value(element, "spinning_friction", None),
        restitution=context.child_value(element, "restitution", None),
        stiffness=stiffness,
        damping=damping,
        inertia_scaling=context.child_value(element, "inertia_scaling", None),
        friction_anchor=element.first("friction_anchor") is not None,
    )
