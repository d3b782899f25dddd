"""`<geometry>`: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from typing import Any

from carom.description import Geometry, Mesh, SignedDistanceField
from carom.description.geometry import BY_TAG
from carom.description.pose import Vector3
from carom.description.shapes.shape import Measure, Parameter
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown
from carom.formats.robot.geometry import (
    FIELD_SUFFIXES,
    OF_DRAKE,
    direction,
    mesh_suffixes,
    shape_element,
    shape_file,
)
from carom.layouts.contacts import MARGIN


def read_urdf_geometry(context: FileContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`; raises `DescriptionError` if it is incomplete."""
    shape = shape_element(context, owner)
    primitive = BY_TAG.get(shape.tag.removeprefix(OF_DRAKE))
    if primitive is not None:
        return primitive(*(_stated(context, shape, it) for it in primitive.parameters))
    name = context.required(shape, "filename")
    if shape.tag == "cdf":
        return SignedDistanceField(shape_file(context, shape, "filename", name, FIELD_SUFFIXES))
    path = shape_file(context, shape, "filename", name, mesh_suffixes(context))
    # PyBullet's margin is of no file: who reads it as written finds the hull itself.
    return Mesh(path, _mesh_scale(context, shape), margin=MARGIN if context.written is None else 0.0)


def _stated(context: FileContext, shape: Element, parameter: Parameter) -> Any:
    """A length, three or a direction of a shape, scaled."""
    name, factor = parameter.stated, context.scale / parameter.per_field
    if parameter.measure is Measure.LENGTH:
        return factor * context.non_negative(shape, name)
    context.required(shape, name)
    x, y, z = context.vector_or_zero(shape, name)
    if parameter.measure is Measure.DIRECTION:
        return direction(context, shape, (x, y, z))
    if x < 0.0 or y < 0.0 or z < 0.0:
        raise context.error(shape, f"{name}={shown(shape.attributes[name])} must not be negative")
    return (x * factor, y * factor, z * factor)


def _mesh_scale(context: FileContext, shape: Element) -> Vector3:
    if "scale" not in shape.attributes:
        return (context.scale, context.scale, context.scale)
    vector = context.vector(shape, "scale")
    if vector is None:
        text = shape.attributes["scale"]
        uniform = context.parse_number(shape, "scale", text)
        context.warn(shape, f"scale={shown(text)} needs three numbers; {uniform:g} is used for all of them")
        vector = (uniform, uniform, uniform)
    return (vector[0] * context.scale, vector[1] * context.scale, vector[2] * context.scale)
