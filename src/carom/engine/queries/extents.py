"""Bounds of bodies in world axes: of their collision shapes, where their links are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.checks import Array
from carom.layouts.codes import ELLIPSOID_FACETS, ROUNDED, ShapeKind
from carom.pose import Pose

if TYPE_CHECKING:
    from carom.model.shape_arrays import ShapeArrays


class Extent(NamedTuple):
    """A box along the axes of the world, in one world or in many: all arrays may have the world in front.

    Attributes:
        lower: Least corner [m], shape (3,); -inf where there is no bound, as below a plane.
        upper: Greatest corner.
    """

    lower: Array
    upper: Array

    @property
    def size(self) -> Array:
        """From the least corner to the greatest [m]."""
        return self.upper - self.lower

    @property
    def centre(self) -> Array:
        """The point in the middle [m]."""
        return 0.5 * (self.lower + self.upper)


def extent_of(
    shapes: ShapeArrays,
    rows: Sequence[int],
    poses: Array,
    only: Sequence[int] | None = None,
    sizes: Array | None = None,
) -> Extent:
    """Bounds of the collision shapes of some links.

    Args:
        shapes: The shapes of the world.
        rows: Rows of the links.
        poses: (links, 7) world poses of the inertial frames of these links, or (n, links, 7).
        only: Rows of the shapes that count; None for all.
        sizes: `Shapes.shape_size` of the worlds, (n, shapes, 3), or (1, shapes, 3) if it is the same in all;
            None for those of the world.

    Returns:
        The bounds, without collision margins; those of the origins of the inertial frames if the links have
        no shapes.
    """
    corners: list[tuple[Array, Array]] = []
    for place, row in enumerate(rows):
        link = Pose(poses[..., place, :3], poses[..., place, 3:])
        found = shapes.shapes_of(row)
        own = range(found.start, found.stop) if only is None else only
        corners += [_of_shape(shapes, shape, link, sizes) for shape in own]
    if not corners:
        return Extent(poses[..., :3].min(axis=-2), poses[..., :3].max(axis=-2))
    lower = np.min([low for low, _ in corners], axis=0)
    return Extent(lower, np.max([high for _, high in corners], axis=0))


def _of_shape(shapes: ShapeArrays, row: int, link: Pose, sizes: Array | None) -> tuple[Array, Array]:
    """Least and greatest corner of a shape on a link at a pose, or at many."""
    table = shapes.table.numpy
    kind = int(table["shape_kind"][row])
    size = table["shape_size"][0, row] if sizes is None else sizes[:, row]
    own = table["shape_pose"][row]
    frame = link * Pose(own[:3], own[3:])
    turn, middle = frame.rotation, frame.position
    along = turn[..., :, 2]
    if kind == ShapeKind.PLANE:
        return _of_plane((turn * size[..., None, :]).sum(axis=-1), middle)
    if kind == ShapeKind.HULL and table["shape_columns"][row] == ELLIPSOID_FACETS:
        half = np.linalg.norm(turn * size[..., None, :], axis=-1)
        return middle - half, middle + half
    if kind in (ShapeKind.HULL, ShapeKind.TRIANGLES, ShapeKind.HEIGHTFIELD):
        first = int(table["shape_first_vertex"][row])
        points = table["vertex_position"][first : first + int(table["shape_vertex_count"][row])]
        placed = (turn[..., None, :, :] * points[:, None, :]).sum(axis=-1)
        is_rounded = kind == ShapeKind.HULL and table["shape_columns"][row] == ROUNDED
        margin = float(table["shape_margin"][0, row]) if is_rounded else 0.0
        return placed.min(axis=-2) + middle - margin, placed.max(axis=-2) + middle + margin
    if kind == ShapeKind.SPHERE:
        half = np.broadcast_to(size[..., :1], middle.shape)
    elif kind == ShapeKind.BOX:
        half = (np.abs(turn) * size[..., None, :]).sum(axis=-1)
    elif kind == ShapeKind.CAPSULE:
        half = size[..., :1] + size[..., 1:2] * np.abs(along)
    else:
        half = size[..., 1:2] * np.abs(along) + size[..., :1] * np.sqrt(np.maximum(1.0 - along * along, 0.0))
    return middle - half, middle + half


def _of_plane(normal: Array, point: Array) -> tuple[Array, Array]:
    """Those of a half space: only along an axis of the world it has a bound."""
    is_level = np.abs(normal) > 1.0 - 1e-12
    lower = np.where(is_level & (normal < 0.0), point, -np.inf)
    return lower, np.where(is_level & (normal > 0.0), point, np.inf)
