"""Checks of the values of a body from a file, before the engine uses it; `records` checks their types."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from carom.description import ConvexHull, Geometry, Heightfield, Pose, TriangleMesh
from carom.layouts.magnitudes import MAX_MAGNITUDE
from carom.model.body_spec import BodySpec
from carom.model.soft_spec import SoftSpec

# Fields that may be infinite: bounds, which then have no effect.
_BOUNDS = frozenset(
    (
        "lower",
        "upper",
        "effort",
        "velocity",
        "max_velocity",
        "twist",
        "joint_lower_limit",
        "joint_upper_limit",
        "control_range",
        "force_range",
        "activation_range",
        "joint_range",
        "range",
    )
)
_UNIT_TOLERANCE = 1e-3


def check_body(spec: BodySpec) -> None:
    """Raise `ValueError` unless links form a tree, what they refer to exists, and numbers are finite."""
    for index, link in enumerate(spec.links):
        if not -1 <= link.parent < index:
            raise ValueError(f"link {index} has link {link.parent} as its parent, which must come before it")
    check_finite(spec, f"body {spec.name!r}")
    for actuator in spec.actuators:
        actuator.check()
    if spec.soft is not None:
        _check_soft(spec, spec.soft)
    for link in (spec.base, *spec.links):
        for shape in (*link.collisions, *link.visuals):
            _check_geometry(shape.geometry)


def _check_soft(spec: BodySpec, soft: SoftSpec) -> None:
    count = len(soft.nodes)
    _check_rows(soft.nodes, 3, 1)
    if spec.links or not spec.fixed_base or soft.masses.shape != (count,) or not (soft.masses > 0.0).all():
        raise ValueError("a soft body must have nodes with masses > 0, a fixed base and no links")
    for rows, width in ((soft.faces, 3), (soft.springs, 2), (soft.tetras, 4)):
        _check_rows(rows, width, 0)
        if rows.size and not 0 <= rows.min() <= rows.max() < count:
            raise ValueError("a soft body refers to a node that does not exist")
    if soft.spring_terms.shape != (len(soft.springs), 3) or (soft.spring_terms < 0.0).any():
        raise ValueError("the terms of springs have the wrong shape, or one is negative")
    if not (np.linalg.det(soft.edge_matrices()) > 0.0).all():
        raise ValueError("a tetrahedron has no volume")
    if soft.skin is not None:
        skin = soft.skin
        vertices = len(skin.nodes)
        for rows, most in ((skin.nodes, count), (skin.triangles, vertices)):
            if rows.ndim != 2 or (rows.size and not 0 <= rows.min() <= rows.max() < most):
                raise ValueError("the visible mesh of a soft body contains an index that is out of range")
        if skin.weights.shape != skin.nodes.shape or skin.triangles.shape[1] != 3:
            raise ValueError("the visible mesh of a soft body has the wrong number of weights or corners")
    if min(soft.mu, soft.lam, soft.damping) < 0.0 or soft.margin <= 0.0:
        raise ValueError("a soft body has a negative parameter")


def check_finite(value: Any, where: str) -> None:
    """Raise `ValueError` unless numbers are finite and not very large, and quaternions have length 1.

    `where` is the place of the value, for the message.
    """
    for place, part in _parts(value, where):
        if isinstance(part, float) and not abs(part) <= MAX_MAGNITUDE:
            raise ValueError(f"{place}: a number is {part:g}: it must be finite and not very large")
        if isinstance(part, np.ndarray) and not (np.abs(part) <= MAX_MAGNITUDE).all():
            raise ValueError(f"{place}: an array contains a number that is infinite, NaN or very large")
        if isinstance(part, Pose) and abs(sum(q * q for q in part.orientation) - 1.0) > _UNIT_TOLERANCE:
            raise ValueError(f"{place}: a quaternion does not have length 1")


def _parts(value: Any, where: str) -> Iterator[tuple[str, Any]]:
    """A value and all inside it, each with its place."""
    yield where, value
    if is_dataclass(value):
        for field in fields(value):
            if field.name not in _BOUNDS:
                yield from _parts(getattr(value, field.name), f"{where}.{field.name}")
    elif isinstance(value, (list, tuple)):
        for number, item in enumerate(value):
            yield from _parts(item, f"{where}[{number}]")


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
        raise ValueError(f"an array of points or indices has the wrong shape {rows.shape}")
