"""Python code of the calls that create bodies from shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description import (
    Box,
    Capsule,
    Collision,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    JointType,
    Mesh,
    Plane,
    Sphere,
    TriangleMesh,
)
from carom.description.joint import JOINT_CODE
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import LinkSpec
from pybullet._calls.errors import logger
from pybullet._loading.multi_body import JOINT_TYPES

if TYPE_CHECKING:
    from carom.scene.body import Body


class Raw(str):
    """An argument that is already Python code."""

    __slots__ = ()


def call(function: str, *arguments: Any, **keywords: Any) -> str:
    """A call of a function of PyBullet as Python code; keyword arguments of None are left out."""
    parts = [written(argument) for argument in arguments]
    parts += [f"{name}={written(value)}" for name, value in keywords.items() if value is not None]
    return f"p.{function}({', '.join(parts)})"


def written(value: Any) -> str:
    """A value as Python code, with all digits of numbers."""
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, np.ndarray):
        return repr(value.tolist())
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(written(item) for item in value)}]"
    return repr(float(value)) if isinstance(value, np.floating) else repr(value)


def _joint_type(kind: JointType) -> Raw:
    code = JOINT_CODE[kind]
    return Raw(f"p.JOINT_{code.name}" if code in JOINT_TYPES else "p.JOINT_FIXED")


def multi_body(body: Body, position: Sequence[float], orientation: Sequence[float]) -> str:
    """The call of `createMultiBody` that copies a body to a world pose of its base's link frame."""
    spec = body.spec
    kept = spec.flags & ~LoadFlags.USE_IMPLICIT_CYLINDER | LoadFlags.MAINTAIN_LINK_ORDER
    lists: dict[str, list[Any]] = {}
    if spec.links:
        lists = {
            "linkMasses": [body.dynamics(link).mass for link in range(body.joint_count)],
            "linkCollisionShapeIndices": [_collision(link.collisions) for link in spec.links],
            "linkVisualShapeIndices": [_visual(link) for link in spec.links],
            "linkPositions": [link.joint_frame.position for link in spec.links],
            "linkOrientations": [link.joint_frame.orientation for link in spec.links],
            "linkInertialFramePositions": [link.inertial_frame.position for link in spec.links],
            "linkInertialFrameOrientations": [link.inertial_frame.orientation for link in spec.links],
            "linkParentIndices": [link.parent + 1 for link in spec.links],
            "linkJointTypes": [_joint_type(link.joint_type) for link in spec.links],
            "linkJointAxis": [
                [component * link.joint_axis_length for component in link.joint_axis] for link in spec.links
            ],
        }
    return call(
        "createMultiBody",
        body.dynamics(-1).mass,
        _collision(spec.base.collisions),
        _visual(spec.base),
        position,
        orientation,
        spec.base.inertial_frame.position,
        spec.base.inertial_frame.orientation,
        **lists,
        flags=int(kept) if spec.links else int(kept & ~LoadFlags.MAINTAIN_LINK_ORDER),
    )


def _collision(shapes: tuple[Collision, ...]) -> Raw:
    return _shape(
        "Collision", [(shape.geometry, shape.frame.position, shape.frame.orientation) for shape in shapes]
    )


def _visual(link: LinkSpec) -> Raw:
    """The call that creates a link's visual shape; -1 if its collision shape is drawn or no call can."""
    shapes = link.visuals
    touching = [(shape.geometry, shape.frame) for shape in link.collisions]
    plain = all(shape.material is None for shape in shapes)
    if plain and [(shape.geometry, shape.frame) for shape in shapes] == touching:
        return Raw("-1")
    if any(isinstance(shape.geometry, (Heightfield, ConvexHull)) for shape in shapes):
        return Raw("-1")
    colours = [None if shape.material is None else shape.material.rgba for shape in shapes]
    parts = [(shape.geometry, shape.frame.position, shape.frame.orientation) for shape in shapes]
    return _shape("Visual", parts, colours)


def _shape(kind: str, parts: list[Any], colours: Sequence[Any] = ()) -> Raw:
    """The call that creates a shape from its parts; -1 if there are no parts or no call can create it."""
    if not parts or any(not _arguments(geometry) for geometry, *_ in parts):
        return Raw("-1")
    frames = {"collision": "collisionFrame", "visual": "visualFrame"}[kind.lower()]
    height = "height" if kind == "Collision" else "length"
    if len(parts) == 1:
        geometry, position, orientation = parts[0]
        arguments = _arguments(geometry)
        if "height" in arguments:
            arguments[height] = arguments.pop("height")
        framed = position != (0.0, 0.0, 0.0) or orientation != (0.0, 0.0, 0.0, 1.0)
        if framed:
            arguments |= {f"{frames}Position": position, f"{frames}Orientation": orientation}
        if colours:
            arguments["rgbaColor"] = colours[0]
        return Raw(call(f"create{kind}Shape", **arguments))
    columns = [_arguments(geometry) for geometry, *_ in parts]
    arguments = {
        "shapeTypes": [column["shapeType"] for column in columns],
        "radii": [column.get("radius", 0.5) for column in columns],
        "halfExtents": [column.get("halfExtents", (1.0, 1.0, 1.0)) for column in columns],
        "lengths": [column.get("height", 1.0) for column in columns],
        "fileNames": [column.get("fileName", "") for column in columns],
        "meshScales": [column.get("meshScale", (1.0, 1.0, 1.0)) for column in columns],
        "planeNormals": [column.get("planeNormal", (0.0, 0.0, 1.0)) for column in columns],
        f"{frames}Positions": [position for _, position, _ in parts],
        f"{frames}Orientations": [orientation for *_, orientation in parts],
    }
    if colours:
        arguments["rgbaColors"] = [colour or (1.0, 1.0, 1.0, 1.0) for colour in colours]
    if any("vertices" in column or "heightfieldData" in column for column in columns):
        logger.warning(
            "saveWorld: no call can create a %s shape of several parts, one of them made of vertices or "
            "heights; it is left out. saveBullet keeps it.",
            kind.lower(),
        )
        return Raw("-1")
    return Raw(call(f"create{kind}ShapeArray", **arguments))


def _arguments(geometry: Geometry) -> dict[str, Any]:
    """The arguments of `createCollisionShape` for a shape; empty if it cannot create the shape."""
    match geometry:
        case Sphere(radius):
            return {"shapeType": Raw("p.GEOM_SPHERE"), "radius": radius}
        case Box(half_extents):
            return {"shapeType": Raw("p.GEOM_BOX"), "halfExtents": half_extents}
        case Cylinder(radius, length):
            return {"shapeType": Raw("p.GEOM_CYLINDER"), "radius": radius, "height": length}
        case Capsule(radius, length):
            return {"shapeType": Raw("p.GEOM_CAPSULE"), "radius": radius, "height": length}
        case Plane(normal):
            return {"shapeType": Raw("p.GEOM_PLANE"), "planeNormal": normal}
        case Mesh(path, scale, concave):
            flags = {"flags": Raw("p.GEOM_FORCE_CONCAVE_TRIMESH")} if concave else {}
            name = str(path.absolute())
            return {"shapeType": Raw("p.GEOM_MESH"), "fileName": name, "meshScale": scale, **flags}
        case ConvexHull(points):
            return {"shapeType": Raw("p.GEOM_MESH"), "vertices": points}
        case TriangleMesh(vertices, triangles):
            return {"shapeType": Raw("p.GEOM_MESH"), "vertices": vertices, "indices": triangles.reshape(-1)}
        case Heightfield(heights, scale):
            columns, rows = heights.shape
            return {
                "shapeType": Raw("p.GEOM_HEIGHTFIELD"),
                "heightfieldData": heights.reshape(-1),
                "numHeightfieldRows": rows,
                "numHeightfieldColumns": columns,
                "meshScale": scale,
            }
        case _:
            return {}
