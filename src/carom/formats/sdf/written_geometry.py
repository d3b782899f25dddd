"""`<geometry>` as its author means it: also cones, ellipsoids, extruded outlines and terrain."""

from __future__ import annotations

from io import BytesIO
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from carom.description import ConvexHull, Ellipsoid, Geometry, Heightfield, Mesh, TriangleMesh
from carom.description.geometry import BY_TAG
from carom.description.pose import Vector3
from carom.description.shapes.shape import Measure, Parameter
from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.robot.geometry import WRITTEN_MESH_SUFFIXES, direction, shape_element, shape_file
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.network import is_remote, local_name
from carom.formats.sdf.polyline import pieces, prism, read_outline
from carom.native.trigonometry import cos, sin

_SIDES = 32
_ONES: Vector3 = (1.0, 1.0, 1.0)
_KNOWN = (
    *BY_TAG, "mesh", "cone", "ellipsoid", "polyline", "heightmap", "empty", "image",
)  # fmt: skip


def shape_of(context: SdfContext, owner: Element) -> Element:
    """The shape in the `<geometry>` of a visual or collision; `DescriptionError` unless it is known."""
    shape = shape_element(context, owner, _KNOWN)
    shape.note()
    return shape


def read_written_geometry(context: SdfContext, owner: Element) -> list[Geometry]:
    """The shapes that a `<visual>` or `<collision>` consists of; lengths that are not stated are 1 m.

    Raises:
        DescriptionError: It is unknown, or something inside is wrong.
    """
    shape = shape_of(context, owner)
    scale = context.scale
    primitive = BY_TAG.get(shape.tag)
    if primitive is not None:
        return [primitive(*(_stated(context, owner, shape, it) for it in primitive.parameters))]
    match shape.tag:
        case "ellipsoid":
            return [Ellipsoid(lengths(context, shape, "radii"))]
        case "cone":
            return [_cone(length(context, shape, "radius"), length(context, shape, "length"))]
        case "mesh":
            x, y, z = context.triple(shape, "scale") or _ONES
            path = _file(context, shape, WRITTEN_MESH_SUFFIXES)
            factors = (x * scale, y * scale, z * scale)
            if path.suffix.lower() == ".dae" and (shown := _instances(path, factors)) is not None:
                return [shown if owner.tag == "visual" else ConvexHull(shown.vertices, factors, margin=0.0)]
            # What cannot move collides as it is, others by their hulls.
            return [Mesh(path, factors, margin=0.0)]
        case "polyline":
            outline, height = read_outline(context, owner, shape)
            if owner.tag == "visual":
                return [prism(outline, height)]
            return list(pieces(outline, height))
        case "heightmap":
            return [_heightmap(context, shape)]
    if shape.tag == "image":
        context.leave_out(shape, "the shape is missing", "images are not extruded")
    return []


def _instances(path: Path, scale: Vector3) -> TriangleMesh | None:
    """The triangles of a COLLADA file that shows nodes several times; None for another one."""
    from carom.meshes.collada import scene_of_instances

    with reading(path, untyped=True):
        data, _ = read_bounded(path)
        parts = scene_of_instances(data, path)
        if parts is None:
            return None
        if not parts:
            raise DescriptionError("the scene shows no triangles", file=path)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.concatenate([part.vertices for part in parts]) * np.array(scale)
    triangles = np.concatenate(
        [part.triangles + start for part, start in zip(parts, starts, strict=False)]
    ).astype(np.int32)
    return TriangleMesh(vertices, triangles[:, ::-1] if np.prod(scale) < 0.0 else triangles, scale=scale)


def length(context: SdfContext, shape: Element, tag: str) -> float:
    """A length that a shape states [m], 1 where it does not."""
    return context.scale * (1.0 if shape.first(tag) is None else context.non_negative(shape, tag))


def lengths(context: SdfContext, shape: Element, tag: str) -> Vector3:
    """Three lengths that a shape states [m], 1 where it does not."""
    x, y, z = context.triple(shape, tag) or _ONES
    if min(x, y, z) < 0.0:
        raise context.error(shape.first(tag) or shape, f"{x:g} {y:g} {z:g} must not be negative")
    return (x * context.scale, y * context.scale, z * context.scale)


def _stated(context: SdfContext, owner: Element, shape: Element, parameter: Parameter) -> Any:
    """A length, three or a direction of a shape, scaled."""
    name = parameter.stated
    if parameter.measure is Measure.LENGTH:
        return length(context, shape, name)
    if parameter.measure is Measure.LENGTHS:
        x, y, z = lengths(context, shape, name)
        return (x / parameter.per_field, y / parameter.per_field, z / parameter.per_field)
    # What is seen of a plane has a size, but it collides without an end.
    if owner.tag == "visual" and shape.first("size") is not None:
        context.leave_out(
            shape.first("size") or shape, "none: a plane is seen without an end", "as it collides"
        )
    shape.first("size")
    return direction(context, shape, context.triple(shape, name) or (0.0, 0.0, 1.0))


def _cone(radius: float, height: float) -> ConvexHull:
    """A cone along z, its middle at half its height."""
    turns = [2.0 * pi * side / _SIDES for side in range(_SIDES)]
    rim = [(radius * cos(turn), radius * sin(turn), -0.5 * height) for turn in turns]
    return ConvexHull(np.array([*rim, (0.0, 0.0, 0.5 * height)]), margin=0.0)


def _heightmap(context: SdfContext, shape: Element) -> Heightfield:
    """Terrain from an image: white is as high as its size says, black is 0."""
    from PIL import Image

    path = _file(context, shape, (".png", ".jpg", ".jpeg", ".pgm"))
    x, y, z = lengths(context, shape, "size")
    with reading(path):
        data, _ = read_bounded(path)
        with Image.open(BytesIO(data)) as image:
            charge("pixels", image.width * image.height)
            charge(
                "vertices",
                3 * image.width * image.height,
                file=context.file_of(shape),
                line=shape.line,
                element=f"<{shape.tag}>",
            )
            deep = image.mode.startswith("I")
            grey = np.asarray(image if deep else image.convert("L"), dtype=np.float64)
    # The first row of an image is that with the greatest y.
    heights = grey[::-1] / (65535.0 if deep else 255.0)
    rows, columns = heights.shape
    if min(rows, columns) < 2:
        raise context.error(shape, f"a height field needs 2 x 2 heights or more, not {rows} x {columns}")
    if any(context.triple(shape, "pos") or ()):
        context.leave_out(shape.first("pos") or shape, "it is not moved", "say it in the <pose> around it")
    return Heightfield(np.ascontiguousarray(heights), (x / (columns - 1), y / (rows - 1), z), 0.0)


def _file(context: SdfContext, shape: Element, suffixes: tuple[str, ...]) -> Path:
    name = context.text(shape, "uri")
    if not name:
        raise context.error(shape, "<uri> is missing")
    if is_remote(name):
        local = local_name(name)
        if context.find_file(local) is None:
            problem = context.not_found(shape, name)
            reason = f"{shown(name)} is on the network; it is looked for as {local} in package_paths"
            raise type(problem)(reason, file=problem.file, line=problem.line, element=problem.element)
        name = local
    return shape_file(context, shape, "uri", name, suffixes)
