"""`<geometry>`: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from math import hypot
from pathlib import Path

from carom.description import Box, Capsule, Cylinder, Geometry, Mesh, Plane, SignedDistanceField, Sphere
from carom.description.pose import Vector3
from carom.formats.urdf.context import UrdfContext, shown
from carom.formats.xml_tree import Element

MESH_SUFFIXES = (".obj", ".stl", ".dae")
FIELD_SUFFIXES = (".cdf",)


def read_geometry(context: UrdfContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`.

    Raises:
        DescriptionError: No `<geometry>`, an unknown shape, missing or bad sizes, a mesh that does not exist.
    """
    geometry = owner.first("geometry")
    if geometry is None:
        raise context.error(owner, "<geometry> is missing")
    if not geometry.children:
        raise context.error(geometry, "it holds no shape")
    shape = geometry.children[0]
    reader = _READERS.get(shape.tag)
    if reader is None:
        raise context.error(shape, f"unknown shape; known are {', '.join(_READERS)}")
    return reader(context, shape)


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
    x, y, z = context.vector_or_zero(shape, "normal")
    length = hypot(x, y, z)
    if length == 0.0:
        raise context.error(shape, "the normal has no length")
    return Plane((x / length, y / length, z / length))


def _mesh(context: UrdfContext, shape: Element) -> Mesh:
    return Mesh(_shape_file(context, shape, MESH_SUFFIXES), _mesh_scale(context, shape))


def _signed_distance_field(context: UrdfContext, shape: Element) -> SignedDistanceField:
    return SignedDistanceField(_shape_file(context, shape, FIELD_SUFFIXES))


def _shape_file(context: UrdfContext, shape: Element, suffixes: tuple[str, ...]) -> Path:
    name = context.required(shape, "filename")
    if not name.lower().endswith(suffixes):
        raise context.error(shape, f"filename={shown(name)} must end in {' or '.join(suffixes)}")
    path = context.find_file(name)
    if path is None:
        raise context.error(
            shape, f"{shown(name)} was found neither beside the robot file nor in a directory above it"
        )
    return path


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
