"""`<site>`: named frames."""

from __future__ import annotations

from carom.description import Pose
from carom.description.pose import Vector3
from carom.description.transform import compose
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.looks.material import read_material
from carom.formats.mjcf.compiled.model import Site
from carom.formats.mjcf.compiled.shapes.geom import frame_between

_SMALL = 0.005


def read_site(scope: Scope, element: Element, body: str) -> Site:
    """The site that a `<site>` of a body describes; raises `DescriptionError`."""
    element.note()
    context, attributes = scope.context, scope.attributes(element)
    sizes = context.singles(element, "size", attributes.get("size", ""))
    if "fromto" in attributes:
        own, half = frame_between(context, element, attributes["fromto"])
        frame: Pose = compose(scope.into, own)
        sizes = [sizes[0] if sizes else _SMALL, half]
    else:
        frame = scope.pose(element, attributes)
    x, y, z = (*sizes, *(_SMALL,) * 3)[:3]
    size: Vector3 = (x, y, z)
    return Site(
        scope.name(element),
        body,
        frame,
        attributes.get("type", "sphere"),
        size,
        read_material(context, element, attributes).rgba,
        int(context.number(element, attributes, "group", 0.0)),
    )
