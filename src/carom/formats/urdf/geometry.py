"""`<geometry>`: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from carom.description import Box, Capsule, Cylinder, Geometry, Mesh, Plane, SignedDistanceField, Sphere
from carom.description.pose import Vector3
from carom.formats.robot.context import shown
from carom.formats.robot.geometry import FIELD_SUFFIXES, MESH_SUFFIXES, plane, read_geometry, shape_file
from carom.formats.urdf.context import UrdfContext
from carom.formats.xml_element import Element


def read_urdf_geometry(context: UrdfContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`.

    Raises:
        DescriptionError: No `<geometry>`, an unknown shape, missing or bad sizes, a mesh that does not exist.
    """
    return read_geometry(context, owner, _READERS)


def _sphere(context: UrdfContext, shape: Element) -> Sphere:
    return Sphere(context.scale * context.non_negative(shape, "radius"))


def _box(context: UrdfContext, shape: Element) -> Box:
    context.required(shape, "size")
    x, y, z = context.vector_or_zero(shape, "size")
    if x < 0.0 or y < 0.0 or z < 0.0:
        raise context.error(shape, f"size={shown(shape.attributes['size'])} must not be negative")
    half = 0.5 * context.scale
    return Box((x * half, y * half, z * half))


def _cylinder(context: UrdfContext, shape: Element) -> Cylinder:
    radius, length = _radius_and_length(context, shape)
    return Cylinder(radius, length)


def _capsule(context: UrdfContext, shape: Element) -> Capsule:
    radius, length = _radius_and_length(context, shape)
    return Capsule(radius, length)


def _radius_and_length(context: UrdfContext, shape: Element) -> tuple[float, float]:
    scale = context.scale
    return scale * context.non_negative(shape, "radius"), scale * context.non_negative(shape, "length")


def _plane(context: UrdfContext, shape: Element) -> Plane:
    context.required(shape, "normal")
    return plane(context, shape, context.vector_or_zero(shape, "normal"))


def _mesh(context: UrdfContext, shape: Element) -> Mesh:
    path = shape_file(context, shape, "filename", context.required(shape, "filename"), MESH_SUFFIXES)
    return Mesh(path, _mesh_scale(context, shape))


def _signed_distance_field(context: UrdfContext, shape: Element) -> SignedDistanceField:
    name = context.required(shape, "filename")
    return SignedDistanceField(shape_file(context, shape, "filename", name, FIELD_SUFFIXES))


def _mesh_scale(context: UrdfContext, shape: Element) -> Vector3:
    if "scale" not in shape.attributes:
        return (context.scale, context.scale, context.scale)
    vector = context.vector(shape, "scale")
    if vector is None:
        text = shape.attributes["scale"]
        uniform = context.parse_number(shape, "scale", text)
        context.warn(shape, f"scale={shown(text)} needs three numbers; {uniform:g} is used for all of them")
        vector = (uniform, uniform, uniform)
    return (vector[0] * context.scale, vector[1] * context.scale, vector[2] * context.scale)


_READERS = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "plane": _plane,
    "mesh": _mesh,
    "cdf": _signed_distance_field,
}
