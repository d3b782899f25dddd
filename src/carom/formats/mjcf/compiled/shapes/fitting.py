"""Primitive shapes fitted to meshes: by the box of the same inertia, or by bounds."""

from __future__ import annotations

import numpy as np

from carom.description.eigen import principal_axes
from carom.description.geometry import BY_MJCF
from carom.description.pose import Pose, Vector3
from carom.description.shapes.moments import MassShape
from carom.description.transform import Matrix3, quaternion_from_matrix
from carom.formats.mjcf.compiled.shapes.meshes import MeshAsset
from carom.native.products import determinants, dots, product


def fitted(mesh: MeshAsset, kind: str, *, by_bounds: bool) -> tuple[Vector3, Pose] | None:
    """MJCF sizes of a shape and its pose in the frame of the mesh; None for a mesh without volume.

    The axes of the shape are the principal axes of the mesh, the greatest moment first.
    """
    if mesh.mass is None:
        return None
    moments, axes = _principal(mesh.mass)
    centre = mesh.mass.centre
    if by_bounds:
        local = product(mesh.vertices - centre, axes)
        low, high = local.min(axis=0), local.max(axis=0)
        centre = centre + dots(axes, 0.5 * (low + high))
        a, b, c = (float(x) for x in 0.5 * (high - low))
    else:
        squares = np.maximum(3.0 * (0.5 * moments.sum() - moments), 0.0)
        a, b, c = (float(x) for x in np.sqrt(squares))
    return _size(kind, (a, b, c), by_bounds=by_bounds), _pose(centre, axes)


def reach(mesh: MeshAsset) -> tuple[Vector3, Pose] | None:
    """How far a mesh reaches from its centre along its principal axes, and their pose.

    None for a mesh without volume.
    """
    if mesh.mass is None:
        return None
    _, axes = _principal(mesh.mass)
    local = product(mesh.vertices - mesh.mass.centre, axes)
    a, b, c = (float(x) for x in np.abs(local).max(axis=0))
    return (a, b, c), _pose(mesh.mass.centre, axes)


def _principal(mass: MassShape) -> tuple[np.ndarray, np.ndarray]:
    """Principal moments, the greatest first, and axes as columns."""
    moments, axes = principal_axes(mass.tensor)
    moments, axes = moments[::-1], axes[:, ::-1].copy()
    if determinants(axes) < 0.0:
        axes[:, 2] *= -1.0
    return moments, axes


def _pose(centre: np.ndarray, axes: np.ndarray) -> Pose:
    rows: Matrix3 = tuple(tuple(float(x) for x in row) for row in axes)  # pyright: ignore
    x, y, z = (float(value) for value in centre)
    return Pose((x, y, z), quaternion_from_matrix(rows))


def _size(kind: str, half: Vector3, *, by_bounds: bool) -> Vector3:
    return BY_MJCF[kind].fitted(half, by_bounds=by_bounds) if kind in BY_MJCF else half
