"""`<geometry>` of SDF: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from pathlib import Path

from carom.description import Box, Capsule, Cylinder, Geometry, Mesh, Plane, SignedDistanceField, Sphere
from carom.formats.robot.geometry import FIELD_SUFFIXES, MESH_SUFFIXES, plane, read_geometry, shape_file
from carom.formats.sdf.context import SdfContext
from carom.formats.xml_element import Element

_CYLINDER_SIZE, _CAPSULE_SIZE = 0.1, 1.0
"""Default radius and length [m]; not scaled, as in PyBullet."""


def read_sdf_geometry(context: SdfContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`.

    Raises:
        DescriptionError: No `<geometry>`, an unknown shape, missing or bad sizes, a mesh that does not exist.
    """
    return read_geometry(context, owner, _READERS)


def _sphere(context: SdfContext, shape: Element) -> Sphere:
    # Not scaled, as in PyBullet.
    return Sphere(context.non_negative(shape, "radius"))


def _box(context: SdfContext, shape: Element) -> Box:
    size = context.triple(shape, "size")
    if size is None:
        raise context.error(shape, "<size> is missing")
    if min(size) < 0.0:
        raise context.error(shape, f"size={size} must not be negative")
    half = 0.5 * context.scale
    return Box((size[0] * half, size[1] * half, size[2] * half))


def _length(context: SdfContext, shape: Element, tag: str, default: float) -> float:
    if shape.first(tag) is None:
        return default
    return context.scale * context.non_negative(shape, tag)


def _cylinder(context: SdfContext, shape: Element) -> Cylinder:
    return Cylinder(*(_length(context, shape, tag, _CYLINDER_SIZE) for tag in ("radius", "length")))


def _capsule(context: SdfContext, shape: Element) -> Capsule:
    return Capsule(*(_length(context, shape, tag, _CAPSULE_SIZE) for tag in ("radius", "length")))


def _plane(context: SdfContext, shape: Element) -> Plane:
    normal = context.triple(shape, "normal")
    if normal is None or shape.first("size") is None:
        raise context.error(shape, "it needs both <normal> and <size>")
    return plane(context, shape, normal)


def _mesh(context: SdfContext, shape: Element) -> Mesh:
    x, y, z = context.triple(shape, "scale") or (1.0, 1.0, 1.0)
    scale = context.scale
    return Mesh(_file(context, shape, MESH_SUFFIXES), (x * scale, y * scale, z * scale))


def _signed_distance_field(context: SdfContext, shape: Element) -> SignedDistanceField:
    return SignedDistanceField(_file(context, shape, FIELD_SUFFIXES))


def _file(context: SdfContext, shape: Element, suffixes: tuple[str, ...]) -> Path:
    name = context.text(shape, "uri")
    if not name:
        raise context.error(shape, "<uri> is missing")
    return shape_file(context, shape, "uri", name, suffixes)


_READERS = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "plane": _plane,
    "mesh": _mesh,
    "cdf": _signed_distance_field,
}
