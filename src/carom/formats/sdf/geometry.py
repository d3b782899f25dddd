"""`<geometry>` of SDF: the shape inside `<visual>` and `<collision>`."""

from __future__ import annotations

from pathlib import Path

from carom.description import Box, Capsule, Cylinder, Geometry, Mesh, SignedDistanceField, Sphere
from carom.description.pose import Vector3
from carom.formats.robot.geometry import FIELD_SUFFIXES, MESH_SUFFIXES, plane, shape_element, shape_file
from carom.formats.sdf.context import SdfContext
from carom.formats.xml_element import Element

_CYLINDER_SIZE, _CAPSULE_SIZE = 0.1, 1.0
"""Default radius and length [m]; not scaled, as in PyBullet."""


def read_sdf_geometry(context: SdfContext, owner: Element) -> Geometry:
    """The shape of a `<visual>` or `<collision>`; raises `DescriptionError` if it is incomplete."""
    shape = shape_element(context, owner)
    match shape.tag:
        case "box":
            return Box(_half_extents(context, shape))
        case "sphere":
            # Not scaled, as in PyBullet.
            return Sphere(context.non_negative(shape, "radius"))
        case "cylinder":
            return Cylinder(*(_length(context, shape, tag, _CYLINDER_SIZE) for tag in ("radius", "length")))
        case "capsule":
            return Capsule(*(_length(context, shape, tag, _CAPSULE_SIZE) for tag in ("radius", "length")))
        case "plane":
            normal = context.triple(shape, "normal")
            if normal is None or shape.first("size") is None:
                raise context.error(shape, "it needs both <normal> and <size>")
            return plane(context, shape, normal)
        case "mesh":
            x, y, z = context.triple(shape, "scale") or (1.0, 1.0, 1.0)
            scale = context.scale
            return Mesh(_file(context, shape, MESH_SUFFIXES), (x * scale, y * scale, z * scale))
    return SignedDistanceField(_file(context, shape, FIELD_SUFFIXES))


def _half_extents(context: SdfContext, shape: Element) -> Vector3:
    size = context.triple(shape, "size")
    if size is None:
        raise context.error(shape, "<size> is missing")
    if min(size) < 0.0:
        raise context.error(shape, f"size={size} must not be negative")
    half = 0.5 * context.scale
    return (size[0] * half, size[1] * half, size[2] * half)


def _file(context: SdfContext, shape: Element, suffixes: tuple[str, ...]) -> Path:
    name = context.text(shape, "uri")
    if not name:
        raise context.error(shape, "<uri> is missing")
    return shape_file(context, shape, "uri", name, suffixes)


def _length(context: SdfContext, shape: Element, tag: str, default: float) -> float:
    if shape.first(tag) is None:
        return default
    return context.scale * context.non_negative(shape, tag)
