"""`<geometry>`: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from carom.description import Box, Capsule, Cylinder, Geometry, Mesh, SignedDistanceField, Sphere
from carom.description.geometry import MARGIN
from carom.description.pose import Vector3
from carom.formats.robot.context import FileContext, shown
from carom.formats.robot.geometry import FIELD_SUFFIXES, mesh_suffixes, plane, shape_element, shape_file
from carom.formats.xml_element import Element


def read_urdf_geometry(context: FileContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`; raises `DescriptionError` if it is incomplete."""
    shape = shape_element(context, owner)
    match shape.tag:
        case "box":
            return Box(_half_extents(context, shape))
        case "sphere":
            return Sphere(context.scale * context.non_negative(shape, "radius"))
        case "cylinder":
            return Cylinder(*_radius_and_length(context, shape))
        case "capsule" | "drake:capsule":
            return Capsule(*_radius_and_length(context, shape))
        case "plane":
            context.required(shape, "normal")
            return plane(context, shape, context.vector_or_zero(shape, "normal"))
    name = context.required(shape, "filename")
    if shape.tag == "cdf":
        return SignedDistanceField(shape_file(context, shape, "filename", name, FIELD_SUFFIXES))
    path = shape_file(context, shape, "filename", name, mesh_suffixes(context))
    # PyBullet's margin is of no file: who reads it as written finds the hull itself.
    return Mesh(path, _mesh_scale(context, shape), margin=MARGIN if context.written is None else 0.0)


def _half_extents(context: FileContext, shape: Element) -> Vector3:
    context.required(shape, "size")
    x, y, z = context.vector_or_zero(shape, "size")
    if x < 0.0 or y < 0.0 or z < 0.0:
        raise context.error(shape, f"size={shown(shape.attributes['size'])} must not be negative")
    half = 0.5 * context.scale
    return (x * half, y * half, z * half)


def _radius_and_length(context: FileContext, shape: Element) -> tuple[float, float]:
    scale = context.scale
    return scale * context.non_negative(shape, "radius"), scale * context.non_negative(shape, "length")


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
