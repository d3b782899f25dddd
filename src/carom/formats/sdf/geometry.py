"""`<geometry>` of SDF: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from carom.description import Geometry, Mesh, SignedDistanceField
from carom.description.geometry import BY_TAG, Primitive
from carom.description.shapes.shape import Measure, Parameter
from carom.files.xml_element import Element
from carom.formats.robot.geometry import FIELD_SUFFIXES, MESH_SUFFIXES, direction, shape_element, shape_file
from carom.formats.sdf.context import SdfContext


def read_sdf_geometry(context: SdfContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`; raises `DescriptionError` if it is incomplete."""
    shape = shape_element(context, owner)
    primitive = BY_TAG.get(shape.tag)
    if primitive is not None:
        return primitive(*(_stated(context, shape, primitive, it) for it in primitive.parameters))
    if shape.tag == "mesh":
        x, y, z = context.triple(shape, "scale") or (1.0, 1.0, 1.0)
        scale = context.scale
        return Mesh(_file(context, shape, MESH_SUFFIXES), (x * scale, y * scale, z * scale))
    return SignedDistanceField(_file(context, shape, FIELD_SUFFIXES))


def _stated(context: SdfContext, shape: Element, primitive: type[Primitive], parameter: Parameter) -> Any:
    """A length, three or a direction of a shape; PyBullet does not scale all of them."""
    name = parameter.stated
    factor = (context.scale if primitive.bullet_scales_sdf else 1.0) / parameter.per_field
    if parameter.measure is Measure.LENGTH:
        default = primitive.bullet_sdf_length
        if default is not None and shape.first(name) is None:
            return default
        return factor * context.non_negative(shape, name)
    numbers = context.triple(shape, name)
    if parameter.measure is Measure.DIRECTION:
        if numbers is None or shape.first("size") is None:
            raise context.error(shape, f"it needs both <{name}> and <size>")
        return direction(context, shape, numbers)
    if numbers is None:
        raise context.error(shape, f"<{name}> is missing")
    if min(numbers) < 0.0:
        raise context.error(shape, f"{name}={numbers} must not be negative")
    x, y, z = numbers
    return (x * factor, y * factor, z * factor)


def _file(context: SdfContext, shape: Element, suffixes: tuple[str, ...]) -> Path:
    name = context.text(shape, "uri")
    if not name:
        raise context.error(shape, "<uri> is missing")
    return shape_file(context, shape, "uri", name, suffixes)
