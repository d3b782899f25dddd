"""Checks of a body from a file, besides the types of its fields, before the engine uses it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from carom.description import ConvexHull, Geometry, Heightfield, Pose, TriangleMesh
from carom.formats.robot.context import MAX_MAGNITUDE
from carom.model.body_spec import BodySpec
from carom.model.soft_spec import SoftSpec

# What may be infinite: bounds, which then do not bound.
_BOUNDS = frozenset(
    ("lower", "upper", "effort", "velocity", "twist", "joint_lower_limit", "joint_upper_limit")
)
_UNIT_TOLERANCE = 1e-3


def check_body(spec: BodySpec) -> None:
    """See that links form a tree, shapes have the corners they name, and numbers are numbers.

    Raises:
        ValueError: They do not.
    """
    for index, link in enumerate(spec.links):
        if not -1 <= link.parent < index:
            raise ValueError(f"link {index} hangs on link {link.parent}")
    check_finite(spec)
    if spec.soft is not None:
        _check_soft(spec, spec.soft)
    for link in (spec.base, *spec.links):
        for shape in (*link.collisions, *link.visuals):
            _check_geometry(shape.geometry)


def _check_soft(spec: BodySpec, soft: SoftSpec) -> None:
    count = len(soft.nodes)
    _check_rows(soft.nodes, 3, 1)
    if spec.links or not spec.fixed_base or soft.masses.shape != (count,) or not (soft.masses > 0.0).all():
        raise ValueError("a soft body has nodes of some mass, a fixed base and no links")
    for rows, width in ((soft.faces, 3), (soft.springs, 2), (soft.tetras, 4)):
        _check_rows(rows, width, 0)
        if rows.size and not 0 <= rows.min() <= rows.max() < count:
            raise ValueError("a soft body names a node that does not exist")
    if soft.spring_terms.shape != (len(soft.springs), 3) or (soft.spring_terms < 0.0).any():
        raise ValueError("a spring has another number of terms, or a negative one")
    if not (np.linalg.det(soft.edge_matrices()) > 0.0).all():
        raise ValueError("a tetrahedron has no volume")
    if soft.skin is not None:
        skin = soft.skin
        vertices = len(skin.nodes)
        for rows, most in ((skin.nodes, count), (skin.triangles, vertices)):
            if rows.ndim != 2 or (rows.size and not 0 <= rows.min() <= rows.max() < most):
                raise ValueError("the skin of a soft body names what does not exist")
        if skin.weights.shape != skin.nodes.shape or skin.triangles.shape[1] != 3:
            raise ValueError("the skin of a soft body has another number of weights or corners")
    if min(soft.mu, soft.lam, soft.damping) < 0.0 or soft.margin <= 0.0:
        raise ValueError("a soft body has a negative parameter")


def check_finite(value: Any) -> None:
    """See that no number of a dataclass is infinite or very large, and every orientation has length 1.

    Raises:
        ValueError: One is, or has not.
    """
    for part in _parts(value):
        if isinstance(part, float) and not abs(part) <= MAX_MAGNITUDE:
            raise ValueError(f"a number is {part:g}")
        if isinstance(part, np.ndarray) and not (np.abs(part) <= MAX_MAGNITUDE).all():
            raise ValueError("an array holds a number that is not finite or very large")
        if isinstance(part, Pose) and abs(sum(q * q for q in part.orientation) - 1.0) > _UNIT_TOLERANCE:
            raise ValueError("a quaternion does not have length 1")


def _parts(value: Any) -> Iterator[Any]:
    yield value
    if is_dataclass(value):
        for field in fields(value):
            if field.name not in _BOUNDS:
                yield from _parts(getattr(value, field.name))
    elif isinstance(value, (list, tuple)):
        for item in value:
            yield from _parts(item)


def _check_geometry(geometry: Geometry) -> None:
    if isinstance(geometry, ConvexHull):
        _check_rows(geometry.points, 3, 1)
    elif isinstance(geometry, Heightfield):
        if geometry.heights.ndim != 2 or min(geometry.heights.shape) < 2:
            raise ValueError("a heightfield has fewer than 2 x 2 points")
    elif isinstance(geometry, TriangleMesh):
        _check_rows(geometry.vertices, 3, 0)
        _check_rows(geometry.triangles, 3, 0)
        count = len(geometry.vertices)
        if geometry.triangles.size and not 0 <= geometry.triangles.min() <= geometry.triangles.max() < count:
            raise ValueError("a triangle has a corner that does not exist")
        for rows, width in ((geometry.normals, 3), (geometry.uvs, 2)):
            if rows is not None:
                _check_rows(rows, width, count)


def _check_rows(rows: np.ndarray, width: int, least: int) -> None:
    if rows.ndim != 2 or rows.shape[1] != width or len(rows) < least:
        raise ValueError(f"an array of shape {rows.shape} does not hold points")
