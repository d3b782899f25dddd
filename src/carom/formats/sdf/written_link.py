"""`<link>` as its author means it: mass, shapes and surfaces."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from carom.description import Collision, ContactParameters, Geometry, Inertial, Link, Pose, Visual
from carom.files.xml_element import Element
from carom.formats.robot.context import MissingFile
from carom.formats.sdf.automatic_inertia import automatic_inertia
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.looks import read_material
from carom.formats.sdf.surface import read_surface
from carom.formats.sdf.written_geometry import read_written_geometry

Place = Callable[[Element], Pose]
_TENSOR = (("ixx", 1.0), ("ixy", 0.0), ("ixz", 0.0), ("iyy", 1.0), ("iyz", 0.0), ("izz", 1.0))
_UNIT = Inertial(1.0, tensor=(1.0, 0.0, 0.0, 1.0, 0.0, 1.0))


def read_written_link(context: SdfContext, element: Element, place: Place) -> Link:
    """The link that a `<link>` element describes.

    Args:
        context: The reading of its file.
        element: The element.
        place: The pose of something in it, in the frame of the link.

    Raises:
        DescriptionError: The name is missing, or something inside is wrong.
    """
    name = context.required(element, "name")
    collisions: list[Collision] = []
    solids: list[tuple[Element, list[Geometry], Pose]] = []
    common: ContactParameters | None = None
    for child, geometries in _shapes(context, element, "collision"):
        pose = place(child)
        label = child.attributes.get("name", "")
        contact = read_surface(context, child)
        common = contact if common is None else common
        own = None if contact == common else contact
        collisions += [Collision(it, frame=pose, name=label, contact=own) for it in geometries]
        solids.append((child, geometries, pose))
    visuals = [
        Visual(
            geometry,
            frame=place(child),
            name=child.attributes.get("name", ""),
            material=read_material(context, child),
        )
        for child, geometries in _shapes(context, element, "visual")
        for geometry in geometries
    ]
    inertial = _inertial(context, element, name, place, solids)
    gravity = context.says(element, "gravity", default=True)
    return Link(
        name,
        inertial=inertial,
        collisions=tuple(collisions),
        visuals=tuple(visuals),
        contact=common or ContactParameters(),
        gravity_compensation=0.0 if gravity else 1.0,
    )


def _shapes(context: SdfContext, link: Element, tag: str) -> Iterator[tuple[Element, list[Geometry]]]:
    """The shapes of a link and their elements, without those whose files may be missing."""
    for child in link.all(tag):
        child.attributes.get("name")
        try:
            yield child, read_written_geometry(context, child)
        except MissingFile as problem:
            if not context.missing_meshes:
                raise
            context.leave_out_all(child, "the link is without this shape", problem.reason)


def _inertial(
    context: SdfContext,
    link: Element,
    name: str,
    place: Place,
    solids: list[tuple[Element, list[Geometry], Pose]],
) -> Inertial:
    """The `<inertial>` of a link, with the format's defaults: 1 kg, and 1 kg m² about each axis."""
    element = link.first("inertial")
    if element is None:
        if name == "world":
            return Inertial(mass=0.0)
        context.links_without_inertial.append(name)
        return _UNIT
    if element.attributes.get("auto") in ("1", "true"):
        computed = automatic_inertia(context, element, solids)
        if computed is not None:
            return computed
        # Without shapes that have a volume, the format falls back on what is stated.
    mass = 1.0 if element.first("mass") is None else context.non_negative(element, "mass")
    inertia = element.first("inertia")
    ixx, ixy, ixz, iyy, iyz, izz = (
        default if inertia is None else context.value(inertia, key, default) for key, default in _TENSOR
    )
    return replace(_UNIT, mass=mass, frame=place(element), tensor=(ixx, ixy, ixz, iyy, iyz, izz))
