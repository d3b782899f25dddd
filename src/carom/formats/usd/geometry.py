"""Shapes that collide or are seen: `Cube`, `Sphere`, `Capsule`, `Cylinder`, `Cone`, `Plane` and `Mesh`."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

from carom.description import ConvexHull, Ellipsoid, Geometry, Pose, TriangleMesh
from carom.description.geometry import BY_USD, Primitive, measures
from carom.description.pose import Quaternion
from carom.description.shapes.shape import Measure, Parameter
from carom.description.transform import compose
from carom.formats.usd.mesh import approximated, read_surface
from carom.formats.usd.stage import Matrix, Stage, rigid

# The second form of shapes with two ends, which may differ.
_OTHER_ENDS = "_1"
SHAPES: tuple[str, ...] = (
    *(kind for kind in BY_USD),
    *(f"{kind}{_OTHER_ENDS}" for kind, it in BY_USD.items() if len(it.parameters) > 1),
    *("Cone", "Mesh"),
)
# Radius and length of a cone that states none.
_CONE = (1.0, 2.0)
# What turns z to the axis of a shape.
_H = 0.7071067811865476
_TURNS: dict[str, Quaternion] = {"X": (0.0, _H, 0.0, _H), "Y": (-_H, 0.0, 0.0, _H), "Z": (0.0, 0.0, 0.0, 1.0)}
_ORDER = {"X": (1, 2, 0), "Y": (0, 2, 1), "Z": (0, 1, 2)}
_SIDES = 32

Shape = tuple[Geometry, Pose]


def is_shape(prim: Any) -> bool:
    """Whether a prim is a shape that can be read."""
    return str(prim.GetTypeName()) in SHAPES


def read_shape(stage: Stage, prim: Any, matrix: Matrix, *, moves: bool, looks: bool = False) -> list[Shape]:
    """The shape of a prim as pieces, each with its pose in the frame of the link.

    Args:
        stage: The stage.
        prim: The shape.
        matrix: (4, 4): its frame with its scale in that of the link.
        moves: The link moves, so triangles cannot collide as such.
        looks: It is seen, and does not collide.

    Raises:
        DescriptionError: A number has no meaning, or a mesh is broken.
    """
    kind = str(prim.GetTypeName()).removesuffix(_OTHER_ENDS)
    if kind == "Mesh":
        surface = read_surface(stage, prim, matrix)
        if surface is None:
            return []
        if looks:
            return [(TriangleMesh(*surface), Pose())]
        return approximated(stage, prim, *surface, moves=moves)
    pose, rest = rigid(matrix)
    scale = np.abs(np.diag(rest))
    if np.abs(rest - np.diag(np.diag(rest))).max() > 1e-9 * scale.max():
        stage.leave_out(prim, "its shape is not sheared", "shapes other than meshes have no shear")
    primitive: Any = BY_USD.get(kind)
    if primitive is not None and measures(primitive) == (Measure.LENGTHS,):
        size = _size(stage, prim, *_attribute(primitive.parameters[0]))
        x, y, z = (size / primitive.parameters[0].per_field * scale).tolist()
        return [(primitive((x, y, z)), pose)]
    if primitive is not None and measures(primitive) == (Measure.LENGTH,):
        radius = _size(stage, prim, *_attribute(primitive.parameters[0]))
        return [(_ball(primitive, radius, scale), pose)]
    axis = str(stage.value(prim, "axis", "Z"))
    if axis not in _TURNS:
        raise stage.error(prim, f"its axis is {axis!r}; expected X, Y or Z")
    pose = compose(pose, Pose(orientation=_TURNS[axis]))
    across, also, along = (float(scale[index]) for index in _ORDER[axis])
    if primitive is not None and primitive.is_unbounded:
        for name in ("width", "length"):
            stage.value(prim, name)
        return [(primitive(), pose)]
    if abs(across - also) > 1e-9 * max(across, also):
        stage.leave_out(prim, "it is round, with the greater radius", "its scale would make it elliptical")
    defaults = _CONE if primitive is None else tuple(it.usd[1] for it in primitive.parameters)
    radius, length = _round(stage, prim, *defaults)
    radius, length = radius * max(across, also), length * along
    if primitive is None:
        return [(_cone(radius, length), pose)]
    return [(primitive(radius, length), pose)]


def _attribute(parameter: Parameter) -> tuple[str, float]:
    """The attribute of a number, and its value where there is none."""
    name, default = parameter.usd
    return name.lower(), default


def _size(stage: Stage, prim: Any, name: str, default: float) -> float:
    value = stage.number(prim, name, default)
    if not 0.0 < value < np.inf:
        raise stage.error(prim, f"{name} is {value:g}; expected a positive number")
    return value


def _round(stage: Stage, prim: Any, usual_radius: float, usual_length: float) -> tuple[float, float]:
    """Radius and length of a capsule, a cylinder or a cone."""
    length = _size(stage, prim, "height", usual_length)
    if not str(prim.GetTypeName()).endswith(_OTHER_ENDS):
        return _size(stage, prim, "radius", usual_radius), length
    ends = [_size(stage, prim, name, usual_radius) for name in ("radiusTop", "radiusBottom")]
    if ends[0] != ends[1]:
        stage.leave_out(prim, "both ends have the greater radius", "capsules and cylinders have one radius")
    return max(ends), length


def _ball(kind: type[Primitive], radius: float, scale: Matrix) -> Geometry:
    if np.ptp(scale) <= 1e-9 * scale.max():
        return kind.of_sizes(radius * float(scale.max()), 0.0, 0.0)
    x, y, z = (radius * scale).tolist()
    return Ellipsoid((x, y, z))


def _cone(radius: float, height: float) -> ConvexHull:
    """A cone along z, its tip up, its middle at half its height: flat faces around its volume."""
    step = 2.0 * pi / _SIDES
    wide = radius * np.sqrt(step / np.sin(step))
    angles = step * np.arange(_SIDES)
    base = np.stack([wide * np.cos(angles), wide * np.sin(angles), np.full(_SIDES, -0.5 * height)], axis=1)
    return ConvexHull(np.vstack([base, [[0.0, 0.0, 0.5 * height]]]), margin=0.0)
